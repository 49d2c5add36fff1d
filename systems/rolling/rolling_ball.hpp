#pragma once
/// A ball that rolls on a rotating plate: the mechanics of the ball of plate_ball.hpp, nonholonomic,
///
///     L = (m |q1 - q0|^2 + k m r^2 |h w|^2) / (2 h),
///     phi1 = dy + r h w1 - h Omega x,    phi2 = dx - r h w2 + h Omega y,    (x, y) the middle of the arrow.
///
/// The discrete ball goes round the same circle as the continuous one.
///
///     RollingBall ball;
///     ball.plate_rate = 1;
///     const auto start = ball.rolling({0.5, 0}, {0, 0.2}, 0);  // place, velocity, spin
///
/// Requires positive mass, radius and inertia factor, and starts that roll, which `rolling` makes. (Neimark and Fufaev,
/// Dynamics of Nonholonomic Systems, 1972.)

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotated_plane.hpp>
#include <lagroid/systems/instances.hpp>

#include <vector>

namespace lagroid {

/// A ball of mass m, radius r and moment of inertia k m r^2 rolls without slipping on a horizontal plate that turns at
/// the rate Omega about the origin; nothing holds its spin about the vertical. The mechanics behind the control problem
/// of PlateBall, on the same groupoid R^2 x R^2 x SO(3) => R^2 and with the same two constraints of rolling:
///
///     L = (m |q1 - q0|^2 + k m r^2 |h w|^2) / (2 h)
///     phi1 = (y1 - y0) + r h w1 - h Omega (x0 + x1)/2      phi2 = (x1 - x0) - r h w2 + h Omega (y0 + y1)/2
///
/// The ball's attitude is R, its angular velocity in space w, R_k = exp(h w) R_{k-1}. Arrows compose from the right, so
/// that the SO(3) part of the groupoid carries A = R^T: g = R_{k-1} R_k^T, h w = -log g, and M = -k m r^2 w.
///
/// The centre moves on a circle, at the rate k Omega / (1 + k) whatever its start: 2 Omega / 7 for a homogeneous ball
/// (Neimark & Fufaev, Dynamics of Nonholonomic Systems, 1972). The discrete one goes round the very same
/// circle, through states of the continuous motion, at the rate (2 / h) atan(h k Omega / (2 (1 + k))).
struct RollingBall : System<RollingBall, Product<Pair<2>, SO3>, /*arrow constraints*/ 2> {
  using GroupoidType = Product<Pair<2>, SO3>;
  static constexpr auto principle = Principle::nonholonomic;

  double h = 0.05;              ///< time step, s
  double mass = 1;              ///< m, kg
  double radius = 1;            ///< r, m
  double inertia_factor = 0.4;  ///< k: 2/5 for a homogeneous ball, 2/3 for a hollow one
  double plate_rate = 0;        ///< Omega, rad/s

  static auto parameters() {
    return std::tuple(parameter("mass", &RollingBall::mass, "kg", "of the ball", positive),
                      parameter("radius", &RollingBall::radius, "m", "of the ball", positive),
                      parameter("inertia_factor", &RollingBall::inertia_factor, "1",
                                "moment of inertia over mass times radius squared", positive),
                      parameter("plate_rate", &RollingBall::plate_rate, "rad/s", "angular velocity of the plate"));
  }
  std::optional<Refusal> refused() const {
    return refuse_lost_digits({"radius", "mass"}, "the inertia k m r^2", inertia());
  }

  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    const auto& [move, turn] = g;
    const Vector<S, 2> d = move.target - move.source;
    return (d.squaredNorm() * varied<S>(mass) + SO3::log(turn).squaredNorm() * inertia<S>()) * (0.5 / step);
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  template <class S, class T> Vector<S, 2> constraint(const Arrow<S>& g, const T& step) const {
    const auto& [move, turn] = g;
    const Vector<S, 2> d = move.target - move.source;
    const Vector<S, 2> middle = (move.source + move.target) * 0.5;
    const Vector<S, 3> w = -SO3::log(turn);
    const auto r = varied<S>(radius);
    const auto rate = varied<S>(plate_rate);
    return {d(1) + w(0) * r - middle(0) * (step * rate), d(0) - w(1) * r + middle(1) * (step * rate)};
  }
  template <class S> Vector<S, 2> constraint(const Arrow<S>& g) const { return constraint(g, h); }

  /// dy + r w1 and dx - r w2, as covectors: the same at every object.
  template <class S> Matrix<S, 5, 2> annihilator(const std::tuple<Vector<S, 2>, Vector<S, 0>>&) const {
    Matrix<S, 5, 2> omega = Matrix<S, 5, 2>::Constant(S(0));
    omega(1, 0) = 1;
    omega(2, 0) = -varied<S>(radius);
    omega(0, 1) = 1;
    omega(3, 1) = varied<S>(radius);
    return omega;
  }

