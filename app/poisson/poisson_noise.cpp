#include "poisson_noise.hpp"

#include <lagroid/solvers/poisson/poisson_methods.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <cstdint>

namespace lagroid::app {

namespace {

constexpr const char* strength_word = "strength";

constexpr long largest = 2147483647;
const KeyOf<Whole> seed_key{"seed", {0, largest}, "", "of the Wiener processes", 1L};
const KeyOf<Whole> path_key{"path", {0, largest}, "", "which of the seed's paths they take", 0L};
const KeyOf<Number> temperature_key{"temperature",
                                    {positive},
                                    "",
                                    "of a thermostat, in the energy's unit, by the friction that goes with the noise",
                                    {},
                                    "none, and no friction"};

const KeyOf<Flag> project_key{
    "project",
    {},
    "",
    "whether each step ends on the Casimirs of the start, from which rounding walks away otherwise",
    false};

KeyOf<Number> strength_key(const std::string& name) {
  return {name,
          {nonnegative},
          "",
          fmt::format("of the noise along the field of {0}; with {0} and sqrt(s) an action", name),
          0.0};
}

}  // namespace

std::vector<Key> noise_keys(const PoissonEntry& entry) {
  if (entry.noises.empty()) return {};
  Table strength;
  for (const std::string& name : entry.noises) strength.keys.push_back(strength_key(name));
  return {optional_table(noise_word,
                         {{KeyOf<Table>{strength_word, strength, "", "by the names of the noise Hamiltonians"},
                           seed_key, path_key, temperature_key, project_key}},
                         "what drives the system")};
}

NoiseOptions read_noise(const Section& scene, const PoissonEntry& entry) {
  NoiseOptions out;
  if (!scene.has(noise_word)) return out;
  if (entry.noises.empty())
    scene.fail(noise_word, fmt::format("{} has no noise Hamiltonians, along whose fields it could be driven; leave "
                                       "[noise] out",
                                       entry.name));
  const std::string names = fmt::format("one or more of {}", fmt::join(entry.noises, ", "));
  const Section noise = scene.section(noise_word, "strength");
  const Section strength = noise.section(strength_word, names);
  for (const std::string& name : entry.noises) out.strength.push_back(read_key(strength, strength_key(name)));
  out.seed = std::uint64_t(read_key(noise, seed_key));
  out.path = std::uint32_t(read_key(noise, path_key));
  out.temperature = read_key_or(noise, temperature_key, 0);
  out.project = read_key(noise, project_key);
  return out;
}

void refuse_for_noise(const Section& time, const DeclaredMethod& method, const Composition& composition) {
  if (!poisson_methods::takes_noise(method))
    time.fail("method", fmt::format("{} does not go with [noise]; symplectic-groupoid does", method.name));
  if (composition.stages() > 1)
    time.fail(time.has("order") ? "order" : "composition",
              "steps with noise are not composed, since their order is 1 at most; leave it out");
}

std::string noise_note(const NoiseOptions& noise, const PoissonEntry& entry) {
  std::string along;
  for (std::size_t k = 0; k < noise.strength.size(); ++k)
    if (noise.strength[k] > 0)
      along += fmt::format("{}{} ({:g})", along.empty() ? "" : ", ", entry.noises[k], noise.strength[k]);
  return fmt::format("noise along {}, path {} of seed {}{}{}", along.empty() ? "nothing" : along, noise.path,
                     noise.seed,
                     noise.temperature > 0 ? fmt::format("; friction for the temperature {:g}", noise.temperature) : "",
                     noise.project ? "; each step ends on the Casimirs of the start" : "");
}

}  // namespace lagroid::app
