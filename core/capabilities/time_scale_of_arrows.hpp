#pragma once
/// A time in which little changes near an arrow: sigma(g) > 0, to which the steps of a boundary value can be
/// proportional, t1 - t0 = epsilon sigma(g). One wants it where a path is fast in places. [G], after Example 6.2
///
///     template <class S> S time_scale(const Arrow<S>& g) const { return ...; }     a member of the system
///
/// Required: positive, smooth, of any scalar. With sigma(g^{-1}) = sigma(g) the steps are symmetric where the
/// discretisation is.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/member_name.hpp>

#include <concepts>

namespace lagroid {

/// A system that has such a member.
template <class Sys>
concept HasTimeScaleOfArrows = Timed<Sys> && requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  { system.time_scale(g) } -> std::convertible_to<double>;
};

namespace detail {
LAGROID_MEMBER_NAME(NamesTimeScaleOfArrows, time_scale);
}  // namespace detail

/// Whether `time_scale`, where there is one, is that.
template <class Sys>
inline constexpr bool time_scale_of_arrows_fits = HasTimeScaleOfArrows<Sys> || !detail::NamesTimeScaleOfArrows<Sys>;

}  // namespace lagroid
