#pragma once
/// Solutions to compare with, in long double.

#include "problem.hpp"

#include "../../../core/scalars/compensation.hpp"

namespace peers {

/// y(end) by extrapolation of the midpoint rule (Gragg, Bulirsch and Stoer) in twelve columns, order 24, with equal
/// steps of about `step`, summed with compensation.
template <class S, class P>
std::array<S, P::unknowns> extrapolated(const P& problem, std::array<S, P::unknowns> y, double end, double step) {
  using State = std::array<S, P::unknowns>;
  constexpr int columns = 12;
  const long steps = std::lround(std::ceil(end / step));
  const S whole = S(end) / S(steps);
  std::array<lagroid::Compensation<S>, P::unknowns> compensation{};
  State slope{};
  for (long n = 0; n < steps; ++n) {
    std::array<State, columns> table;
    problem(y, slope);
    const State first = slope;
    for (int j = 0; j < columns; ++j) {
      const int substeps = 2 * (j + 1);
      const S h = whole / S(substeps);
      // z_{k+1} = z_{k-1} + 2 h f(z_k), of the displacements from y.
      State before{};
      State now;
      State at;
      for (std::size_t i = 0; i < y.size(); ++i) now[i] = h * first[i];
      for (int k = 1; k < substeps; ++k) {
        for (std::size_t i = 0; i < y.size(); ++i) at[i] = y[i] + now[i];
        problem(at, slope);
        for (std::size_t i = 0; i < y.size(); ++i) {
          const S next = before[i] + 2 * h * slope[i];
          before[i] = now[i];
          now[i] = next;
        }
      }
      table[std::size_t(j)] = now;
      for (int k = j; k-- > 0;) {
        const S ratio = S(j + 1) / S(k + 1);
        const S factor = 1 / (ratio * ratio - 1);
        State& coarse = table[std::size_t(k)];
        const State& fine = table[std::size_t(k + 1)];
        for (std::size_t i = 0; i < y.size(); ++i) coarse[i] = fine[i] + (fine[i] - coarse[i]) * factor;
      }
    }
    for (std::size_t i = 0; i < y.size(); ++i) compensation[i].add(y[i], table[0][i]);
  }
  return y;
}

/// Exact where the problem has `exact`; otherwise of two integrations in long double, one with half the steps of the
/// other, the finer one, and the distance between them.
template <class P> Reference reference_solution(const P& problem, double end) {
  using Real = long double;
  Reference out;
  std::array<Real, P::compared> state;
  if constexpr (requires { P::template exact<Real>(end); }) {
    state = P::template exact<Real>(end);
    const auto rounded = P::template exact<double>(end);
    std::array<Real, P::compared> coarse;
    for (std::size_t i = 0; i < state.size(); ++i) coarse[i] = Real(rounded[i]);
    // What rounding does to the formula in double, scaled to long double.
    out.uncertainty = double(problem.distance(state, coarse)) / 2048;
  } else {
    std::array<Real, P::unknowns> start;
    const auto rounded = problem.start();
    for (std::size_t i = 0; i < start.size(); ++i) start[i] = Real(rounded[i]);
    const double step = 0.25 * problem.unit();
    const auto coarse = problem.coordinates(extrapolated(problem, start, end, step));
    state = problem.coordinates(extrapolated(problem, start, end, 0.5 * step));
    out.uncertainty = double(problem.distance(state, coarse));
  }
  for (const Real x : state) out.state.push_back(double(x));
  return out;
}

/// What is the same for all problems; `methods` are added by the caller.
template <class P> Problem posed(const P& problem, std::string name, std::string title, std::vector<double> ends) {
  const auto distance = [problem](const std::vector<double>& a, const std::vector<double>& b) {
    std::array<double, P::compared> left;
    std::array<double, P::compared> right;
    std::copy(a.begin(), a.end(), left.begin());
    std::copy(b.begin(), b.end(), right.begin());
    return problem.distance(left, right);
  };
  return {std::move(name),
          std::move(title),
          std::move(ends),
          {},
          [problem](double end) { return reference_solution(problem, end); },
          distance};
}

}  // namespace peers