  /// k m r^2.
  template <class S = double> ParameterScalar<S> inertia() const {
    return varied<S>(inertia_factor) * varied<S>(mass) * varied<S>(radius) * varied<S>(radius);
  }
  /// The angular velocity in space, w = -M / (k m r^2).
  Vector<double, 3> angular_velocity(const State<GroupoidType>& s) const { return s.momentum.tail<3>() / -inertia(); }
  /// The state of a ball that rolls: w1 and w2 follow from the velocity of its centre.
  State<GroupoidType> rolling(const Vector<double, 2>& position, const Vector<double, 2>& velocity, double spin) const;
  static constexpr std::array<std::string_view, 3> velocity_names{"vx", "vy", "spin"};
  /// Of the velocity of the centre and the spin: M = -k m r^2 w, with r w1 = Omega x - vy and r w2 = Omega y + vx.
  template <class S>
  Vector<S, 5> momentum_of(const std::tuple<Vector<S, 2>, Vector<S, 0>>& q, const Vector<S, 3>& v) const {
    const Vector<S, 2>& at = std::get<0>(q);
    const auto m = varied<S>(mass);
    const auto r = varied<S>(radius);
    const auto rate = varied<S>(plate_rate);
    Vector<S, 5> momentum;
    momentum << v(0) * m, v(1) * m, (v(1) - at(0) * rate) * inertia<S>() / r, (v(0) + at(1) * rate) * -inertia<S>() / r,
        v(2) * -inertia<S>();
    return momentum;
  }
  Vector<double, 3> velocities(const State<GroupoidType>& s) const {
    return {s.momentum(0) / mass, s.momentum(1) / mass, angular_velocity(s)(2)};
  }

  /// The displacement of a step at constant velocity.
  Step<RollingBall> first_guess(const State<GroupoidType>& s) const;

  /// m |v|^2 / 2 + k m r^2 |w|^2 / 2. A plate that turns does work.
  double energy(const State<GroupoidType>& s) const;
  /// E - Omega J, J the vertical angular momentum about the plate's centre: what is conserved where the plate turns
  /// (Fasso & Sansonetto, J. Nonlinear Sci. 26, 2016).
  double moving_energy(const State<GroupoidType>& s) const;

  /// The continuous solution after time t: m v' = F, k m r^2 w' = -r e3 x F, R' = hat(w) R, with the friction F that
  /// keeps the ball rolling. Returns the state and updates A = R^T.
  State<GroupoidType> reference(const State<GroupoidType>& start, Matrix<double, 3, 3>& attitude, double t) const;

  /// Turning the ball about its point of contact: sections of D that leave L unchanged, so that the angular momentum
  /// K = k m r^2 w + r e3 x m v about that point is conserved (nonholonomic Noether theorem: Bloch, Krishnaprasad,
  /// Marsden, Murray, Arch. Rational Mech. Anal. 136, 1996).
  std::vector<Symmetry<RollingBall>> symmetries() const;
  std::vector<Quantity<RollingBall>> quantities() const;
  static std::vector<ObservedName> observed_names() {
    return {{"momentum about the contact", "K1"},
            {"momentum about the contact", "K2"},
            {"momentum about the contact", "K3 = k m r^2 w3"},
            {"E", "energy"},
            {"E - Omega J", "moving energy E - Omega J"},
            {"angular_velocity", "w1"},
            {"angular_velocity", "w2"},
            {"angular_velocity", "w3"}};
  }
  template <class S> Vector<S, 8> observed(const State<GroupoidType, S>& s, const Arrow<S>& /*configuration*/) const {
    const Vector<S, 2>& q = std::get<0>(s.object);
    const auto& mu = s.momentum;
    const auto r = varied<S>(radius);
    const Vector<S, 3> turning = mu.template tail<3>();
    const Vector<S, 3> w = turning / constant<S>(-inertia<S>());
    const S energy = ((mu(0) * mu(0) + mu(1) * mu(1)) / varied<S>(mass) - turning.dot(w)) * 0.5;
    Vector<S, 8> out;
    out << -mu(1) * r - mu(2), mu(0) * r - mu(3), -mu(4), energy,
        energy - (q(0) * mu(1) - q(1) * mu(0) - mu(4)) * varied<S>(plate_rate), w;
    return out;
  }
  static auto reductions() {
    return std::tuple(reduction("rotations", RotatedPlaneQuotient{}, "rotations of plate and ball about its centre"),
                      reduction("translations", ProductMorphism<Difference<2>, IdentityMorphism<SO3>>{},
                                "translations, where the plate is at rest"));
  }
};

LAGROID_STEPS(extern template, RollingBall);
LAGROID_STEP_SOLVERS(extern template, RollingBall);

}  // namespace lagroid
