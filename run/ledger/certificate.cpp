#include <lagroid/run/ledger/certificate.hpp>

#include <lagroid/run/reports/markup.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace lagroid {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson json(const laws::LawReport& suite) {
  OrderedJson laws = OrderedJson::array();
  for (const auto& law : suite.laws) {
    laws.push_back({{"law", law.name},
                    {"samples", law.samples},
                    {"worst_defect", law.worst},
                    {"tolerance", law.tolerance},
                    {"skipped", law.skipped},
                    {"verdict", law.verdict()}});
    if (law.skipped > 0) laws.back()["skipped_because"] = law.skipped_because;
    if (!law.first_failure.empty()) laws.back()["message"] = law.first_failure;
  }
  return {{"suite", suite.subject}, {"holds", suite.holds()}, {"laws", laws}};
}

}  // namespace

bool Certificate::holds() const {
  return failure.empty() && !suites.empty() &&
         std::all_of(suites.begin(), suites.end(), [](const auto& s) { return s.holds(); }) &&
         std::all_of(symmetries.begin(), symmetries.end(), [](const auto& s) { return s.holds; }) &&
         std::all_of(reductions.begin(), reductions.end(), [](const auto& r) { return r.holds(); });
}

std::string text_certificate(const Certificate& c) {
  const std::string from = c.states > 0 ? fmt::format(" from {} states of the scene", c.states) : "";
  std::string out = fmt::format("{} on {}: up to {} samples a law{}, seed {}, {:.3g} s\n", c.system, c.groupoid,
                                c.samples, from, c.seed, c.seconds);
  std::size_t laws = 0;
  std::size_t broken = 0;
  std::size_t unjudged = 0;
  for (const auto& suite : c.suites) {
    out += fmt::format("  {}\n", suite.subject);
    for (const auto& law : suite.laws) {
      out += fmt::format("    {:<8}  {:<48} worst defect {:.1e}, tolerance {:.0e}, {} samples{}{}\n", law.verdict(),
                         law.name, law.worst, law.tolerance, law.samples,
                         law.skipped > 0 ? fmt::format("; {} skipped: {}", law.skipped, law.skipped_because) : "",
                         law.first_failure.empty() ? "" : "; " + law.first_failure);
      ++laws;
      broken += law.holds() || law.unjudged ? 0 : 1;
      unjudged += law.unjudged ? 1 : 0;
    }
  }
  if (!c.symmetries.empty()) out += "  symmetries along the run\n";
  for (const auto& s : c.symmetries) {
    out += fmt::format("    {:<8}  {:<48} {}, defect {:.1e}\n", s.holds ? "holds" : "BROKEN", s.name, s.kind, s.defect);
    ++laws;
    broken += s.holds ? 0 : 1;
  }
  if (!c.reductions.empty()) out += "  reductions, where the scene starts\n";
  for (const auto& r : c.reductions) {
    out += fmt::format("    {:<8}  {:<48} to {}, defect {:.1e}{}\n",
                       !r.holds()          ? "BROKEN"
                       : r.why_not.empty() ? "holds"
                                           : "none",
                       r.name, r.groupoid, r.defect, r.why_not.empty() ? "" : "; " + r.why_not);
    ++laws;
    broken += r.holds() ? 0 : 1;
  }
  if (!c.failure.empty())
    return out + fmt::format("  NOT certified: the run itself failed: {}{}\n", c.failure,
                             broken > 0 ? fmt::format("; {} laws of its groupoid are broken", broken) : "");
  out += c.holds() ? fmt::format("  certified: all {} laws hold\n", laws)
                   : fmt::format("  NOT certified: of {} laws {} broken, {} unjudged\n", laws, broken, unjudged);
  return out;
}

std::string json_certificate(const Certificate& c) {
  OrderedJson suites = OrderedJson::array();
  for (const auto& suite : c.suites) suites.push_back(json(suite));
  OrderedJson symmetries = OrderedJson::array();
  for (const auto& s : c.symmetries) symmetries.push_back({{"name", s.name}, {"kind", s.kind}, {"defect", s.defect}});
  OrderedJson reductions = OrderedJson::array();
  for (const auto& r : c.reductions) {
    reductions.push_back(
        {{"name", r.name}, {"groupoid", r.groupoid}, {"defect", r.defect}, {"descends", r.why_not.empty()}});
    if (!r.why_not.empty()) reductions.back()["message"] = r.why_not;
  }
  OrderedJson out{{"system", c.system},   {"groupoid", c.groupoid},   {"status", c.status()},
                  {"states", c.states},   {"samples", c.samples},     {"seed", c.seed},
                  {"seconds", c.seconds}, {"symmetries", symmetries}, {"reductions", reductions},
                  {"suites", suites}};
  if (!c.failure.empty()) out["message"] = c.failure;
  return json_text(out);
}

}  // namespace lagroid
