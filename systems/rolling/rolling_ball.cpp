#include <lagroid/systems/reference.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>

#include <cmath>

namespace lagroid {

State<RollingBall::GroupoidType> RollingBall::rolling(const Vector<double, 2>& position,
                                                      const Vector<double, 2>& velocity, double spin) const {
  State<GroupoidType> s;
  std::get<0>(s.object) = position;
  s.momentum = momentum_of(s.object, Vector<double, 3>(velocity(0), velocity(1), spin));
  return s;
}

Step<RollingBall> RollingBall::first_guess(const State<GroupoidType>& s) const {
  const Vector<double, 2>& q = std::get<0>(s.object);
  const Vector<double, 2> velocity = s.momentum.head<2>() / mass;
  return {{PairArrow<double, 2>{q, q + h * velocity}, SO3::exp(Vector<double, 3>(-h * angular_velocity(s)))},
          Multipliers::Zero()};
}

double RollingBall::energy(const State<GroupoidType>& s) const {
  return 0.5 * (s.momentum.head<2>().squaredNorm() / mass + s.momentum.tail<3>().squaredNorm() / inertia());
}

double RollingBall::moving_energy(const State<GroupoidType>& s) const {
  const Vector<double, 2>& q = std::get<0>(s.object);
  return energy(s) - plate_rate * (q(0) * s.momentum(1) - q(1) * s.momentum(0) - s.momentum(4));
}

State<RollingBall::GroupoidType> RollingBall::reference(const State<GroupoidType>& start,
                                                        Matrix<double, 3, 3>& attitude, double t) const {
  const Matrix<double, 3, 3> ball = attitude.transpose();
  Eigen::VectorXd y(16);
  y << std::get<0>(start.object), start.momentum.head<2>() / mass, angular_velocity(start), ball.reshaped();
  y = integrate_reference(
      [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        const Vector<double, 2> v = at.segment<2>(2);
        const Vector<double, 3> w = at.segment<3>(4);
        const Vector<double, 2> friction =
            Vector<double, 2>(-v(1), v(0)) * (plate_rate / (1 / mass + radius * radius / inertia()));
        out.head<2>() = v;
        out.segment<2>(2) = friction / mass;
        out.segment<3>(4) = Vector<double, 3>(friction(1), -friction(0), 0) * (radius / inertia());
        out.tail<9>() = (SO3::hat(w) * at.tail<9>().reshaped(3, 3)).reshaped();
      },
      y, t);
  attitude = SO3::project(Matrix<double, 3, 3>(y.tail<9>().reshaped(3, 3).transpose()));
  State<GroupoidType> out;
  std::get<0>(out.object) = y.head<2>();
  out.momentum << mass * y.segment<2>(2), -inertia() * y.segment<3>(4);
  return out;
}

std::vector<Symmetry<RollingBall>> RollingBall::symmetries() const {
  using Fibre = AlgebroidVector<GroupoidType>;
  const auto constant = [](const Fibre& x) { return [x](const ObjectOf<GroupoidType>&) { return x; }; };
  return {{"K1", constant({0, -radius, -1, 0, 0})},
          {"K2", constant({radius, 0, 0, -1, 0})},
          {"K3 = k m r^2 w3", constant({0, 0, 0, 0, -1})}};
}

std::vector<Quantity<RollingBall>> RollingBall::quantities() const {
  using Point = TrajectoryPoint<RollingBall>;
  std::vector<Quantity<RollingBall>> all;
  const auto size = [r = radius](const Point& p) {
    return r * p.state.momentum.head<2>().norm() + p.state.momentum.tail<3>().norm();
  };
  for (const auto& symmetry : symmetries()) all.push_back(symmetry.quantity(size));
  all.push_back({plate_rate == 0 ? "energy" : "moving energy E - Omega J",
                 {plate_rate == 0 ? "E" : "E - Omega J"},
                 Promise::conserved,
                 false,
                 [system = *this](const Point& p, double* out) { *out = system.moving_energy(p.state); },
                 [system = *this](const Point& p) {
                   const double angular = std::get<0>(p.state.object).norm() * p.state.momentum.head<2>().norm() +
                                          std::abs(p.state.momentum(4));
                   return system.energy(p.state) + std::abs(system.plate_rate) * angular;
                 }});
  return all;
}

}  // namespace lagroid
