#pragma once
/// The methods that a scene can ask to minimise by.

#include "../keys/key.hpp"

#include <lagroid/solvers/optimisation/minimise.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace lagroid::app {

struct OptimiserEntry {
  std::string_view name;
  std::string_view summary;
  std::vector<Key> keys;  ///< besides `name`
  std::unique_ptr<optimisation::DescentMethod> (*read)(const Section& section);
};

std::span<const OptimiserEntry> optimisers();

/// `name` of [method]; the first is what there is without it.
KeyOf<OneOf> optimiser_key();
/// The keys of [method].
Table optimisers_table();

/// The one that method.name names, with its keys.
std::unique_ptr<optimisation::DescentMethod> read_optimiser(const Section& method);

/// The weight of the penalty that takes the constraint's place, where method.constraint says so.
std::optional<double> read_penalty(const Section& method);

}  // namespace lagroid::app
