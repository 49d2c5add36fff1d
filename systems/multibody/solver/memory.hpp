#pragma once
/// The bytes that lists hold, for the measurement of memory.

#include <cstddef>

namespace lagroid::multibody {

/// Of all these lists, B.
template <class... Lists> std::size_t bytes_of(const Lists&... lists) {
  return (std::size_t(0) + ... + (lists.capacity() * sizeof(typename Lists::value_type)));
}

}  // namespace lagroid::multibody
