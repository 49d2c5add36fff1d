#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/systems/reference.hpp>

namespace lagroid {

Vector<double, 3> reference_turn(const Vector<double, 3>& inertia, const Torque& torque,
                                 const Vector<double, 3>& momentum, Matrix<double, 3, 3>& attitude, double t) {
  Eigen::VectorXd y(12);
  y << momentum, attitude.reshaped();
  y = integrate_reference(
      [&](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        const Vector<double, 3> m = at.head<3>();
        const Matrix<double, 3, 3> a = at.tail<9>().reshaped(3, 3);
        const Vector<double, 3> w = m.cwiseQuotient(inertia);
        out.head<3>() = m.cross(w) + torque(w, a);
        out.tail<9>() = (a * SO3::hat(w)).reshaped();
      },
      y, t);
  attitude = SO3::project(Matrix<double, 3, 3>(y.tail<9>().reshaped(3, 3)));
  return y.head<3>();
}

}  // namespace lagroid
