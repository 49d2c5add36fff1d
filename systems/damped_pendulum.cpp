#include <lagroid/systems/damped_pendulum.hpp>
#include <lagroid/systems/reference.hpp>

namespace lagroid {

LAGROID_STEPS(template, DampedPendulum);

State<Pair<1>> DampedPendulum::reference(const State<Pair<1>>& start, double t) const {
  Eigen::VectorXd y(2);
  y << start.object, start.momentum;
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        out(0) = at(1) / mass();
        out(1) = force(Vector<double, 1>(at(0)))(0) - damping * out(0);
      },
      y, t);
  return {y.head<1>(), y.tail<1>()};
}

}  // namespace lagroid
