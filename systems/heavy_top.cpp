#include <lagroid/systems/heavy_top.hpp>
#include <lagroid/systems/reference.hpp>

#include <complex>

namespace lagroid {

LAGROID_STEPS(template, HeavyTop);

double HeavyTop::kovalevskaya_integral(const State<GroupoidType>& s) const {
  const Vector<double, 3> velocity = s.momentum.cwiseQuotient(inertia);
  const std::complex<double> w(velocity(0), velocity(1));
  const std::complex<double> v(s.object(0), s.object(1));
  const std::complex<double> c(weight(0), weight(1));
  return std::norm(w * w - c * v / inertia(2));
}

State<HeavyTop::GroupoidType> HeavyTop::reference(const State<GroupoidType>& start, Matrix<double, 3, 3>& attitude,
                                                  double t) const {
  Eigen::VectorXd y(15);
  y << start.momentum, start.object, attitude.reshaped();
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        const Vector<double, 3> m = at.head<3>();
        const Vector<double, 3> v = at.segment<3>(3);
        const Vector<double, 3> w = m.cwiseQuotient(inertia);
        out.head<3>() = m.cross(w) + v.cross(weight);
        out.segment<3>(3) = v.cross(w);
        out.tail<9>() = (at.tail<9>().reshaped(3, 3) * SO3::hat(w)).reshaped();
      },
      y, t);
  attitude = SO3::project(Matrix<double, 3, 3>(y.tail<9>().reshaped(3, 3)));
  return {y.segment<3>(3), y.head<3>()};
}

std::vector<Symmetry<HeavyTop>> HeavyTop::symmetries() const {
  std::vector<Symmetry<HeavyTop>> all{{"vertical momentum M.v", [](const Vector<double, 3>& v) { return v; }}};
  if (is_lagrange())
    all.push_back({"axial momentum M3", [](const Vector<double, 3>&) { return Vector<double, 3>(0, 0, 1); }});
  return all;
}

std::vector<Quantity<HeavyTop>> HeavyTop::quantities() const {
  using Point = TrajectoryPoint<HeavyTop>;
  std::vector<Quantity<HeavyTop>> all{
      {"energy", {"H"}, Promise::bounded, false, [system = *this](const Point& p, double* out) {
         *out = system.energy(p.state);
       }}};
  for (const auto& symmetry : symmetries()) all.push_back(symmetry.quantity());
  if (is_kovalevskaya())
    all.push_back(
        {"Kovalevskaya integral", {"K"}, Promise::bounded, false, [system = *this](const Point& p, double* out) {
           *out = system.kovalevskaya_integral(p.state);
         }});
  return all;
}

}  // namespace lagroid
