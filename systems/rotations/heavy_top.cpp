#include <lagroid/systems/reference.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <complex>

namespace lagroid {

double HeavyTop::kovalevskaya_integral(const State<GroupoidType>& s) const {
  const Vector<double, 3> velocity = s.momentum.cwiseQuotient(inertia);
  const std::complex<double> w(velocity(0), velocity(1));
  const std::complex<double> v(s.object(0), s.object(1));
  const std::complex<double> c(weight(0), weight(1));
  return std::norm(w * w - c * v / inertia(2));
}

State<HeavyTop::GroupoidType> HeavyTop::reference(const State<GroupoidType>& start, Matrix<double, 3, 3>& attitude,
                                                  double t) const {
  const Vector<double, 3> vertical = attitude * start.object;
  const Torque gravity = [&](const auto&, const Matrix<double, 3, 3>& a) {
    return Vector<double, 3>((a.transpose() * vertical).cross(weight));
  };
  const Vector<double, 3> momentum = reference_turn(inertia, gravity, start.momentum, attitude, t);
  return {attitude.transpose() * vertical, momentum};
}

std::vector<Symmetry<HeavyTop>> HeavyTop::symmetries() const {
  std::vector<Symmetry<HeavyTop>> all{{"vertical momentum M.v", [](const Vector<double, 3>& v) { return v; }}};
  if (is_lagrange())
    all.push_back({"axial momentum M3", [](const Vector<double, 3>&) { return Vector<double, 3>(0, 0, 1); }});
  return all;
}

std::vector<Quantity<HeavyTop>> HeavyTop::quantities() const {
  using Point = TrajectoryPoint<HeavyTop>;
  std::vector<Quantity<HeavyTop>> all{{"energy",
                                       {"H"},
                                       Promise::bounded,
                                       false,
                                       [system = *this](const Point& p, double* out) { *out = system.energy(p.state); },
                                       [system = *this](const Point& p) {
                                         const double potential = system.weight.dot(p.state.object);
                                         return system.energy(p.state) - potential + std::abs(potential);
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
