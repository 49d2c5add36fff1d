#pragma once
/// A node, or a point within a step, whose time has derivatives: as those of events and of steps that vary.
///
///     const ObserveTimedNode<Kepler> end_time = [](const auto& node) { return VariedVector::Constant(1, node.time); };
///
/// Requires nothing. Nothing throws.

#include <lagroid/core/system.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>

#include <functional>

namespace lagroid {

template <class Sys> struct ObservedTimedNode {
  using G = typename Sys::GroupoidType;
  const Sys& system;
  VariedNumber time;
  ObjectOf<G, VariedNumber> object;
  AlgebroidVector<G, VariedNumber> momentum;  ///< the one that is reported
  ArrowOf<G, VariedNumber> configuration;
};
/// What is observed there.
template <class Sys> using ObserveTimedNode = std::function<VariedVector(const ObservedTimedNode<Sys>&)>;

}  // namespace lagroid
