#pragma once
/// Optimal control of a ball that rolls on a rotating plate, on R^2 x R^2 x SO(3) => R^2:
///
///     L = h (u^2 + v^2) / 2,    phi1 = dy + r w1 - h Omega x,    phi2 = dx - r w2 + h Omega y,    phi3 = h c - w3.
///
/// The paper's example: a groupoid that is no group, with constraints that are not integrable.
///
///     PlateBall system;
///     system.h = 0.1;
///     system.plate_rate = 0.5;
///
/// Requires a positive radius; `infeasible` has the reason where parameters admit no motion. [G] 6.2, (8)

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

#include <optional>
#include <string>
#include <vector>

namespace lagroid {

/// How the rotation g of one step becomes w = h omega: the paper's trace form w = vee(g) (rotation angle below pi/2),
/// w = log g, or w = cay^{-1}(g).
enum class RotationForm { trace, exponential, cayley };
inline constexpr std::array<std::string_view, 3> rotation_form_words{"trace", "exp", "cayley"};

/// The plate-ball system on the groupoid R^2 x R^2 x SO(3) => R^2.
///
/// Arrow: the contact point moves from (x0, y0) to (x1, y1) while the attitude turns by g, A_k = A_{k-1} g_k.
/// Cost  L = h (u^2 + v^2)/2 with (u, v) the velocity of the contact point; constraints ([G] (8)), with w = h omega(g):
///
///     phi1 = (y1 - y0) + r w1 - h Omega (x0 + x1)/2      phi2 = (x1 - x0) - r w2 + h Omega (y0 + y1)/2
///     phi3 = h c - w3
///
/// Momentum mu = (px, py, M1, M2, M3), M the body momentum. Composition from the right makes omega a body velocity of
/// A; the ball one sees has attitude A^T with (r, c) -> (-r, -c).
struct PlateBall : System<PlateBall, Product<Pair<2>, SO3>, /*arrow constraints*/ 3> {
  using GroupoidType = Product<Pair<2>, SO3>;
  using Arrows = std::vector<ArrowOf<GroupoidType>>;

  double h = 0.05;        ///< time step, s
  double radius = 1;      ///< r, m
  double plate_rate = 0;  ///< Omega, rad/s
  double spin = 0;        ///< c, the prescribed rate about the vertical, rad/s
  RotationForm rotation = RotationForm::trace;

  static auto parameters() {
    return std::tuple(parameter("radius", &PlateBall::radius, "m", "of the ball", positive),
                      parameter("plate_rate", &PlateBall::plate_rate, "rad/s", "angular velocity of the plate"),
                      parameter("spin", &PlateBall::spin, "rad/s", "prescribed rate about the vertical"),
                      choice("rotation", &PlateBall::rotation, rotation_form_words, "form of the constraints"));
  }

  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    const auto& [move, turn] = g;
    return Vector<S, 2>(move.target - move.source).squaredNorm() * (0.5 / step);
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  template <class S, class T> Vector<S, 3> constraint(const Arrow<S>& g, const T& step) const {
    const auto& [move, turn] = g;
    const Vector<S, 2> d = move.target - move.source;
    const Vector<S, 2> middle = (move.source + move.target) * 0.5;
    const Vector<S, 3> w = rotation_vector(turn);
    const auto r = varied<S>(radius);
    const auto rate = varied<S>(plate_rate);
    return {d(1) + w(0) * r - middle(0) * (step * rate), d(0) - w(1) * r + middle(1) * (step * rate),
            constant<S>(step * varied<S>(spin)) - w(2)};
  }
  template <class S> Vector<S, 3> constraint(const Arrow<S>& g) const { return constraint(g, h); }

  /// w(g) in the chosen form.
  template <class S> Vector<S, 3> rotation_vector(const Matrix<S, 3, 3>& turn) const {
    if (rotation == RotationForm::trace) return SO3::vee(turn);
    return SO3::retract_inverse(retraction(), turn);
  }
  /// The rotation g with rotation_vector(g) = w. In the trace form |w| is cut at one.
  Matrix<double, 3, 3> rotation_of(const Vector<double, 3>& w) const;

  /// In the trace form the rotation angle of a step stays below pi/2: tr g = 1 + 2 cos(angle) > 1. Of the form's four
  /// roots this leaves the one that is continuous in h. In the Cayley form 1 + tr g = 4 / (1 + |w|^2 / 4) keeps half
  /// its digits: nearer to a half turn w would be round-off, and any equation of it seem solved.
  template <class S> MaskOf<S> admissible(const Arrow<S>& g) const {
    if (rotation == RotationForm::exponential) return true;
    return std::get<1>(g).trace() > (rotation == RotationForm::trace ? 1 : -1 + 1e-8);
  }

  /// lambda = (M1/r, -M2/r, -M3), u = px - l2 - h Omega l1/2, v = py - l1 + h Omega l2/2: exact as h -> 0.
  Step<PlateBall> first_guess(const State<GroupoidType>& s) const;

