#pragma once
/// An upright disk that rolls on the plane, nonholonomic on SE(2) x SO(2):
///
///     l = (m (v1^2 + v2^2) + J w^2 + I s^2) / 2,    v1 - R s = 0,    v2 = 0.
///
/// Its motion is known, circles at constant rates, and the discrete one is of the same kind.
///
///     const RollingDisk disk;
///     const auto start = disk.rolling(0.5, 2);  // w, s
///     const double energy = disk.energy(start);
///
/// Requires positive parameters, and starts that roll, which `rolling` makes. (Bloch, Nonholonomic Mechanics and
/// Control, chapter 1.)

#include <lagroid/core/capabilities/balance.hpp>
#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/systems/instances.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace lagroid {

/// A disk of mass m and radius R stays upright, rolls without slipping and turns about the vertical: the vertical
/// rolling disk (Bloch, Nonholonomic Mechanics and Control, chapter 1), on the group SE(2) x SO(2). With
/// xi = (w, v1, v2) the velocity of the point of contact in the disk's frame, v1 ahead, and s the rate at which it
/// rolls, read from an arrow by log / h:
///
///     l = (m (v1^2 + v2^2) + J w^2 + I s^2) / 2,    v1 - R s = 0,    v2 = 0.
///
/// It rolls at constant rates w and s, on a circle of radius R s / w or straight on. So does the discrete one: w, s and
/// the momentum are constant to round-off, the rates off by O(h^2).
/// Momentum (J w, m v1, m v2, I s).
struct RollingDisk : System<RollingDisk, Product<SE2, SO2>, /*arrow constraints*/ 2> {
  using GroupoidType = Product<SE2, SO2>;
  static constexpr auto principle = Principle::nonholonomic;

  double h = 0.05;                ///< time step, s
  double mass = 1;                ///< m, kg
  double radius = 1;              ///< R, m
  double rolling_inertia = 0.5;   ///< I, about the disk's axis, kg m^2
  double turning_inertia = 0.25;  ///< J, about the vertical, kg m^2

  static auto parameters() {
    return std::tuple(
        parameter("mass", &RollingDisk::mass, "kg", "of the disk", positive),
        parameter("radius", &RollingDisk::radius, "m", "of the disk", positive),
        parameter("rolling_inertia", &RollingDisk::rolling_inertia, "kg m^2", "about its axis", positive),
        parameter("turning_inertia", &RollingDisk::turning_inertia, "kg m^2", "about the vertical", positive));
  }

  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    const auto& [move, roll] = g;
    const Vector<S, 3> d = SE2::log(move);
    const S angle = SO2::log(roll)(0);
    return (d.template tail<2>().squaredNorm() * varied<S>(mass) + d(0) * d(0) * varied<S>(turning_inertia) +
            angle * angle * varied<S>(rolling_inertia)) *
           (0.5 / step);
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  /// h (v1 - R s, v2): the same for every step size.
  template <class S, class T> Vector<S, 2> constraint(const Arrow<S>& g, const T& /*step*/) const {
    const auto& [move, roll] = g;
    const Vector<S, 3> d = SE2::log(move);
    return {d(1) - SO2::log(roll)(0) * varied<S>(radius), d(2)};
  }
  template <class S> Vector<S, 2> constraint(const Arrow<S>& g) const { return constraint(g, h); }

  /// The state of a disk that turns and rolls at the given rates.
  State<GroupoidType> rolling(double turning, double rate) const {
    State<GroupoidType> s;
    s.momentum = momentum_of(s.object, Vector<double, 2>(turning, rate));
    return s;
  }
  static constexpr std::array<std::string_view, 2> velocity_names{"w", "s"};
  /// Of (w, s).
  template <class S>
  Vector<S, 4> momentum_of(const ObjectOf<GroupoidType, S>& /*the one there is*/, const Vector<S, 2>& v) const {
    return {v(0) * varied<S>(turning_inertia), v(1) * (varied<S>(mass) * varied<S>(radius)), S(0),
            v(1) * varied<S>(rolling_inertia)};
  }
  /// (w, s) of a state that rolls.
  Vector<double, 2> velocities(const State<GroupoidType>& s) const {
    return {s.momentum(0) / turning_inertia, s.momentum(3) / rolling_inertia};
  }

  /// The kinetic energy.
  double energy(const State<GroupoidType>& s) const;

  /// The continuous solution after time t, in closed form: the momentum stays; updates the configuration.
  State<GroupoidType> reference(const State<GroupoidType>& start, ArrowOf<GroupoidType>& configuration, double t) const;

  /// Turning, and rolling ahead: sections that span D.
  std::vector<Symmetry<RollingDisk>> sections() const;
  std::vector<Quantity<RollingDisk>> quantities() const;
  static std::vector<ObservedName> observed_names() { return {{"E", "energy"}, {"rates", "w"}, {"rates", "s"}}; }
  template <class S> Vector<S, 3> observed(const State<GroupoidType, S>& z, const Arrow<S>& /*configuration*/) const {
    const auto& mu = z.momentum;
    const S w = mu(0) / varied<S>(turning_inertia);
    const S s = mu(3) / varied<S>(rolling_inertia);
    return {(mu(0) * w + (mu(1) * mu(1) + mu(2) * mu(2)) / varied<S>(mass) + mu(3) * s) * 0.5, w, s};
  }
};

LAGROID_STEPS(extern template, RollingDisk);
LAGROID_STEP_SOLVERS(extern template, RollingDisk);

}  // namespace lagroid
