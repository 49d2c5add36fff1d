#include <lagroid/systems/reference.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>

#include <cmath>

namespace lagroid {

Vector<double, 2> ChaplyginSleigh::closed_form(const State<SE2>& start, double t) const {
  const Vector<double, 2> v = velocities(start);
  const double c = std::sqrt(2 * energy(start));
  const double rate = offset * c * std::sqrt(mass) / blade_inertia();
  const double s = std::asinh(std::sqrt(mass / blade_inertia()) * v(1) / std::abs(v(0))) + rate * t;
  return {std::copysign(c / std::sqrt(blade_inertia()), v(0)) / std::cosh(s), c / std::sqrt(mass) * std::tanh(s)};
}

State<SE2> ChaplyginSleigh::reference(const State<SE2>& start, Matrix<double, 3, 3>& pose, double t) const {
  Eigen::VectorXd y(11);
  y << velocities(start), pose.reshaped();
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        out(0) = -mass * offset * at(0) * at(1) / blade_inertia();
        out(1) = offset * at(0) * at(0);
        out.tail<9>() = (at.tail<9>().reshaped(3, 3) * SE2::hat(Vector<double, 3>(at(0), at(1), 0))).reshaped();
      },
      y, t);
  pose = SE2::project(Matrix<double, 3, 3>(y.tail<9>().reshaped(3, 3)));
  return sliding(y(0), y(1));
}

std::vector<Symmetry<ChaplyginSleigh>> ChaplyginSleigh::sections() const {
  return {{"turning", [](const ObjectOf<SE2>&) { return Vector<double, 3>(1, 0, 0); }},
          {"moving ahead", [](const ObjectOf<SE2>&) { return Vector<double, 3>(0, 1, 0); }}};
}

std::vector<Quantity<ChaplyginSleigh>> ChaplyginSleigh::quantities() const {
  std::vector<Quantity<ChaplyginSleigh>> all{
      {"energy",
       {"E"},
       Promise::bounded,
       false,
       [system = *this](const TrajectoryPoint<ChaplyginSleigh>& p, double* out) { *out = system.energy(p.state); }}};
  for (const auto& section : sections()) all.push_back(momentum_balance(*this, section));
  return all;
}

}  // namespace lagroid
