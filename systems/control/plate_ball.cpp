#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/reference.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace lagroid {

Matrix<double, 3, 3> PlateBall::rotation_of(const Vector<double, 3>& w) const {
  if (rotation != RotationForm::trace) return SO3::retract(retraction(), w);
  const double sine = std::min(w.norm(), 0.99);
  return sine > 0 ? SO3::exp(Vector<double, 3>(w * (std::asin(sine) / w.norm()))) : SO3::exp(w);
}

Step<PlateBall> PlateBall::first_guess(const State<GroupoidType>& s) const {
  const Vector<double, 2>& q = std::get<0>(s.object);
  const auto& mu = s.momentum;
  const double l1 = mu(2) / radius;
  const double l2 = -mu(3) / radius;
  const double l3 = -mu(4);
  const Vector<double, 2> velocity(mu(0) - l2 - 0.5 * h * plate_rate * l1, mu(1) - l1 + 0.5 * h * plate_rate * l2);
  const Vector<double, 2> middle = q + 0.5 * h * velocity;
  const Vector<double, 3> omega((plate_rate * middle(0) - velocity(1)) / radius,
                                (velocity(0) + plate_rate * middle(1)) / radius, spin);
  return {{PairArrow<double, 2>{q, q + h * velocity}, rotation_of(h * omega)}, {l1, l2, l3}};
}

std::optional<std::string> PlateBall::infeasible() const {
  if (!(std::isfinite(radius) && std::isfinite(h) && std::isfinite(plate_rate) && std::isfinite(spin)))
    return "radius, step, plate_rate and spin must be finite";
  if (!(radius > 0 && h > 0)) return "radius and step must be positive";
  const double turn = std::abs(h * spin);
  if (rotation == RotationForm::trace && turn >= 1)
    return fmt::format("the trace form needs |spin * step| < 1, got {:.6g}; use a smaller step or rotation = \"exp\"",
                       turn);
  if (rotation == RotationForm::exponential && turn >= std::numbers::pi)
    return fmt::format("the exp form needs |spin * step| < pi, got {:.6g}; use a smaller step", turn);
  return std::nullopt;
}

PlateBall::Arrows PlateBall::path(const ArrowOf<GroupoidType>& boundary, long steps,
                                  const Eigen::Matrix2Xd& modes) const {
  const PairArrow<double, 2>& move = std::get<0>(boundary);
  const Matrix<double, 3, 3>& turn = std::get<1>(boundary);
  const auto point = [&](double s) {
    Vector<double, 2> q = (1 - s) * move.source + s * move.target;
    for (Eigen::Index j = 0; j < modes.cols(); ++j) q += modes.col(j) * std::sin(double(j + 1) * std::numbers::pi * s);
    return q;
  };
  std::vector<Vector<double, 2>> nodes(steps + 1);
  std::vector<Matrix<double, 3, 3>> attitude(steps + 1, Matrix<double, 3, 3>::Identity());
  for (long k = 0; k <= steps; ++k) nodes[k] = point(double(k) / double(steps));
  for (long k = 0; k < steps; ++k) {
    const Vector<double, 2> d = nodes[k + 1] - nodes[k];
    const Vector<double, 2> middle = 0.5 * (nodes[k + 1] + nodes[k]);
    Vector<double, 3> w((h * plate_rate * middle(0) - d(1)) / radius, (d(0) + h * plate_rate * middle(1)) / radius,
                        h * spin);
    if (const double angle = w.norm(); rotation == RotationForm::exponential && angle > 3.1) w *= 3.1 / angle;
    attitude[k + 1] = attitude[k] * rotation_of(w);
  }
  // Bent from the left: the turn of each step changes by about |bend| / steps, however fast the ball spins.
  const Vector<double, 3> bend = SO3::log(Matrix<double, 3, 3>(turn * attitude[steps].transpose()));
  for (long k = 1; k <= steps; ++k)
    attitude[k] = SO3::exp(Vector<double, 3>(bend * (double(k) / double(steps)))) * attitude[k];
  Arrows arrows;
  arrows.reserve(steps);
  for (long k = 0; k < steps; ++k)
    arrows.push_back({PairArrow<double, 2>{nodes[k], nodes[k + 1]},
                      SO3::project(Matrix<double, 3, 3>(attitude[k].transpose() * attitude[k + 1]))});
  return arrows;
}

