#pragma once
/// The source fibre of an arrow z in the coordinates of the retraction: y = z tau(v), v in R^n. On a Lie group it is
/// the group.
///
/// Newton's method for an equation F(y) = 0 on a group or a groupoid works in these coordinates, and needs nothing else
/// of it.
///
///     const GroupoidFibre<SO3> fibre(SO3::unit(Vector<double, 0>()));
///     const auto y = fibre.at(Vector<double, 3>(0.1, 0, 0));  // exp of a rotation vector
///     const auto v = fibre.coordinates(y);                    // (0.1, 0, 0); a std::optional
///
/// Requires of a fibre of one's own the functions listed at `SourceFibre`; sizes may be fixed or chosen at run time.
/// `coordinates` returns nothing where y is out of reach of the retraction. Nothing throws.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/groupoid.hpp>

#include <Eigen/LU>

#include <concepts>
#include <optional>
#include <type_traits>

namespace lagroid {

/// What Newton's method requires of a source fibre y = z tau(v):
///
///     fibre.centre()         z
///     fibre.at(v)            z tau(v)
///     fibre.coordinates(y)   v with z tau(v) = y, on the principal branch; nothing where y is out of reach
///     fibre.moved(y, u)      y tau(u)
///     fibre.around(y)        the fibre again, y its centre
///     fibre.dtau(v)          the matrix of dtau_v(u) = d/dt tau(v)^{-1} tau(v + t u)
///     fibre.dtau_inverse(v)  its inverse
///     fibre.norm(u)          the norm of elements of the algebra, for tests of convergence
///
/// and, for truncated series and for automatic differentials (solvers/newton/lie_differentials.hpp),
///
///     fibre.ad(v)            the matrix of [v, .]
///     fibre.displaced(y, u)  y tau(e u) over dual numbers, e the infinitesimal
template <class F>
concept SourceFibre = requires(const F& fibre, const typename F::Point& y, const typename F::Vector& v) {
  { fibre.dimension() } -> std::convertible_to<Eigen::Index>;
  { fibre.centre() } -> std::convertible_to<typename F::Point>;
  { fibre.at(v) } -> std::convertible_to<typename F::Point>;
  { fibre.coordinates(y) } -> std::same_as<std::optional<typename F::Vector>>;
  { fibre.moved(y, v) } -> std::convertible_to<typename F::Point>;
  { fibre.dtau(v) } -> std::convertible_to<typename F::Matrix>;
  { fibre.dtau_inverse(v) } -> std::convertible_to<typename F::Matrix>;
  { fibre.norm(v) } -> std::convertible_to<double>;
  { fibre.around(y) } -> std::convertible_to<F>;
};

/// A matrix and its change, as one matrix of dual numbers.
template <class S>
Eigen::MatrixX<Dual<S>> infinitesimally_moved(const Eigen::MatrixX<S>& y, const Eigen::MatrixX<S>& change) {
  return y.binaryExpr(change, [](S value, S derivative) { return Dual<S>{value, derivative}; });
}

/// The fibre of any groupoid of ours. Differentials are G's closed forms where the retraction is exp and G has them,
/// else exact by dual numbers.
template <Groupoid G> class GroupoidFibre {
 public:
  static constexpr int n = G::dimension;
  using Point = ArrowOf<G>;
  using Vector = lagroid::Vector<double, n>;
  using Matrix = lagroid::Matrix<double, n, n>;

  explicit GroupoidFibre(const Point& z, const G& groupoid = {}) : groupoid_(groupoid), z_(z) {}
  GroupoidFibre around(const Point& y) const { return GroupoidFibre(y, groupoid_); }

  Eigen::Index dimension() const { return n; }
  const Point& centre() const { return z_; }
  Point at(const Vector& v) const { return groupoid_.multiply(z_, groupoid_.tau(groupoid_.target(z_), v)); }
  std::optional<Vector> coordinates(const Point& y) const {
    const Vector v = groupoid_.tau_inverse(groupoid_.multiply(groupoid_.inverse(z_), y));
    if (!v.allFinite()) return std::nullopt;
    return v;
  }
  Point moved(const Point& y, const Vector& u) const {
    return groupoid_.project(groupoid_.multiply(y, groupoid_.tau(groupoid_.target(y), u)));
  }
  Matrix dtau(const Vector& v) const {
    if constexpr (closed_form) {
      return G::dexp(v);
    } else {
      using D = Dual<double>;
      const auto q = groupoid_.template cast_object<D>(groupoid_.target(z_));
      const auto back = groupoid_.inverse(groupoid_.tau(q, lagroid::Vector<D, n>(v.template cast<D>())));
      return jacobian_of<n>(
          [&](const lagroid::Vector<D, n>& moved) {
            return groupoid_.tau_inverse(groupoid_.multiply(back, groupoid_.tau(q, moved)));
          },
          v);
    }
  }
  Matrix dtau_inverse(const Vector& v) const {
    if constexpr (closed_form) {
      return G::dexp_inverse(v);
    } else {
      return dtau(v).inverse();
    }
  }
  /// The matrix of [v, .], on a Lie group.
  Matrix ad(const Vector& v) const requires requires { G::template ad<double>(v); }
  { return G::template ad<double>(v); }
  /// The Euclidean norm of the coordinates.
  double norm(const Vector& v) const { return v.norm(); }
  /// y tau(e u), e the infinitesimal.
  auto displaced(const Point& y, const Vector& u) const {
    const auto arrow = groupoid_.template cast<Dual<double>>(y);
    return groupoid_.multiply(arrow, groupoid_.tau(groupoid_.target(arrow), infinitesimal(u)));
  }

 private:
  static constexpr bool closed_form = requires(const Vector& v) {
    { G::dexp(v) } -> std::convertible_to<Matrix>;
    requires G::retraction == std::remove_cv_t<decltype(G::retraction)>::exponential;
  };

  [[no_unique_address]] G groupoid_;
  Point z_;
};

}  // namespace lagroid
