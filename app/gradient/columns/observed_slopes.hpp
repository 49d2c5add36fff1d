#pragma once
/// Which numbers that a system observes of its nodes read a parameter as a plain number, so that their derivatives
/// would be wrong.
///
///     const std::map<std::size_t, std::string> plain = numbers_without_slopes(system, start, configuration);
///
/// Compares derivatives of `observed` by each parameter with differences of it at that node. Returns the reason for
/// each of these numbers, by its place. Errors: std::invalid_argument where there are not as many numbers as names.

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>

namespace lagroid::app::differentiating {

template <ObservesNumbers Sys>
std::map<std::size_t, std::string> numbers_without_slopes(Sys system, const State<typename Sys::GroupoidType>& state,
                                                          const ArrowOf<typename Sys::GroupoidType>& configuration) {
  using G = typename Sys::GroupoidType;
  const ParameterPlaces places = all_parameters(system);  // of `system`, which is no constant
  const G& groupoid = system.groupoid;
  const Vector<double, G::arrow_coordinate_count()> arrow = groupoid.coordinates_of_arrow(configuration);
  const auto numbers = [&]<class S>(const S& /*scalar*/) {
    const State<G, S> at{groupoid.template cast_object<S>(state.object),
                         with_entries_of<AlgebroidVector<G, S>>(state.momentum)};
    return Vector<S, Eigen::Dynamic>(system.observed(
        at, groupoid.template arrow_at<S>(with_entries_of<Vector<S, G::arrow_coordinate_count()>>(arrow))));
  };
  const Eigen::VectorXd here = numbers(0.0);
  if (here.size() != Eigen::Index(Sys::observed_names().size()))
    throw std::invalid_argument(
        fmt::format("the system observes {} numbers under {} names: observed() and "
                    "observed_names() are to have as many",
                    here.size(), Sys::observed_names().size()));
  Eigen::MatrixXd slopes(here.size(), Eigen::Index(places.members.size()));
  lagroid::detail::for_directions(int(slopes.cols()), [&](int first) {
    const VariedMembers varying(places.members, -first);
    lagroid::detail::put_tangents(numbers(VariedNumber(0.0)), first, slopes);
  });
  std::map<std::size_t, std::string> out;
  for (Eigen::Index i = 0; i < here.size(); ++i) try {
      lagroid::detail::compare_with_differences(places, slopes.row(i), std::abs(here(i)),
                                                [&] { return Eigen::VectorXd(numbers(0.0).segment(i, 1)); });
    } catch (const WithoutDerivative& plain) {
      out.emplace(std::size_t(i), plain.what());
    }
  return out;
}

}  // namespace lagroid::app::differentiating
