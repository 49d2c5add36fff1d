#pragma once
/// Which laws of a momentum level are broken.

#include <lagroid/solvers/testing/level_laws.hpp>

#include "../../support/broken.hpp"

#include <string>
#include <vector>

namespace lagroid {

using Names = std::vector<std::string>;

inline Names broken_laws(const laws::LawReport& report) {
  Names out;
  for (const auto& law : report.laws)
    if (laws::seen_broken(law)) out.push_back(law.name);
  return out;
}

}  // namespace lagroid
