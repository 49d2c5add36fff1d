#pragma once
/// The discrete constrained action principle as laws of any system,
///
///     d sum_k L(g_k) = 0  along every variation that keeps  g_1 ... g_n,  phi(g_k) = 0  and  C(q_k) = 0,
///
/// with derivatives that share nothing with those of the solvers.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     std::cout << laws::variational_laws(Kepler{}, draw);
///
/// Requires a variational system that does not depend on time, and states from which a step can be taken. [G] section
/// 5, Theorem 5.1

#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/hamiltonian/lagrangian.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/solvers/boundary/boundary_problem.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>

#include <cstddef>
#include <limits>
#include <utility>

namespace lagroid::laws {

namespace detail {

/// Columns of length one that span the kernel of `a`, which must be finite; all of the space where it has no rows.
/// Throws NotSampled where rows are nearly dependent, as constraints are beside abnormal paths: the kernel is then
/// noise.
inline Eigen::MatrixXd kernel_of(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) return Eigen::MatrixXd::Identity(a.cols(), a.cols());
  const auto balance = Scaling<Eigen::Dynamic, Eigen::Dynamic>::equilibrate(a);
  const auto [sigma, v, rank] = right_singular_vectors(balance.apply(a), 1e-12);
  for (Eigen::Index i = 0; i < rank; ++i)
    if (sigma(i) < 1e-9 * sigma(0)) throw NotSampled("constraints nearly dependent along a path from the state drawn");
  Eigen::MatrixXd kernel = balance.column.asDiagonal() * v.rightCols(a.cols() - rank);
  kernel.colwise().normalize();
  return kernel;
}

/// The first variation of a trajectory g_1 ... g_n with a fixed product, in the displacements v_1 ... v_{n-1} of its
/// inner nodes, one after the other: the conditions phi(g_k) = 0, C(q_k) = 0 with their derivatives, and the derivative
/// of the action sum L(g_1) + ... + L(g_n).
struct FirstVariation {
  Eigen::VectorXd conditions;
  Eigen::MatrixXd derivative;
  Eigen::VectorXd action;
  /// Of the terms of the action's derivative; no less than what makes a hundred times their round-off 1e-10 of it.
  double size = 0;
};

/// The derivatives of L at g as its source and its target are displaced along the fibre's basis, by the groupoid's own
/// operations: they share nothing with the derivatives that the solvers use.
template <DiscreteSystem Sys>
std::pair<AlgebroidVector<typename Sys::GroupoidType>, AlgebroidVector<typename Sys::GroupoidType>>
lagrangian_derivatives(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  using V = AlgebroidVector<typename Sys::GroupoidType>;
  const auto& groupoid = system.groupoid;
  const auto gd = groupoid.template cast<Dual<double>>(g);
  std::pair<V, V> out;
  for (int i = 0; i < V::SizeAtCompileTime; ++i) {
    const auto e = infinitesimal(V(V::Unit(i)));
    const auto before = groupoid.inverse(groupoid.tau(groupoid.source(gd), e));
    out.first(i) = system.lagrangian(groupoid.multiply(before, gd)).derivative;
    out.second(i) = system.lagrangian(groupoid.multiply(gd, groupoid.tau(groupoid.target(gd), e))).derivative;
  }
  return out;
}

template <DiscreteSystem Sys> FirstVariation first_variation(const Sys& system, const Path<Sys>& path) {
  constexpr int n = Sys::dimension;
  constexpr int phis = Sys::arrow_constraints;
  constexpr int objects = Sys::object_constraints;
  const Eigen::Index count = Eigen::Index(path.size());
  FirstVariation out;
  out.conditions.setZero(count * phis + (count - 1) * objects);
  out.derivative.setZero(out.conditions.size(), (count - 1) * n);
  out.action.setZero((count - 1) * n);
  Eigen::Index row = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Step<Sys>& step = path[std::size_t(k)];
    const auto d = two_sided(system, step.arrow, step.multipliers);
    const auto [at_source, at_target] = lagrangian_derivatives(system, step.arrow);
    const bool has_target = k + 1 < count;
    out.conditions.segment(row, phis) = d.constraint.template head<phis>();
    if (k > 0) {
      out.action.template segment<n>((k - 1) * n) += at_source;
      out.derivative.block(row, (k - 1) * n, phis, n) = d.constraint_source.template leftCols<phis>().transpose();
    }
    if (has_target) {
      out.action.template segment<n>(k * n) += at_target;
      out.derivative.block(row, k * n, phis, n) = d.constraint_target.template topRows<phis>();
      out.conditions.segment(row + phis, objects) = d.constraint.template tail<objects>();
      out.derivative.block(row + phis, k * n, objects, n) = d.constraint_target.template bottomRows<objects>();
    }
    row += phis + (has_target ? objects : 0);
    out.size = worst({out.size, at_source.norm(), at_target.norm(), size_of_round_off(system, step, d)});
  }
  return out;
}

