#include "listing.hpp"

#include "families/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace lagroid::app {

namespace {

struct Listed {
  std::string name;
  std::string summary;
  std::string groupoid;
  std::vector<Parameter> parameters;
  std::vector<std::string> symmetries;  ///< declared by the system with its default parameters
  std::vector<std::string> conserved;   ///< quantities promised as conserved
};

std::vector<Listed> listed() {
  std::vector<Listed> out;
  for_each_system([&]<class Sys>(const Entry<Sys>& entry) {
    Listed one{
        std::string(entry.name), std::string(entry.summary), Sys::GroupoidType::name(), entry.parameters, {}, {}};
    const Sys system;
    if constexpr (requires { system.symmetries(); })
      for (const auto& symmetry : system.symmetries()) one.symmetries.push_back(symmetry.name);
    for (const auto& quantity : system.quantities())
      if (quantity.promise == Promise::conserved) one.conserved.push_back(quantity.name);
    out.push_back(std::move(one));
  });
  for (const SphereEntry& entry : sphere_systems())
    out.push_back({std::string(entry.name), std::string(entry.summary), std::string(entry.groupoid), entry.parameters,
                   entry.symmetries, entry.conserved});
  return out;
}

}  // namespace

std::string text_listing() {
  std::string out;
  for (const auto& s : listed()) {
    out += fmt::format("{:<20} {}\n", s.name, s.summary);
    out += fmt::format("  groupoid           {}\n", s.groupoid);
    for (const auto& p : s.parameters)
      out += fmt::format("  {:<18} {}{}{}\n", p.name, p.meaning, p.unit.empty() ? "" : fmt::format(" [{}]", p.unit),
                         p.fallback.empty() ? "" : fmt::format(", default {}", p.fallback));
    if (!s.symmetries.empty()) out += fmt::format("  symmetries         {}\n", fmt::join(s.symmetries, "; "));
    if (!s.conserved.empty()) out += fmt::format("  conserved          {}\n", fmt::join(s.conserved, "; "));
  }
  return out;
}

std::string json_listing() {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& s : listed()) {
    auto parameters = nlohmann::ordered_json::array();
    for (const auto& p : s.parameters) {
      parameters.push_back({{"name", p.name}, {"unit", p.unit}, {"meaning", p.meaning}});
      if (!p.fallback.empty()) parameters.back()["default"] = p.fallback;
    }
    out.push_back({{"name", s.name},
                   {"summary", s.summary},
                   {"groupoid", s.groupoid},
                   {"parameters", parameters},
                   {"symmetries", s.symmetries},
                   {"conserved", s.conserved}});
  }
  return out.dump(2) + "\n";
}

}  // namespace lagroid::app
