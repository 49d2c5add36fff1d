#include <lagroid/systems/driven_pendulum.hpp>
#include <lagroid/systems/reference.hpp>

namespace lagroid {

LAGROID_STEPS(template, DrivenPendulum);

State<Pair<1>> DrivenPendulum::reference(const State<Pair<1>>& start, double t) const {
  Eigen::VectorXd y(3);
  y << start.object, start.momentum, time;
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        out(0) = at(1) / mass();
        out(1) = -potential(Dual<double>(at(0), 1.0), at(2)).derivative;
        out(2) = 1;
      },
      y, t);
  return {y.head<1>(), y.segment<1>(1)};
}

}  // namespace lagroid
