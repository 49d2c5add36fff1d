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

}  // namespace lagroid
