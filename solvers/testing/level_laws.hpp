#pragma once
/// What a momentum level is, as laws: the base of a full system at a fixed momentum of its symmetry.
///
///     mu = -dR/dv - f-,  mu' = dR/dw + f+                   of the Routhian R and the magnetic term f-, f+
///     R and -dR/dlevel in closed form, where there is one, those that Newton's method finds
///     b = connection(g),  J(F-(g)) = J(F+(g)) = level       of the full step g over the step b
///     DF Pi DF^T = Pi o F,  Pi = D pi Pi_G D pi^T           of the step F, with pi the full states' way down
///
/// The magnetic term makes the step Poisson for another tensor than that of the base alone: Pi is what the tensor of
/// A*G becomes, in which the momentum of the symmetry is a Casimir. A level takes its derivatives from the full system
/// (docs/decisions/70_momentum_levels.md), so that these laws ask first derivatives of R over dual numbers and all
/// others by differences: nested dual numbers through the implicit angle would take minutes to compile.
///
///     const MomentumLevel level(ShortestRotation{}, HeavyTop{}, Vector<double, 1>(0));
///     const auto draw = [] { return State<HeavyTop::GroupoidType>{{0.6, 0, 0.8}, {0.4, 0.3, 2 +
///     laws::draw_uniform()}}; }; std::cout << laws::level_laws(level, draw);
///
/// Requires states of the full system from which a step can be taken and where the symmetry acts freely; each law is
/// asked at the level of the state drawn, whatever `level` was given. Returns a LawReport; a law that does not hold is
/// no exception. Source: that of MomentumLevel (core/reduction/momentum_level.hpp); Pi is Poisson reduction.

#include <lagroid/core/reduction/momentum_level.hpp>
#include <lagroid/solvers/testing/dynamics_laws.hpp>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace lagroid::laws {

namespace detail {

/// The derivative of f at zero, a map of R^N to vectors, by differences of order four.
template <int N, class F> Eigen::MatrixXd derivative_by_differences(const F& f, double distance) {
  Eigen::MatrixXd out;
  for (int i = 0; i < N; ++i) {
    const auto pair = [&](double by) {
      const Vector<double, N> moved = by * Vector<double, N>::Unit(i);
      return Eigen::VectorXd((f(moved) - f(Vector<double, N>(-moved))) / (2 * by));
    };
    const Eigen::VectorXd column = (4 * pair(distance) - pair(2 * distance)) / 3;
    if (i == 0) out.resize(column.size(), N);
    out.col(i) = column;
  }
  return out;
}

/// A thousandth of what the coordinates of an object are large.
template <Groupoid G> double small_distance(const G& groupoid, const ObjectOf<G>& q) {
  const Eigen::VectorXd x = groupoid.coordinates_of_object(q);
  return 1e-3 * (x.size() > 0 ? std::max(1.0, x.cwiseAbs().maxCoeff()) : 1.0);
}

template <class Level> Level level_of(Level level, const State<typename Level::G>& z) {
  level.level = level.momentum_of(z);
  return level;
}

/// D pi Pi_G D pi^T at the state over s. (How states of other levels go down does not matter: J is a Casimir.)
template <class Level> Eigen::MatrixXd poisson_of_level(const Level& level, const State<typename Level::B>& s) {
  using G = typename Level::G;
  using B = typename Level::B;
  using Above = typename CotangentGroupoid<G>::template Object<double>;
  using Below = typename CotangentGroupoid<B>::template Object<double>;
  const CotangentGroupoid<G> above(level.full.groupoid);
  const CotangentGroupoid<B> below(level.groupoid);
  const State<G> over = level.state_over(s);
  const Above z{over.object, over.momentum};
  constexpr int size = object_dimension_of<G>() + G::dimension;
  const Eigen::MatrixXd down = derivative_by_differences<size>(
      [&](const Vector<double, size>& by) {
        const Above moved = above.displace_object(z, by);
        const State<B> there = level.state_below({moved.object, moved.momentum});
        return below.object_displacement(Below{s.object, s.momentum}, Below{there.object, there.momentum});
      },
      small_distance(level.full.groupoid, over.object));
  return down * lagroid::detail::poisson_in_chart(level.full.groupoid, z) * down.transpose();
}

/// The momenta -dR/dv - f- and dR/dw + f+ of a step, with what its multipliers add, over dual numbers that its angle
/// has as well.
template <class Level>
std::pair<AlgebroidVector<typename Level::B>, AlgebroidVector<typename Level::B>> routhian_momenta(
    const Level& level, const Step<Level>& step) {
  using D = Dual<double>;
  using V = AlgebroidVector<typename Level::B>;
  const auto b = level.groupoid.template cast<D>(step.arrow);
  const Vector<D, Level::n> still = Vector<D, Level::n>::Constant(D(0.0));
  std::pair<V, V> out;
  for (int i = 0; i < Level::n; ++i) {
    const Vector<D, Level::n> moved = infinitesimal(V(V::Unit(i)));
    const auto along = [&](const Vector<D, Level::n>& v, const Vector<D, Level::n>& w) {
      const ArrowOf<typename Level::B, D> there = level.groupoid.translate(v, b, w);
      const Vector<D, Level::angles> theta = level.angle_of(there, level.level);
      D f = level.full.lagrangian(level.connection.attach(there, theta));
      for (int a = 0; a < Level::angles; ++a) f -= theta(a) * level.level(a);
      if constexpr (Level::object_constraints > 0) {
        const auto at_source = level.object_constraint(level.groupoid.source(there));
        for (int a = 0; a < Level::object_constraints; ++a) f += at_source(a) * step.multipliers(a);
      }
      return f.derivative;
    };
    out.first(i) = -along(moved, still);
    out.second(i) = along(still, moved);
  }
  if constexpr (Forced<Level>) {
    const auto f = level.forces(step.arrow);
    out.first -= f.source;
    out.second += f.target;
  }
  return out;
}

}  // namespace detail

