#pragma once
/// Newton's iteration on the source fibres of several members at once, one in each lane: the chord iteration of
/// newton_step.hpp with masks in place of branches. Returns the mask of lanes that converged.

#include <lagroid/core/scalars/batch.hpp>
#include <lagroid/solvers/linear_algebra/small_inverse.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <array>
#include <limits>

namespace lagroid {

/// Whether a system's own branch is evaluated in all lanes at once: `admissible` is a template on the scalar.
template <class Sys, class B>
concept HasBranchByLane = requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType, B>& g) {
  { system.admissible(g) } -> std::same_as<MaskOf<B>>;
};

namespace detail {

/// The coordinates of one lane.
template <int W, int Size> Vector<double, Size> lane_of(const Vector<Batch<W>, Size>& x, int lane) {
  Vector<double, Size> out;
  for (int i = 0; i < Size; ++i) out(i) = x(i)[lane];
  return out;
}
template <int W, int Size> void set_lane(Vector<Batch<W>, Size>& x, int lane, const Vector<double, Size>& y) {
  for (int i = 0; i < Size; ++i) x(i).set(lane, y(i));
}
/// y becomes x in the lanes of the mask.
template <class Mask, class V> LAGROID_INLINE inline void blend(const Mask& where, const V& x, V& y) {
  for (Eigen::Index i = 0; i < V::SizeAtCompileTime; ++i) y(i) = select(where, x(i), y(i));
}
/// The same of arrows.
template <class G, class Mask, class A>
LAGROID_INLINE inline void blend_arrow(const G& groupoid, const Mask& where, const A& x, A& y) {
  if (xsimd::all(where)) {
    y = x;
    return;
  }
  auto c = groupoid.coordinates_of_arrow(y);
  blend(where, groupoid.coordinates_of_arrow(x), c);
  const A out = groupoid.template arrow_at<typename decltype(c)::Scalar>(c);
  y = out;
}
template <int W, class G> ArrowOf<G> arrow_of_lane(const G& groupoid, const ArrowOf<G, Batch<W>>& g, int lane) {
  return groupoid.template arrow_at<double>(lane_of(groupoid.coordinates_of_arrow(g), lane));
}
template <int W, class G> State<G> state_of_lane(const G& groupoid, const State<G, Batch<W>>& state, int lane) {
  return {groupoid.template object_at<double>(lane_of(groupoid.coordinates_of_object(state.object), lane)),
          lane_of(state.momentum, lane)};
}
template <int W, class G>
void set_arrow_of_lane(const G& groupoid, ArrowOf<G, Batch<W>>& g, int lane, const ArrowOf<G>& x) {
  auto c = groupoid.coordinates_of_arrow(g);
  set_lane(c, lane, groupoid.coordinates_of_arrow(x));
  const ArrowOf<G, Batch<W>> out = groupoid.template arrow_at<Batch<W>>(c);
  g = out;
}

}  // namespace detail

/// The chord Newton of `NewtonStep` (iterations with a kept inverse, to the same round-off levels), in every lane at
/// once. Matrices are evaluated lane by lane, when a lane needs a new one: what a scalar with second derivatives keeps
/// in registers, a batch of them does not. A lane that has converged rests while others go on; one that does not
/// contract, or whose matrix is not to be trusted, is given up, for the caller to solve otherwise. Each lane's outcome
/// is its own. No allocation.
template <DiscreteSystem Sys, int W> class BatchNewton {
 public:
  using B = Batch<W>;
  using Mask = typename B::Mask;
  using G = typename Sys::GroupoidType;

  /// From the guess in `solution.step` to the solution, in the lanes `wanted`; returns those that reached it.
  Mask solve(const Sys& system, const State<G, B>& state, StepSolution<Sys, B>& solution, const Mask& wanted) {
    // If iterations grow in proportion to the age of a matrix, it is best renewed when they have cost as much as it.
    const Mask renewed = wanted && (!trusted_ || more_ > price);
    const Mask done = iterate</*full=*/false>(system, state, solution, wanted, renewed);
    best_ = select(renewed, iterations_, best_);
    more_ = select(renewed, B(0.0), more_ + (iterations_ - best_));
    return done;
  }
  /// The same with the matrix of every iterate, where the guess may be far, and an order of elimination chosen anew.
  Mask solve_fully(const Sys& system, const State<G, B>& state, StepSolution<Sys, B>& solution, const Mask& wanted) {
    renew(wanted);
    return iterate</*full=*/true>(system, state, solution, wanted, wanted);
  }
  /// The matrices of these lanes are evaluated anew at their next step.
  void renew(const Mask& lanes) {
    trusted_ = trusted_ && !lanes;
    reordered_ = reordered_ || lanes;
  }

 private:
  using E = StepEquations<Sys, B>;
  using Residual = typename E::Residual;
  using Jacobian = typename E::Jacobian;
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  static constexpr double iteration_error = 0.1;  ///< of a round-off level: what the iteration may leave
  static constexpr int longest_chord = 12;
  static constexpr double price = E::size > 4 ? 16 : 8;  ///< of a matrix, in iterations

  template <bool Full>
  Mask iterate(const Sys& system, const State<G, B>& state, StepSolution<Sys, B>& solution, const Mask& wanted,
               const Mask& renewed);
  void evaluate(const Sys& system, const Step<Sys, B>& step, const Mask& lanes);
  Mask admissible(const Sys& system, const Step<Sys, B>& step, const Mask& lanes) const;

  LAGROID_INLINE Residual correction(const Residual& r) const {
    Residual out;
    for (int i = 0; i < E::size; ++i) {
      out(i) = inverse_(i, 0) * r(0);
      for (int j = 1; j < E::size; ++j) out(i) += inverse_(i, j) * r(j);
    }
    return out;
  }
  /// The largest residual over its level; NaN where one of them is not finite.
  LAGROID_INLINE B roundoff_ratio_of(const Residual& r, const Residual& floor) const {
    B largest = 0.0;
    B sum = 0.0;
    for (int i = 0; i < E::size; ++i) {
      const B size = abs(r(i) * floor(i));
      largest = max(largest, size);
      sum += size;
    }
    return largest + 0.0 * sum;
  }

  Jacobian jacobian_;
  Jacobian inverse_;  ///< the negative of its inverse
  Mask trusted_{false};
  Mask reordered_{true};
  B rate_ = 0.1;        ///< contraction of an iteration, as last seen
  B best_ = 0.0;        ///< iterations with a new matrix
  B more_ = 0.0;        ///< iterations beyond these since
  B iterations_ = 0.0;  ///< of the last solve
  std::array<SmallInverse<E::size>, std::size_t(W)> elimination_;
};

