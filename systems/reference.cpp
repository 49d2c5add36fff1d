#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/systems/reference.hpp>

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <vector>

namespace lagroid {

Eigen::VectorXd integrate_reference(const VectorField& field, const Eigen::VectorXd& start, double t) {
  namespace odeint = boost::numeric::odeint;
  using Y = std::vector<double>;
  Y y(start.data(), start.data() + start.size());
  Eigen::VectorXd in(start.size());
  Eigen::VectorXd out(start.size());
  const auto rhs = [&](const Y& state, Y& derivative, double) {
    in = Eigen::Map<const Eigen::VectorXd>(state.data(), in.size());
    field(in, out);
    Eigen::Map<Eigen::VectorXd>(derivative.data(), out.size()) = out;
  };
  constexpr double tolerance = 1e-14;
  odeint::integrate_adaptive(odeint::make_controlled<odeint::runge_kutta_fehlberg78<Y>>(tolerance, tolerance), rhs, y,
                             0.0, t, t / 1000);
  return Eigen::Map<const Eigen::VectorXd>(y.data(), start.size());
}

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
