#pragma once
/// Quantities I(z_k) of a trajectory, each with what the method promises of it: conserved up to round-off, or bounded
/// in a band that shrinks with the step.
///
/// A ledger compares the promise with the run: drift where it promised none is a fault of the method, the system or the
/// code.
///
///     const bool needs_step = false;
///     const Quantity<Sys> energy{"energy", {"H"}, Promise::bounded, needs_step,
///                                [](const auto& p, double* out) { *out = p.state.momentum.squaredNorm() / 2; }};
///
/// Requires that `evaluate` writes as many numbers as there are components and, unless `serialize` is set, depends on
/// the point alone. A quantity that needs the step is evaluated from k = 1 on. Nothing here throws.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/system.hpp>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// What the method promises of a quantity along the discrete flow.
enum class Promise {
  conserved,  ///< constant up to round-off (Noether momenta, Casimirs)
  bounded     ///< oscillates, without drift, within a band that shrinks with the step (energy of a symplectic step)
};

/// The k-th point of a trajectory.
///
/// `configuration` is the arrow g_0 g_1 ... g_k whose target is the current object, g_0 being the initial
/// configuration (for SO(3) the attitude A_k = A_0 g_1 ... g_k, for a pair groupoid (q_0, q_k)).
/// `step` is the arrow that led here, over `step_size`; both are meaningless at k = 0. Where a step is composed of
/// several, it is the last of them.
template <class Sys> struct TrajectoryPoint {
  long index = 0;
  double time = 0;
  double step_size = 0;
  State<typename Sys::GroupoidType> state;
  ArrowOf<typename Sys::GroupoidType> configuration;
  Step<Sys> step;

  /// Visits its numbers.
  void serialize(const typename Sys::GroupoidType& groupoid, NumberArchive& archive) {
    archive(index, time, step_size, state.momentum, step.multipliers);
    archive.object(groupoid, state.object);
    archive.arrow(groupoid, configuration);
    archive.arrow(groupoid, step.arrow);
  }
};

/// A (vector-valued) function of trajectory points with a promise attached.
template <class Sys> struct Quantity {
  using Evaluate = std::function<void(const TrajectoryPoint<Sys>&, double*)>;
  using Size = std::function<double(const TrajectoryPoint<Sys>&)>;

  Quantity(std::string name_, std::vector<std::string> components_, Promise promise_, bool needs_step_,
           Evaluate evaluate_, Size size_ = nullptr)
      : name(std::move(name_)),
        components(std::move(components_)),
        promise(promise_),
        needs_step(needs_step_),
        evaluate(std::move(evaluate_)),
        size(std::move(size_)) {}

  std::string name;
  std::vector<std::string> components;  ///< one label per component
  Promise promise;
  bool needs_step;  ///< evaluated on the arrow that led to the point, hence from k = 1 on
  Evaluate evaluate;
  Size size;  ///< size of the terms it is made of, to which its round-off is relative; its own size where null
  std::function<void(NumberArchive&)>
      serialize;  ///< visits what `evaluate` keeps from point to point; null where it keeps nothing
};

}  // namespace lagroid