/// How far a trajectory is from critical: the derivative of the action along admissible variations, those that keep the
/// constraints to first order, relative to its terms.
inline double criticality_defect(const FirstVariation& v) {
  if (!v.derivative.allFinite() || !v.action.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd admissible = kernel_of(v.derivative);
  const double left = admissible.cols() == 0 ? 0 : (admissible.transpose() * v.action).norm();
  return left == 0 ? 0 : left / v.size;
}

/// The variation of n - 1 nodes with the coordinates v.
template <DiscreteSystem Sys> Variation<Sys> variation_of(const Eigen::VectorXd& v) {
  constexpr int n = Sys::dimension;
  Variation<Sys> out(std::size_t(v.size() / n) + 1);
  for (std::size_t k = 0; k + 1 < out.nodes.size(); ++k) out.nodes[k] = v.template segment<n>(Eigen::Index(k) * n);
  return out;
}

}  // namespace detail

/// Along trajectories from random states: displacements of inner nodes keep the product; the admissible variations of
/// two arrows are those of Theorem 5.1; trajectories of the dynamics are critical for the action sum, with two arrows
/// and with `count`; admissible ones nearby are not.
template <DiscreteSystem Sys, class Draw>
LawReport variational_laws(const Sys& system, const Draw& draw, std::size_t count = 5, double tolerance = 1e-10) {
  using G = typename Sys::GroupoidType;
  constexpr int n = Sys::dimension;
  const G& groupoid = system.groupoid;
  const auto trajectory = [&](std::size_t arrows) {
    auto integrator = detail::newton_integrator(system, draw());
    Path<Sys> path;
    for (std::size_t k = 0; k < arrows; ++k) {
      if (const auto report = integrator.advance(); !report.converged()) throw detail::no_step(report);
      path.push_back(integrator.point().step);
    }
    return path;
  };
  const auto product = [&](const Path<Sys>& path) {
    ArrowOf<G> g = path.front().arrow;
    for (std::size_t k = 1; k < path.size(); ++k) g = groupoid.multiply(g, path[k].arrow);
    return g;
  };
  const auto random_nodes = [&](double size) {
    Eigen::VectorXd v(Eigen::Index(count - 1) * n);
    for (double& x : v) x = size * draw_uniform();
    return v;
  };

  LawReport report{"action principle", {}};
  const auto law = [&](const char* name, double bound, const auto& defect) {
    report.laws.push_back(check_law(name, bound, defect));
  };
  law("displaced nodes keep the product", tolerance, [&] {
    const auto path = trajectory(count);
    const ArrowOf<G> g = product(path);
    const auto moved = displaced({system, g}, path, detail::variation_of<Sys>(random_nodes(0.1)), 1.0);
    return detail::relative_defect(groupoid.coordinates_of_arrow(product(moved)), groupoid.coordinates_of_arrow(g));
  });
  law("variations of two arrows (Theorem 5.1)", tolerance, [&] {
    // (X<-(g1), -X->(g2)) spans the tangent space of {(g1, g2) in N x N composable, g1 g2 fixed}, found from its
    // equations.
    constexpr int size = total_dimension_of<G>();
    using X = Vector<double, 2 * size>;
    const auto path = trajectory(2);
    const CotangentGroupoid<G> cotangent(groupoid);
    const GeneratedSubmanifold<Sys> submanifold(system);
    const Eigen::MatrixXd all = jacobian(X(X::Zero()), [&](const auto& x) {
      using S = typename std::remove_cvref_t<decltype(x)>::Scalar;
      const auto g1 = CotangentChart<G>(cotangent, path[0].arrow).arrow(x.template head<size>().eval());
      const auto g2 = CotangentChart<G>(cotangent, path[1].arrow).arrow(x.template tail<size>().eval());
      const auto q = groupoid.template cast_object<S>(groupoid.target(path[0].arrow));
      constexpr int objects = object_dimension_of<G>();
      constexpr int arrows = G::arrow_coordinate_count();
      Vector<S, objects + arrows + 2 * GeneratedSubmanifold<Sys>::conditions> equations;
      equations << groupoid.object_displacement(q, groupoid.target(g1)) -
                       groupoid.object_displacement(q, groupoid.source(g2)),
          groupoid.coordinates_of_arrow(groupoid.multiply(g1, g2)), submanifold.conditions_at(g1),
          submanifold.conditions_at(g2);
      return equations;
    });
    const Eigen::MatrixXd conditions = detail::first_variation(system, path).derivative;
    if (!all.allFinite() || !conditions.allFinite()) return std::numeric_limits<double>::infinity();
    const Eigen::MatrixXd fibre = detail::kernel_of(conditions);
    if (detail::kernel_of(all).cols() != fibre.cols()) {
      if (fibre.cols() > conditions.cols() - conditions.rows())
        throw NotSampled("constraints dependent along a path from the state drawn");
      return 1.0;
    }
    const TangentBasis<G> basis(groupoid);
    const auto second = groupoid.template cast<Dual<double>>(path[1].arrow);
    Eigen::MatrixXd image(2 * size, fibre.cols());
    image.setZero();
    for (Eigen::Index j = 0; j < fibre.cols(); ++j) {
      const AlgebroidVector<G> v = fibre.col(j);
      image.col(j).template head<n>() = v;
      image.col(j).tail(size) = basis.template components<double>(
          path[1].arrow, basis.template right<double>(second, AlgebroidVector<G>(-v)));
    }
    const Eigen::MatrixXd moved = all * image / all.cwiseAbs().maxCoeff();
    return detail::relative_defect(moved, Eigen::MatrixXd::Zero(moved.rows(), moved.cols()).eval());
  });
  law("two arrows of the dynamics are critical", tolerance,
      [&] { return detail::criticality_defect(detail::first_variation(system, trajectory(2))); });
  law("trajectories are critical", tolerance,
      [&] { return detail::criticality_defect(detail::first_variation(system, trajectory(count))); });
  law("admissible neighbours are not", 0, [&] {
    auto path = trajectory(count);
    const BoundaryProblem<Sys> problem{system, product(path)};
    auto v = detail::first_variation(system, path);
    if (!v.derivative.allFinite()) return 1.0;
    const Eigen::MatrixXd admissible = detail::kernel_of(v.derivative);
    if (admissible.cols() == 0) return 0.0;
    // Off by a fiftieth of an arrow, or where arrows vanish by many round-offs of them, and back to the constraints.
    double length = 0;
    for (const auto& s : path)
      length = worst({length, 0.02 * groupoid.tau_inverse(s.arrow).norm(),
                      1e6 * std::numeric_limits<double>::epsilon() * groupoid.coordinates_of_arrow(s.arrow).norm()});
    if (length == 0) length = 1e-3;
    Eigen::VectorXd step = length * admissible.rowwise().sum().normalized();
    for (int iteration = 0; iteration < 6; ++iteration) {
      path = displaced(problem, path, detail::variation_of<Sys>(step), 1.0);
      v = detail::first_variation(system, path);
      if (v.conditions.size() == 0) break;
      step = -least_squares(v.derivative, v.conditions);
    }
    const bool on_constraints = v.conditions.size() == 0 || v.conditions.norm() < 1e-6 * length * v.derivative.norm();
    return double(!on_constraints || detail::criticality_defect(v) < 10 * tolerance);
  });
  return report;
}

}  // namespace lagroid::laws
