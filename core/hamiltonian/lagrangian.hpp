#pragma once
/// The Lagrangian submanifold Sigma_L = { d(L + <lambda, phi>)(g) : phi(g) = 0 } of T*G that a system generates, and
/// the linear maps of which its dynamics is made.
///
/// That the step is a Poisson map is a statement about Sigma_L; here it can be measured at a step.
///
///     const GeneratedSubmanifold<Sys> sigma(system);  // refers to the system
///     const SubmanifoldTangent tangent = sigma.tangent(step);
///     const double lagrangian = lagrangian_defect(tangent.canonical), poisson = poisson_defect(tangent);
///
/// Requires a variational system (else it does not compile), and a step that satisfies the constraints, whose
/// derivatives are independent there. Returns defects relative to the size of the terms, infinite where numbers are not
/// finite. Nothing throws.
///
/// Source: [G] Theorem 3.1, 3.3, Remark 2.17.

#include <lagroid/core/hamiltonian/symplectic.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid {

namespace detail {

/// A point of A*G without its derivatives.
template <class Cotangent, class Z> auto point_of(const Cotangent& cotangent, const Z& z) {
  const auto c = cotangent.coordinates_of_object(z);
  return cotangent.template object_at<double>(c.unaryExpr([](const auto& y) { return y.value; }).eval());
}
/// The derivative of a point of A*G over dual numbers, in the chart around its value.
template <class Cotangent, class Z> auto chart_derivative(const Cotangent& cotangent, const Z& z) {
  const auto centre = cotangent.template cast_object<Dual<double>>(point_of(cotangent, z));
  return derivative_of(cotangent.object_displacement(centre, z));
}
/// The Poisson tensor of A*G at z in that chart.
template <Groupoid G, class Z> Eigen::MatrixXd poisson_in_chart(const G& groupoid, const Z& z) {
  constexpr int n = G::dimension;
  constexpr int d = object_dimension_of<G>();
  const LieAlgebroid<G> algebroid(groupoid);
  const auto q = groupoid.template cast_object<Dual<double>>(z.object);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(d + n, d + n);
  for (int i = 0; i < n; ++i) {
    const Vector<double, n> e = Vector<double, n>::Unit(i);
    out.block(0, d + i, d, 1) =
        algebroid.along_anchor(z.object, e, [&](const auto& r) { return groupoid.object_displacement(q, r); });
  }
  out.bottomLeftCorner(n, d) = -out.topRightCorner(d, n).transpose();
  out.bottomRightCorner(n, n) = poisson_tensor(groupoid, z.object, z.momentum).bottomRightCorner(n, n);
  return out;
}

}  // namespace detail

/// T_mu Sigma_L at mu = d(L + <lambda, phi>)(g), by a basis: its columns in canonical coordinates of T*G, and their
/// images under T F- and T F+, in charts of A*G: object displacements, then momenta.
struct SubmanifoldTangent {
  Eigen::MatrixXd canonical;
  Eigen::MatrixXd minus;
  Eigen::MatrixXd plus;
  Eigen::MatrixXd poisson_minus;  ///< the Poisson tensor of A*G at F-(mu), in that chart
  Eigen::MatrixXd poisson_plus;   ///< and at F+(mu)
};

