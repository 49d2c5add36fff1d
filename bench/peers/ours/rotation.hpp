#pragma once
/// Attitude and momentum as `attitude_and_momentum` has them.

#include <lagroid/core/types.hpp>

#include <array>

namespace peers {

inline std::array<double, 12> rotation_coordinates(const lagroid::Matrix<double, 3, 3>& attitude,
                                                   const lagroid::Vector<double, 3>& momentum) {
  return {attitude(0, 0), attitude(0, 1), attitude(0, 2), attitude(1, 0), attitude(1, 1), attitude(1, 2),
          attitude(2, 0), attitude(2, 1), attitude(2, 2), momentum(0),    momentum(1),    momentum(2)};
}

}  // namespace peers