template <class Level, class Draw>
LawReport level_laws(const Level& level, const Draw& draw, double tolerance = 1e-10,
                     const std::type_identity_t<MakeStepSolver<Level>>& make = newton_solver<Level>) {
  using Full = typename Level::Full;
  using B = typename Level::B;
  using detail::momentum_defect;
  using detail::relative_defect;
  constexpr double by_differences = 1e-7;
  LawReport report{"momentum level", {}};
  /// At the level of a state, and what is below that.
  const auto law = [&](const char* name, double bound, const auto& defect) {
    report.laws.push_back(check_law(name, bound, [&] {
      const auto z = draw();
      const Level at = detail::level_of(level, z);
      return defect(at, z, at.state_below(z));
    }));
  };
  law("the Routhian and its magnetic term give the momenta", tolerance,
      [](const Level& at, const auto&, const State<B>& s) {
        const Step<Level> step = step_from(at, s);
        const auto [minus, plus] = detail::routhian_momenta(at, step);
        return worst({momentum_defect(at, step, legendre_minus(at, step).momentum, minus),
                      momentum_defect(at, step, legendre_plus(at, step).momentum, plus)});
      });
  if constexpr (Level::closed) {
    law("the Routhian in closed form, and the angle by it, are those of Newton's method", tolerance,
        [](const Level& at, const auto&, const State<B>& s) {
          const ArrowOf<B> b = step_from(at, s).arrow;
          return worst(
              {relative_defect(Vector<double, 1>(at.lagrangian(b)), Vector<double, 1>(at.routhian_by_solving(b))),
               relative_defect(at.angle_of(b, at.level), at.template angle_by_solving<0>(b, at.level))});
        });
  }
  law("second derivatives are those of the gradients", by_differences,
      [](const Level& at, const auto&, const State<B>& s) {
        const Step<Level> step = step_from(at, s);
        const auto d = two_sided(at, step.arrow, step.multipliers);
        const Eigen::MatrixXd slope = detail::derivative_by_differences<Level::n>(
            [&](const AlgebroidVector<B>& w) {
              const auto there = gradients(at, ArrowOf<B>(at.groupoid.extend(step.arrow, w)), step.multipliers);
              Vector<double, Level::n + Level::constraints> both;
              both << there.source_gradient, there.constraint;
              return both;
            },
            detail::small_distance(at.groupoid, s.object));
        double most = (slope.topRows(Level::n) - d.mixed).norm() / d.mixed.norm();
        if constexpr (Level::constraints > 0) {
          most = worst({most, relative_defect(d.constraint_target, slope.bottomRows(Level::constraints))});
          for (int a = 0; a < Level::constraints; ++a) {
            auto more = step.multipliers;
            more(a) += 1;
            most = worst({most, relative_defect(d.constraint_source.col(a),
                                                gradients(at, step.arrow, more).source_gradient -
                                                    gradients(at, step.arrow, step.multipliers).source_gradient)});
          }
        }
        return most;
      });
  law("steps are those of the full system", tolerance, [](const Level& at, const auto& z, const State<B>& s) {
    const Step<Full> above = step_from(at.full, z);
    const Step<Level> below = step_from(at, s);
    const auto arrows = [](const auto& groupoid, const auto& g, const auto& h) {
      return relative_defect(groupoid.coordinates_of_arrow(g), groupoid.coordinates_of_arrow(h));
    };
    return worst({arrows(at.groupoid, below.arrow, ArrowOf<B>(at.connection(above.arrow))),
                  arrows(at.full.groupoid, at.full_arrow(below.arrow), above.arrow),
                  relative_defect(below.multipliers, above.multipliers),
                  momentum_defect(at, below, legendre_plus(at, below).momentum,
                                  at.state_below(legendre_plus(at.full, above)).momentum)});
  });
  law("full arrows have the momentum of the level at both ends", tolerance,
      [](const Level& at, const auto&, const State<B>& s) {
        const Step<Level> step = step_from(at, s);
        const Step<Full> above{at.full_arrow(step.arrow), step.multipliers};
        return worst({momentum_defect(at.full, above, at.momentum_of(legendre_minus(at.full, above)), at.level),
                      momentum_defect(at.full, above, at.momentum_of(legendre_plus(at.full, above)), at.level)});
      });
  law("the computed step is Poisson, with the magnetic term", by_differences,
      [&](const Level& at, const auto&, const State<B>& s) {
        FixedStepIntegrator<Level> run(at, s, at.groupoid.unit(s.object), make());
        if (const auto taken = run.advance(); !taken.converged()) throw detail::no_step(taken);
        SubmanifoldTangent graph = detail::solved_graph(at, s, make);
        graph.poisson_minus = detail::poisson_of_level(at, s);
        graph.poisson_plus = detail::poisson_of_level(at, run.point().state);
        return poisson_defect(graph);
      });
  return report;
}

}  // namespace lagroid::laws