  /// The velocity of the contact point and the angular velocity of the continuous extremal at q, p = (px, py) and M:
  /// linear in these and the spin, so that their rates are the same map of the rates of q, p and M, without spin.
  template <class S> struct Rolling {
    Vector<S, 2> velocity;
    Vector<S, 3> omega;
  };
  template <class S>
  Rolling<S> rolling(const Vector<S, 2>& q, const Vector<S, 2>& p, const Vector<S, 3>& m,
                     const ParameterScalar<S>& about_vertical) const {
    const auto r = varied<S>(radius);
    const auto rate = varied<S>(plate_rate);
    const Vector<S, 2> velocity(p(0) + m(1) / r, p(1) - m(0) / r);
    return {velocity, {(q(0) * rate - velocity(1)) / r, (velocity(0) + q(1) * rate) / r, constant<S>(about_vertical)}};
  }
  /// px' = -Omega l1, py' = Omega l2.
  template <class S> Vector<S, 2> force(const Vector<S, 3>& m) const {
    return Vector<S, 2>(-m(0), -m(1)) * constant<S>(varied<S>(plate_rate) / varied<S>(radius));
  }

  /// Of sigma = 1 / |omega|, omega the angular velocity of the continuous extremal.
  template <class S> S time_scale_rate(const Object<S>& object, const Vector<S, 5>& mu) const {
    const Vector<S, 3> m = mu.template tail<3>();
    const Rolling<S> now = rolling<S>(std::get<0>(object), mu.template head<2>(), m, varied<S>(spin));
    const Rolling<S> rate = rolling<S>(now.velocity, force<S>(m), m.cross(now.omega), 0.0);
    const S size = now.omega.squaredNorm();
    if (!(size > S(0.0))) return S(0.0);
    return -now.omega.dot(rate.omega) / size;
  }
  double time_scale_rate(const State<GroupoidType>& s) const { return time_scale_rate(s.object, s.momentum); }

  /// Why no trajectory of this system exists, or nothing: |c h| at or beyond the range of w3 in the chosen form, or
  /// parameters that make no sense.
  std::optional<std::string> infeasible() const;

  /// A composable path of `steps` arrows whose product is `boundary`: the contact point moves along the straight line
  /// plus sum_j modes.col(j) sin((j + 1) pi s), the attitude follows the rolling constraint and is then bent, in
  /// proportion to time, to end where it must. A starting guess, not a solution.
  Arrows path(const ArrowOf<GroupoidType>& boundary, long steps,
              const Eigen::Matrix2Xd& modes = Eigen::Matrix2Xd::Zero(2, 1)) const;

  /// E = (u^2 + v^2)/2 + Omega (l1 x - l2 y) - c l3 on a step over the time h, (x, y) its midpoint: the integral of the
  /// continuous problem (Pontryagin).
  double energy(const Step<PlateBall>& step, double over) const;
  double energy(const Step<PlateBall>& step) const { return energy(step, h); }

  /// The continuous extremal (Pontryagin) after time t: with l1 = M1/r, l2 = -M2/r,
  ///     x' = px - l2, y' = py - l1, px' = -Omega l1, py' = Omega l2, M' = M x omega, A' = A hat(omega).
  /// Returns the state and updates `attitude`.
  State<GroupoidType> reference(const State<GroupoidType>& start, Matrix<double, 3, 3>& attitude, double t) const;

  /// Turning the table and all on it about its centre; with the plate at rest, moving them.
  std::vector<Symmetry<PlateBall>> symmetries() const;
  std::vector<Quantity<PlateBall>> quantities() const;
  static std::vector<ObservedName> observed_names() {
    return {{"spatial momentum A M", "(AM)1"},
            {"spatial momentum A M", "(AM)2"},
            {"spatial momentum A M", "(AM)3"},
            {"J", "J = x py - y px - M3"}};
  }
  template <class S> Vector<S, 4> observed(const State<GroupoidType, S>& s, const Arrow<S>& configuration) const {
    const Vector<S, 2>& q = std::get<0>(s.object);
    const auto& mu = s.momentum;
    const Vector<S, 3> spatial = std::get<1>(configuration) * mu.template tail<3>();
    Vector<S, 4> out;
    out << spatial, q(0) * mu(1) - q(1) * mu(0) - mu(4);
    return out;
  }
  static auto reductions() {
    return std::tuple(reduction("translations", ProductMorphism<Difference<2>, IdentityMorphism<SO3>>{},
                                "translations, where the plate is at rest"),
                      reduction("rotations", RotatedPlaneQuotient{}, "rotations of plate and ball about its centre"));
  }

 private:
  /// Of the forms that are one.
  Retraction retraction() const {
    return rotation == RotationForm::cayley ? Retraction::cayley : Retraction::exponential;
  }
};

LAGROID_STEPS(extern template, PlateBall);
LAGROID_SOLVERS(extern template, PlateBall);

}  // namespace lagroid