double PlateBall::energy(const Step<PlateBall>& step, double over) const {
  const auto& [move, turn] = step.arrow;
  const Vector<double, 2> velocity = (move.target - move.source) / over;
  const Vector<double, 2> middle = 0.5 * (move.source + move.target);
  const auto& l = step.multipliers;
  return 0.5 * velocity.squaredNorm() + plate_rate * (l(0) * middle(0) - l(1) * middle(1)) - spin * l(2);
}

State<PlateBall::GroupoidType> PlateBall::reference(const State<GroupoidType>& start, Matrix<double, 3, 3>& attitude,
                                                    double t) const {
  Eigen::VectorXd y(16);
  y << std::get<0>(start.object), start.momentum, attitude.reshaped();
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        const Vector<double, 3> m = at.segment<3>(4);
        const Rolling<double> now = rolling<double>(at.head<2>(), at.segment<2>(2), m, spin);
        out.head<2>() = now.velocity;
        out.segment<2>(2) = force(m);
        out.segment<3>(4) = m.cross(now.omega);
        out.tail<9>() = (at.tail<9>().reshaped(3, 3) * SO3::hat(now.omega)).reshaped();
      },
      y, t);
  attitude = SO3::project(Matrix<double, 3, 3>(y.tail<9>().reshaped(3, 3)));
  State<GroupoidType> out;
  std::get<0>(out.object) = y.head<2>();
  out.momentum = y.segment<5>(2);
  return out;
}

std::vector<Symmetry<PlateBall>> PlateBall::symmetries() const {
  using Fibre = AlgebroidVector<GroupoidType>;
  std::vector<Symmetry<PlateBall>> all{{"J = x py - y px - M3", [](const ObjectOf<GroupoidType>& object) {
                                          const auto& q = std::get<0>(object);
                                          return Fibre(-q(1), q(0), 0, 0, -1);
                                        }}};
  if (plate_rate == 0) {
    all.push_back({"px", [](const ObjectOf<GroupoidType>&) { return Fibre(Fibre::Unit(0)); }});
    all.push_back({"py", [](const ObjectOf<GroupoidType>&) { return Fibre(Fibre::Unit(1)); }});
  }
  return all;
}

std::vector<Quantity<PlateBall>> PlateBall::quantities() const {
  using Point = TrajectoryPoint<PlateBall>;
  // Momenta are exchanged between translation and rotation: each is rounded relative to all of them.
  const auto momentum = [r = radius](const Point& p) {
    return p.state.momentum.head<2>().norm() + p.state.momentum.tail<3>().norm() / r;
  };
  std::vector<Quantity<PlateBall>> all;
  all.push_back({"spatial momentum A M",
                 {"(AM)1", "(AM)2", "(AM)3"},
                 Promise::conserved,
                 false,
                 [](const Point& p, double* out) {
                   Eigen::Map<Vector<double, 3>> spatial(out);
                   spatial = std::get<1>(p.configuration) * p.state.momentum.tail<3>();
                 },
                 [momentum, r = radius](const Point& p) { return r * momentum(p); }});
  all.push_back(symmetries().front().quantity(
      [momentum, r = radius](const Point& p) { return (std::get<0>(p.state.object).norm() + r) * momentum(p); }));
  if (plate_rate == 0)
    all.push_back({"translational momentum",
                   {"px", "py"},
                   Promise::conserved,
                   false,
                   [](const Point& p, double* out) {
                     out[0] = p.state.momentum(0);
                     out[1] = p.state.momentum(1);
                   },
                   momentum});
  const bool exact_energy = rotation == RotationForm::cayley && plate_rate == 0 && spin == 0;
  all.push_back({"energy",
                 {"E"},
                 exact_energy ? Promise::conserved : Promise::bounded,
                 true,
                 [system = *this](const Point& p, double* out) { *out = system.energy(p.step, p.step_size); },
                 [momentum](const Point& p) { return momentum(p) * momentum(p); }});
  return all;
}

}  // namespace lagroid
