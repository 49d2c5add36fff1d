#pragma once
/// Quantities a system promises to keep, and the trajectory points they are evaluated on.

#include <lagroid/core/system.hpp>

#include <functional>
#include <string>
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
/// `step` is the arrow that led here, meaningless at k = 0.
template <class Sys>
struct TrajectoryPoint {
  long index = 0;
  double time = 0;
  State<typename Sys::GroupoidType> state;
  ArrowOf<typename Sys::GroupoidType> configuration;
  Step<Sys> step;
};

/// A (vector-valued) function of trajectory points with a promise attached.
template <class Sys>
struct Quantity {
  std::string name;
  std::vector<std::string> components;  ///< one label per component
  Promise promise = Promise::conserved;
  bool needs_step = false;  ///< evaluated on the arrow that led to the point, hence from k = 1 on
  std::function<void(const TrajectoryPoint<Sys>&, double*)> evaluate;
};

}  // namespace lagroid
