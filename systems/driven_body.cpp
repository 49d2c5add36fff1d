#include <lagroid/systems/driven_body.hpp>
#include <lagroid/systems/reference.hpp>

namespace lagroid {

LAGROID_STEPS(template, DrivenBody);

State<SO3> DrivenBody::reference(const State<SO3>& start, Matrix<double, 3, 3>& attitude, double t) const {
  Eigen::VectorXd y(12);
  y << start.momentum, attitude.reshaped();
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        const Vector<double, 3> m = at.head<3>();
        const Vector<double, 3> w = m.cwiseQuotient(inertia);
        out.head<3>() = m.cross(w) + torque - drag * w;
        out.tail<9>() = (at.tail<9>().reshaped(3, 3) * SO3::hat(w)).reshaped();
      },
      y, t);
  attitude = SO3::project(Matrix<double, 3, 3>(y.tail<9>().reshaped(3, 3)));
  return {{}, y.head<3>()};
}

}  // namespace lagroid
