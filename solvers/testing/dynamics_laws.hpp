#pragma once
/// The statements of [G] on the dynamics, as laws of any system: Sigma_L is Lagrangian, F- and F+ are source and target
/// of T*G and have equal rank, the step is a Poisson map, and runs backwards to where it began.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     std::cout << laws::dynamics_laws(Kepler{}, draw);
///
/// Requires a variational system and states from which a step can be taken. [G] Theorems 2.16 and 3.1, Def. 3.3,
/// Corollary 3.4

#include <lagroid/core/capabilities/reversed.hpp>
#include <lagroid/core/hamiltonian/lagrangian.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

namespace lagroid::laws {

namespace detail {

/// The difference of two momenta of a step, relative to their size or to that of their round-off.
template <DiscreteSystem Sys, class M>
double momentum_defect(const Sys& system, const Step<Sys>& step, const M& x, const M& y) {
  const double noise = size_of_round_off(system, step, two_sided(system, step.arrow, step.multipliers));
  return relative_defect(x, y) / std::max(1.0, noise / (1 + y.cwiseAbs().maxCoeff()));
}

/// The step (q, mu) -> (q', mu') that a solver makes, linearised by differences of solved steps: of order six, at
/// distances of 3e-4 (1 + |mu|) that leave about ten digits. Among object constraints q is moved along C^{-1}(0), and
/// mu' along their differentials, as in GeneratedSubmanifold. Throws NotSampled where a step is not solved.
template <DiscreteSystem Sys>
SubmanifoldTangent solved_graph(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                const MakeStepSolver<Sys>& make) {
  using G = typename Sys::GroupoidType;
  constexpr int n = Sys::dimension;
  constexpr int d = object_dimension_of<G>();
  constexpr int c = Sys::object_constraints;
  using Point = typename CotangentGroupoid<G>::template Object<double>;
  const G& groupoid = system.groupoid;
  const CotangentGroupoid<G> cotangent(groupoid);
  const auto step = [&](const Point& z) {
    FixedStepIntegrator<Sys> integrator(system, {z.object, z.momentum}, groupoid.unit(z.object), make());
    if (const auto report = integrator.advance(); !report.converged()) throw no_step(report);
    return integrator.point();
  };
  const Point from{start.object, start.momentum};
  const auto end = step(from);
  const Point to{end.state.object, end.state.momentum};

  Eigen::MatrixXd along = Eigen::MatrixXd::Identity(d, d);
  if constexpr (c > 0) {
    const Eigen::MatrixXd normals = jacobian(Vector<double, d>(Vector<double, d>::Zero()), [&](const auto& u) {
                                      using S = typename std::decay_t<decltype(u)>::Scalar;
                                      const auto q = groupoid.template cast_object<S>(from.object);
                                      return system.object_constraint(groupoid.displace_object(q, u));
                                    }).transpose();
    const Eigen::MatrixXd basis = orthogonal_factor(normals);
    along = basis.rightCols(d - c).eval();
  }
  SubmanifoldTangent graph{{},
                           Eigen::MatrixXd::Zero(d + n, d + n),
                           Eigen::MatrixXd::Zero(d + n, d + n),
                           lagroid::detail::poisson_in_chart(groupoid, from),
                           lagroid::detail::poisson_in_chart(groupoid, to)};
  graph.minus.topLeftCorner(d, d - c) = along;
  graph.minus.block(d, d - c, n, n).setIdentity();
  const double distance = 3e-4 * (1 + from.momentum.cwiseAbs().maxCoeff());
  constexpr std::array<double, 3> weights{0.75, -0.15, 1.0 / 60};
  for (int i = 0; i < d - c + n; ++i)
    for (int k = 1; k <= 3; ++k)
      for (const int sign : {-1, 1}) {
        const Vector<double, d + n> by = sign * k * distance * graph.minus.col(i);
        const auto moved = step(cotangent.displace_object(from, by)).state;
        graph.plus.col(i) += sign * weights[std::size_t(k - 1)] / distance *
                             cotangent.object_displacement(to, Point{moved.object, moved.momentum});
      }
  if constexpr (c > 0)
    graph.plus.bottomRightCorner(n, c) =
        two_sided(system, end.step.arrow, end.step.multipliers).constraint_target.template bottomRows<c>().transpose();
  return graph;
}

}  // namespace detail

/// At steps from random states: Sigma_L is Lagrangian ([G] Theorem 3.1), the discrete Legendre transforms are the
/// source and target of T*G (Def. 3.3) and have equal rank (Theorem 2.16, Corollary 3.4, Remark 2.17), the step is a
/// Poisson map (after Remark 2.17), and the system run backwards recovers the state.
///
/// That the step is Poisson is tested twice. Of the graph that L generates it is a theorem, whatever L: what can fail
/// are the derivatives. "The computed step is Poisson" tests the map that solvers from `make()` compute, by differences
/// and to 1e-7: it fails where a solver stops early or does not hand on what it has solved.
///
/// `draw()` returns a State from which a step can be taken. `Submanifold` is GeneratedSubmanifold<Sys> or, to see the
/// suite fail, a subclass with another tangent space.
template <DiscreteSystem Sys, class Draw, class Submanifold = GeneratedSubmanifold<Sys>>
LawReport dynamics_laws(const Sys& system, const Draw& draw, double tolerance = 1e-10,
                        const std::type_identity_t<MakeStepSolver<Sys>>& make = newton_solver<Sys>) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  const Submanifold submanifold(system);
  const auto step = [&] { return step_from(system, draw()); };
  LawReport report{"dynamics", {}};
  const auto law = [&](const char* name, double bound, const auto& defect) {
    report.laws.push_back(check_law(name, bound, defect));
  };
  law("Sigma_L is Lagrangian", tolerance, [&] { return lagrangian_defect(submanifold.tangent(step()).canonical); });
  law("Legendre transforms are source and target", tolerance, [&] {
    const Step<Sys> s = step();
    const CotangentGroupoid<G> cotangent(groupoid);
    const auto mu = submanifold.template covector<double>(s.arrow, Submanifold::multipliers(s));
    return worst(
        {detail::momentum_defect(system, s, cotangent.source(mu).momentum, legendre_minus(system, s).momentum),
         detail::momentum_defect(system, s, cotangent.target(mu).momentum, legendre_plus(system, s).momentum)});
  });
  law("Legendre transforms have equal rank", 0, [&] {
    const LegendreRanks ranks = legendre_ranks(submanifold.tangent(step()));
    return double(ranks.minus != ranks.plus);
  });
  law("the step is Poisson", tolerance, [&] { return poisson_defect(submanifold.tangent(step())); });
  law("the computed step is Poisson", 1e-7, [&] { return poisson_defect(detail::solved_graph(system, draw(), make)); });
  if constexpr (Sys::object_constraints == 0)
    law("products of steps compose", tolerance, [&] {
      // mu1 mu2 in T*G, for two steps in a row: from the first state to the last, and the products of all composable
      // pairs nearby form a Lagrangian submanifold again ([G] end of section 2).
      const State<G> start = draw();
      const Step<Sys> first = step_from(system, start);
      const Step<Sys> second = step_from(system, legendre_plus(system, first));
      const auto& cotangent = submanifold.cotangent();
      const Eigen::MatrixXd matched = solve_regular(submanifold.tangent(second).minus, submanifold.tangent(first).plus);
      const Eigen::MatrixXd columns1 = submanifold.directions(first);
      const Eigen::MatrixXd columns2 = submanifold.directions(second) * matched;
      const CotangentChart<G> chart(cotangent, groupoid.multiply(first.arrow, second.arrow));
      Eigen::MatrixXd tangent(2 * Submanifold::size, Submanifold::size);
      for (int i = 0; i < Submanifold::size; ++i)
        tangent.col(i) = derivative_of(chart.canonical(
            cotangent.multiply(submanifold.along(first, columns1.col(i)), submanifold.along(second, columns2.col(i)))));
      const auto covector = [&](const Step<Sys>& s) {
        return submanifold.template covector<double>(s.arrow, Submanifold::multipliers(s));
      };
      const auto product = cotangent.multiply(covector(first), covector(second));
      return worst({lagrangian_defect(tangent),
                    detail::momentum_defect(system, first, cotangent.source(product).momentum,
                                            legendre_minus(system, first).momentum),
                    detail::momentum_defect(system, second, cotangent.target(product).momentum,
                                            legendre_plus(system, second).momentum)});
    });
  law("the step reverses", tolerance, [&] {
    // Back from a guess off by a thousandth. Object constraints leave momenta free along their normals: compared are
    // the arrows, and momenta where they are determined.
    const Step<Sys> s = step();
    const Reversed<Sys> reversed(system);
    const auto end = legendre_plus(system, s);
    const AlgebroidVector<G> off = 1e-3 * groupoid.tau_inverse(s.arrow);
    StepSolution<Reversed<Sys>> back;
    const auto inverse = groupoid.inverse(s.arrow);
    back.step.arrow = groupoid.compose(inverse, groupoid.tau(groupoid.target(inverse), off));
    back.step.multipliers = s.multipliers;
    const auto found =
        NewtonStep<Reversed<Sys>>().solve(reversed, {end.object, AlgebroidVector<G>(-end.momentum)}, back);
    if (!found.converged()) return std::numeric_limits<double>::infinity();
    double momentum = 0;
    if constexpr (Sys::object_constraints == 0)
      momentum = detail::relative_defect(AlgebroidVector<G>(-legendre_plus(reversed, back.step).momentum),
                                         legendre_minus(system, s).momentum);
    return worst({detail::relative_defect(groupoid.coordinates_of_arrow(groupoid.inverse(back.step.arrow)),
                                          groupoid.coordinates_of_arrow(s.arrow)),
                  momentum});
  });
  return report;
}

}  // namespace lagroid::laws
