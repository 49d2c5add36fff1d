#pragma once
/// The laws of momentum levels by their names, and which of a report are broken.

#include <lagroid/solvers/testing/level_laws.hpp>

#include "../../support/broken.hpp"

#include <string>
#include <vector>

namespace lagroid {

using Names = std::vector<std::string>;
namespace level_law {
inline const std::string momenta = "the Routhian and its magnetic term give the momenta";
inline const std::string second = "second derivatives are those of the gradients";
inline const std::string steps = "steps are those of the full system";
inline const std::string both_ends = "full arrows have the momentum of the level at both ends";
inline const std::string poisson = "the computed step is Poisson, with the magnetic term";
}  // namespace level_law

inline Names broken_laws(const laws::LawReport& report) {
  Names out;
  for (const auto& law : report.laws)
    if (laws::seen_broken(law)) out.push_back(law.name);
  return out;
}

}  // namespace lagroid
