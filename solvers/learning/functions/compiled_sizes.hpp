#pragma once
/// The numbers of bodies or coordinates that models are compiled for: one, two, and any.
///
///     inline std::unique_ptr<learning::Model> made_for(int coordinates, learning::Polynomial h) {
///       return learning::of_compiled_size(coordinates, [&]<int N>() -> std::unique_ptr<learning::Model> {
///         return std::make_unique<learning::HamiltonianModel<learning::Polynomial, N>>("h", h, coordinates);
///       });
///     }
///
/// Nothing throws but what is called.

#include <Eigen/Core>

namespace lagroid::learning {

/// made.operator()<N>(), N the number itself where models are compiled for it, else Eigen::Dynamic.
template <class Made> auto of_compiled_size(int number, const Made& made) {
  if (number == 1) return made.template operator()<1>();
  if (number == 2) return made.template operator()<2>();
  return made.template operator()<Eigen::Dynamic>();
}

}  // namespace lagroid::learning
