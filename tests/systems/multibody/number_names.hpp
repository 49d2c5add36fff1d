#pragma once
/// Names for the numbers of a scene by which derivatives are taken.

#include <cstddef>
#include <string>
#include <vector>

inline std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back("number " + std::to_string(i));
  return out;
}