/// Sigma_L of (G, N, L) ([G] Theorem 3.1, 3.3): covectors that agree with dL on TN. N is cut out by the arrow
/// constraints phi and, for object constraints C, by C o alpha and C o beta, each with its multipliers; so the
/// dimension of Sigma_L is that of G.
template <DiscreteSystem Sys> class GeneratedSubmanifold {
  static_assert(Variational<Sys>, "no Lagrangian submanifold generates forces or nonholonomic reactions");

 public:
  using G = typename Sys::GroupoidType;
  static constexpr int size = total_dimension_of<G>();
  static constexpr int conditions = Sys::arrow_constraints + 2 * Sys::object_constraints;
  template <class S> using Multipliers = Vector<S, conditions>;  ///< of phi, C o alpha, C o beta

  /// Refers to the system.
  explicit GeneratedSubmanifold(Sys&&) = delete;
  explicit GeneratedSubmanifold(const Sys& system) : system_(system), cotangent_(system.groupoid) {}

  /// (phi(g), C(alpha(g)), C(beta(g))).
  template <class A> auto conditions_at(const A& g) const {
    using S = typename decltype(system_.groupoid.coordinates_of_arrow(g))::Scalar;
    Vector<S, conditions> c;
    if constexpr (Sys::arrow_constraints > 0) c.template head<Sys::arrow_constraints>() = system_.constraint(g);
    if constexpr (Sys::object_constraints > 0) {
      c.template segment<Sys::object_constraints>(Sys::arrow_constraints) =
          system_.object_constraint(system_.groupoid.source(g));
      c.template tail<Sys::object_constraints>() = system_.object_constraint(system_.groupoid.target(g));
    }
    return c;
  }

  /// d(L + <lambda, conditions>)(g).
  template <class S, class A>
  typename CotangentGroupoid<G>::template Arrow<S> covector(const A& g, const Multipliers<S>& lambda) const {
    const TangentBasis<G> basis(system_.groupoid);
    Vector<S, size> values;
    for (int i = 0; i < size; ++i) {
      const auto v = basis.template vector<S>(g, i);
      values(i) = system_.lagrangian(v).derivative;
      const auto c = conditions_at(v);
      for (int a = 0; a < conditions; ++a) values(i) += lambda(a) * c(a).derivative;
    }
    return {g, values};
  }

  /// The multipliers of a step of the dynamics: the object constraints at its target take none.
  static Multipliers<double> multipliers(const Step<Sys>& step) {
    Multipliers<double> lambda = Multipliers<double>::Zero();
    lambda.template head<Sys::constraints>() = step.multipliers;
    return lambda;
  }

  /// A basis of the tangent space at a step that satisfies the constraints (which must have independent derivatives
  /// there): columns of changes of the arrow, in the coordinates of CotangentChart, and of the multipliers.
  Eigen::MatrixXd directions(const Step<Sys>& step) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Identity(size + conditions, size);
    if constexpr (conditions > 0) {
      const CotangentChart<G> chart(cotangent_, step.arrow);
      const Eigen::MatrixXd normals = jacobian(Vector<double, size>(Vector<double, size>::Zero()), [&](const auto& x) {
                                        return conditions_at(chart.arrow(x));
                                      }).transpose();
      const Eigen::MatrixXd q = orthogonal_factor(normals);
      out.setZero();
      out.topLeftCorner(size, size - conditions) = q.rightCols(size - conditions);
      out.bottomRightCorner(conditions, conditions).setIdentity();
    }
    return out;
  }

  /// The covector of a step, moved infinitesimally along such a column.
  auto along(const Step<Sys>& step, const Eigen::VectorXd& column) const {
    using D = Dual<double>;
    const Vector<D, size> x = infinitesimal(Vector<double, size>(column.head(size)));
    const auto lambda = moved_along(multipliers(step), Multipliers<double>(column.tail(conditions)));
    return covector<D>(CotangentChart<G>(cotangent_, step.arrow).template arrow<D>(x), lambda);
  }

  /// The tangent space along `directions`.
  SubmanifoldTangent tangent(const Step<Sys>& step) const {
    const CotangentChart<G> chart(cotangent_, step.arrow);
    const auto mu = covector<double>(step.arrow, multipliers(step));
    const Eigen::MatrixXd columns = directions(step);
    SubmanifoldTangent out{Eigen::MatrixXd(2 * size, size), Eigen::MatrixXd(size, size), Eigen::MatrixXd(size, size),
                           detail::poisson_in_chart(system_.groupoid, cotangent_.source(mu)),
                           detail::poisson_in_chart(system_.groupoid, cotangent_.target(mu))};
    for (int i = 0; i < size; ++i) {
      const auto moved = along(step, columns.col(i));
      out.canonical.col(i) = derivative_of(chart.canonical(moved));
      out.minus.col(i) = detail::chart_derivative(cotangent_, cotangent_.source(moved));
      out.plus.col(i) = detail::chart_derivative(cotangent_, cotangent_.target(moved));
    }
    return out;
  }

  const CotangentGroupoid<G>& cotangent() const { return cotangent_; }

 private:
  const Sys& system_;
  CotangentGroupoid<G> cotangent_;
};

/// omega on tangent vectors given by columns in canonical coordinates, scaled to length one: zero on a basis of T
/// Sigma_L, because Sigma_L is Lagrangian.
double lagrangian_defect(const Eigen::MatrixXd& canonical);

/// Singular values of equilibrated matrices below this part of the largest count as zero.
inline constexpr double singular_threshold = 1e-9;

/// The ranks of T F- and T F+ on Sigma_L: equal, whatever they are ([G] Remark 2.17); -1 for a matrix that is not
/// finite.
struct LegendreRanks {
  long minus = 0;
  long plus = 0;
};
LegendreRanks legendre_ranks(const SubmanifoldTangent& tangent);

/// How far the dynamics is from Poisson. Where F- is a local diffeomorphism, F = F+ o (F-)^{-1} satisfies
/// DF Pi DF^T = Pi o F exactly when its graph is coisotropic in (A*G, -Pi) x (A*G, Pi), and in general the image of
/// Sigma_L under (F-, F+) is ([G], after Remark 2.17): covectors that annihilate it are orthogonal to one another.
/// Returns the largest product of two of length one, relative to Pi, all in coordinates in which the tangent maps are
/// equilibrated; round-off up to the condition of the maps there.
///
/// With object constraints a defect of zero means that the step is symplectic on the constrained phase space: among the
/// annihilating covectors are the differentials of C at both ends, along whose Hamiltonian vector fields momenta are
/// projected.
double poisson_defect(const SubmanifoldTangent& tangent);

/// The same for any map of A*G, as a step by another method: `map` takes a point (q, mu) over any scalar (DualPoint)
/// to such a point.
template <Groupoid G, class Map>
double poisson_defect(const G& groupoid, const typename CotangentGroupoid<G>::template Object<double>& z,
                      const Map& map) {
  constexpr int size = total_dimension_of<G>();
  using W = Vector<double, size>;
  const CotangentGroupoid<G> cotangent(groupoid);
  const auto centre = cotangent.template cast_object<Dual<double>>(z);
  SubmanifoldTangent graph;
  graph.minus = Eigen::MatrixXd::Identity(size, size);
  graph.plus.resize(size, size);
  for (int i = 0; i < size; ++i)
    graph.plus.col(i) =
        detail::chart_derivative(cotangent, map(cotangent.displace_object(centre, infinitesimal(W(W::Unit(i))))));
  graph.poisson_minus = detail::poisson_in_chart(groupoid, z);
  graph.poisson_plus = detail::poisson_in_chart(groupoid, detail::point_of(cotangent, map(centre)));
  return poisson_defect(graph);
}

}  // namespace lagroid
