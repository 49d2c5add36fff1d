#pragma once
/// Numbers that a system knows of its nodes beside the state: its energy, its momenta in space, its velocities.
///
/// A ledger watches them as plain numbers; written over any scalar they have derivatives by starts and parameters too.
///
///     static std::vector<ObservedName> observed_names() { return {{"H", "energy"}, {"angular_velocity", "w"}}; }
///     template <class S> Vector<S, 2> observed(const State<SO2, S>& z, const Matrix<S, 2, 2>& configuration) const {
///       const S w = z.momentum(0) / varied<S>(inertia);
///       return {z.momentum(0) * w * 0.5, w};
///     }
///
/// Requires as many numbers as there are names, in their order, that depend on the state and the configuration alone,
/// and parameters read by `varied` (core/scalars/varied.hpp). `observed_numbers_fit` is false for names without
/// numbers. Nothing throws.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/core/system.hpp>

#include <string>
#include <vector>

namespace lagroid {

/// A number that can be asked for by its own name, or with all of its group.
struct ObservedName {
  std::string group;
  std::string name;
};

template <class Sys>
concept ObservesNumbers = DiscreteSystem<Sys> &&
    requires(const Sys& system, const State<typename Sys::GroupoidType, VariedNumber>& z,
             const ArrowOf<typename Sys::GroupoidType, VariedNumber>& configuration) {
  { Sys::observed_names() } -> std::convertible_to<std::vector<ObservedName>>;
  { system.observed(z, configuration) } -> std::convertible_to<Vector<VariedNumber, Eigen::Dynamic>>;
};

namespace detail {
LAGROID_MEMBER_NAME(NamesObservedNumbers, observed_names);
}  // namespace detail

/// Whether `observed_names`, where there are any, are those of such a system.
template <class Sys>
inline constexpr bool observed_numbers_fit = ObservesNumbers<Sys> || !detail::NamesObservedNumbers<Sys>;

}  // namespace lagroid
