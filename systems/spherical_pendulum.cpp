#include <lagroid/systems/spherical_pendulum.hpp>

namespace lagroid {

LAGROID_STEPS(template, SphericalPendulum);

State<Pair<3>> SphericalPendulum::reference(const State<Pair<3>>& start, double t) const {
  Eigen::VectorXd y(6);
  y << start.object, start.momentum;
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        const auto q = at.head<3>();
        const auto p = at.tail<3>();
        const double tension = (bob_mass * gravity * q(2) - p.squaredNorm() / bob_mass) / q.squaredNorm();
        out.head<3>() = p / bob_mass;
        out.tail<3>() = tension * q;
        out(5) -= bob_mass * gravity;
      },
      y, t);
  return {y.head<3>(), y.tail<3>()};
}

}  // namespace lagroid
