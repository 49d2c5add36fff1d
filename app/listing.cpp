#include "listing.hpp"

#include "families/family.hpp"
#include "reading/messages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

std::vector<ListedSystem> listed_systems(const std::string& name) {
  std::vector<ListedSystem> out;
  std::vector<std::string> names;
  for (const SceneFamily* family : families())
    for (ListedSystem& system : family->systems()) {
      names.emplace_back(system.name);
      if (name.empty() || name == system.name) out.push_back(std::move(system));
    }
  if (out.empty() && !name.empty()) {
    const std::string guess = nearest(name, names);
    throw CLI::ValidationError("list", fmt::format("no system \"{}\"{}", name,
                                                   guess.empty() ? "" : fmt::format("; did you mean \"{}\"?", guess)));
  }
  return out;
}

}  // namespace

std::string text_listing(const std::string& name) {
  std::string out;
  for (const auto& s : listed_systems(name)) {
    out += fmt::format("{:<20} {}\n", s.name, s.summary);
    out += fmt::format("  groupoid           {}\n", s.groupoid);
    for (const Key& p : s.parameters) out += fmt::format("  {:<18} {}\n", p.name, listed(p));
    if (!s.symmetries.empty()) out += fmt::format("  symmetries         {}\n", fmt::join(s.symmetries, "; "));
    if (!s.conserved.empty()) out += fmt::format("  conserved          {}\n", fmt::join(s.conserved, "; "));
    for (const ListedReduction& r : s.reductions)
      out += fmt::format("  reduced by         {}: {}; to {}\n", r.name, r.meaning, r.groupoid);
  }
  return out;
}

std::string json_listing(const std::string& name) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& s : listed_systems(name)) {
    auto parameters = nlohmann::ordered_json::array();
    for (const Key& p : s.parameters) {
      parameters.push_back({{"name", p.name}, {"unit", p.unit}, {"meaning", meaning_of(p)}});
      if (const std::string fallback = fallback_of(p); !fallback.empty()) parameters.back()["default"] = fallback;
    }
    auto reductions = nlohmann::ordered_json::array();
    for (const ListedReduction& r : s.reductions)
      reductions.push_back({{"name", r.name}, {"meaning", r.meaning}, {"groupoid", r.groupoid}});
    out.push_back({{"name", s.name},
                   {"summary", s.summary},
                   {"groupoid", s.groupoid},
                   {"parameters", parameters},
                   {"symmetries", s.symmetries},
                   {"conserved", s.conserved},
                   {"reductions", reductions}});
  }
  return out.dump(2) + "\n";
}

}  // namespace lagroid::app