template <DiscreteSystem Sys, int W>
template <bool Full>
LAGROID_FLATTEN auto BatchNewton<Sys, W>::iterate(const Sys& system, const State<G, B>& state,
                                                  StepSolution<Sys, B>& solution, const Mask& wanted,
                                                  const Mask& renewed) -> Mask {
  Step<Sys, B>& step = solution.step;
  if (xsimd::any(renewed)) evaluate(system, step, renewed);
  GradientsOf<Sys, B> d = automatic_gradients<Sys, B>(system, step.arrow, step.multipliers);
  Residual residual = E::residual(d, state.momentum);
  Residual floor = round_off_level<Sys, B>(system, state, step, jacobian_);
  for (int i = 0; i < E::size; ++i) floor(i) = 1.0 / floor(i);
  B roundoff_ratio = roundoff_ratio_of(residual, floor);
  B rate = select(renewed, min(B(0.1), 10 * epsilon * roundoff_ratio), rate_);
  B remains = roundoff_ratio;
  Mask open = wanted && trusted_;
  Mask done(false);
  iterations_ = B(longest_chord);
  for (int iteration = 1; iteration <= longest_chord && xsimd::any(open); ++iteration) {
    if (Full && iteration > 1) evaluate(system, step, open);
    const Residual by = correction(residual);
    const ArrowOf<G, B> there =
        system.groupoid.extend(step.arrow, AlgebroidVector<G, B>(by.template head<Sys::dimension>()));
    detail::blend_arrow(system.groupoid, open, there, step.arrow);
    for (int a = 0; a < Sys::constraints; ++a)
      step.multipliers(a) = select(open, step.multipliers(a) + by(Sys::dimension + a), step.multipliers(a));
    d = automatic_gradients<Sys, B>(system, step.arrow, step.multipliers);
    residual = E::residual(d, state.momentum);
    const B next = roundoff_ratio_of(residual, floor);
    const Mask contracting = next <= max(B(1.0), 0.3 * roundoff_ratio);
    const B seen = iteration == 1 ? next / roundoff_ratio : max(next / roundoff_ratio, rate);
    rate = select(open && next > 10.0, seen, rate);
    remains *= rate;
    roundoff_ratio = next;
    const Mask finished = open && contracting && roundoff_ratio <= 1.0 && remains <= iteration_error;
    done = done || finished;
    iterations_ = select(finished, B(iteration), iterations_);
    open = open && contracting && !finished;
  }
  rate_ = select(done, rate, rate_);
  solution.momentum_change = momentum_change(system, step, d);
  solution.remainder = correction(residual).template head<Sys::dimension>();
  return done && admissible(system, step, done);
}

/// The matrix at a step and its inverse, in the lanes given.
template <DiscreteSystem Sys, int W>
[[gnu::noinline]] void BatchNewton<Sys, W>::evaluate(const Sys& system, const Step<Sys, B>& step, const Mask& lanes) {
  using One = StepEquations<Sys>;
  std::array<double, std::size_t(W)> good = select(trusted_, B(1.0), B(0.0)).to_array();
  for (int lane = 0; lane < W; ++lane) {
    if (!lanes.get(std::size_t(lane))) continue;
    const typename One::Jacobian a =
        One::jacobian(two_sided(system, detail::arrow_of_lane<W>(system.groupoid, step.arrow, lane),
                                typename Sys::Multipliers(detail::lane_of(step.multipliers, lane))));
    auto& elimination = elimination_[std::size_t(lane)];
    if (reordered_.get(std::size_t(lane))) elimination.choose_pivots(a, Scaling<E::size>::equilibrate(a));
    good[std::size_t(lane)] = elimination.invert(a) ? 1 : 0;
    for (int j = 0; j < E::size; ++j) {
      const auto column = elimination.column(j);
      for (int i = 0; i < E::size; ++i) {
        jacobian_(i, j).set(lane, a(i, j));
        inverse_(i, j).set(lane, column[i]);
      }
    }
  }
  trusted_ = B::load(good.data()) > 0.0;
  reordered_ = reordered_ && !lanes;
}

template <DiscreteSystem Sys, int W>
auto BatchNewton<Sys, W>::admissible([[maybe_unused]] const Sys& system, [[maybe_unused]] const Step<Sys, B>& step,
                                     const Mask& lanes) const -> Mask {
  if constexpr (HasBranchByLane<Sys, B>) {
    return lanes && system.admissible(step.arrow);
  } else if constexpr (HasBranch<Sys>) {
    B inside = 0.0;
    for (int lane = 0; lane < W; ++lane)
      if (lanes.get(std::size_t(lane)))
        inside.set(lane, system.admissible(detail::arrow_of_lane<W>(system.groupoid, step.arrow, lane)) ? 1.0 : 0.0);
    return inside > 0.0;
  } else {
    return lanes;
  }
}

}  // namespace lagroid
