#include "cite.hpp"

#include "../command/command.hpp"
#include "../families/family.hpp"

#include <lagroid/core/version.hpp>
#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <system_error>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr std::string_view authors = "The Lagroid authors";
constexpr std::string_view what_it_is = "Discrete mechanics on Lie groupoids";
constexpr int year = 2026;

std::vector<Use> uses_in(const CiteOptions& options) {
  std::vector<Use> all;
  if (options.subject.empty() || options.cff) {
    for (const Article& reference : references()) all.push_back({&reference, ""});
    return all;
  }
  std::error_code ignored;
  if (!fs::is_directory(options.subject, ignored)) {
    const Section scene = read_scene(options.subject, options.overrides);
    return family_of(scene).uses(scene);
  }
  for (const SceneFamily* family : families())
    if (std::vector<Use> uses = family->uses_of_folder(options.subject); !uses.empty()) return uses;
  if (!fs::exists(fs::path(options.subject) / "checkpoint" / "scene.toml"))
    throw RunError(fmt::format("\"{}\" holds neither the scene of a run nor a learned model; name the scene's file",
                               options.subject));
  const Section scene =
      parse_scene(Checkpoint::scene_of(options.subject), options.subject + "/checkpoint/scene.toml", options.overrides);
  return family_of(scene).uses(scene);
}

std::string pages(const Article& r, std::string_view dash) {
  return r.last_page.empty() ? std::string(r.first_page) : fmt::format("{}{}{}", r.first_page, dash, r.last_page);
}

std::string as_text(const std::vector<Use>& uses) {
  std::string out = fmt::format("{}: Lagroid {}. {}, {}.\n", authors, LAGROID_VERSION, what_it_is, year);
  for (const auto& [reference, what] : uses) {
    const Article& r = *reference;
    std::string names;
    for (const Author& author : r.authors)
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", author.given, author.family);
    const std::string letter = r.letter.empty() ? "" : fmt::format("[{}] ", r.letter);
    out += fmt::format("\n{}{}: {}. {} {}{}, {}, {}. doi:{}{}\n", letter, names, r.title, r.journal, r.volume,
                       r.number > 0 ? fmt::format(" ({})", r.number) : "", pages(r, "-"), r.year, r.doi,
                       r.arxiv.empty() ? "" : fmt::format(", arXiv:{}", r.arxiv));
    if (!what.empty()) out += fmt::format("    for {}\n", what);
  }
  return out;
}

std::string as_bibtex(const std::vector<Use>& uses) {
  std::string out = fmt::format(
      "@software{{lagroid,\n  author = {{{{{}}}}},\n  title = {{Lagroid: {}}},\n  version = {{{}}},\n  year = "
      "{{{}}}\n}}\n",
      authors, what_it_is, LAGROID_VERSION, year);
  for (const Use& use : uses) {
    const Article& r = *use.reference;
    std::string names;
    for (const Author& author : r.authors)
      names += fmt::format("{}{}, {}", names.empty() ? "" : " and ", author.family, author.given);
    out += fmt::format("\n@article{{{},\n", r.key);
    const auto field = [&](std::string_view name, const std::string& value) {
      if (!value.empty()) out += fmt::format("  {} = {{{}}},\n", name, value);
    };
    field("author", names);
    field("title", fmt::format("{{{}}}", r.title));
    field("journal", std::string(r.journal));
    field("volume", fmt::format("{}", r.volume));
    field("number", r.number > 0 ? fmt::format("{}", r.number) : "");
    field("pages", pages(r, "--"));
    field("year", fmt::format("{}", r.year));
    field("doi", std::string(r.doi));
    field("eprint", std::string(r.arxiv));
    field("archiveprefix", r.arxiv.empty() ? "" : "arXiv");
    out += "}\n";
  }
  return out;
}

std::string as_json(const std::vector<Use>& uses) {
  OrderedJson out;
  out["software"] = {{"author", authors},
                     {"title", "Lagroid"},
                     {"version", LAGROID_VERSION},
                     {"year", year},
                     {"license", "BSD-3-Clause"}};
  out["references"] = OrderedJson::array();
  for (const auto& [reference, what] : uses) {
    const Article& r = *reference;
    OrderedJson names = OrderedJson::array();
    for (const Author& author : r.authors) names.push_back({{"given", author.given}, {"family", author.family}});
    OrderedJson one{{"key", r.key},       {"authors", names},       {"title", r.title}, {"journal", r.journal},
                    {"volume", r.volume}, {"pages", pages(r, "-")}, {"year", r.year},   {"doi", r.doi}};
    if (r.number > 0) one["number"] = r.number;
    if (!r.arxiv.empty()) one["arxiv"] = r.arxiv;
    if (!what.empty()) one["for"] = what;
    out["references"].push_back(std::move(one));
  }
  return out.dump(2) + "\n";
}

/// CITATION.cff, version 1.2.0 of the Citation File Format. Quoted strings of JSON are strings of YAML.
std::string as_cff(const std::vector<Use>& uses) {
  const auto quoted = [](std::string_view text) { return OrderedJson(text).dump(); };
  std::string out = fmt::format(
      "# Written by: lagroid cite --cff\n"
      "cff-version: 1.2.0\n"
      "message: \"If you use Lagroid, please cite it, and the papers that your runs rest on: lagroid cite SCENE.\"\n"
      "type: software\n"
      "title: Lagroid\n"
      "abstract: {}\n"
      "authors:\n"
      "  - name: {}\n"
      "version: {}\n"
      "license: BSD-3-Clause\n"
      "references:\n",
      quoted(what_it_is), quoted(authors), quoted(LAGROID_VERSION));
  for (const Use& use : uses) {
    const Article& r = *use.reference;
    out += "  - type: article\n    authors:\n";
    for (const Author& author : r.authors)
      out += fmt::format("      - family-names: {}\n        given-names: {}\n", quoted(author.family),
                         quoted(author.given));
    out +=
        fmt::format("    title: {}\n    journal: {}\n    volume: {}\n", quoted(r.title), quoted(r.journal), r.volume);
    if (r.number > 0) out += fmt::format("    issue: {}\n", r.number);
    out += fmt::format("    start: {}\n", quoted(r.first_page));
    if (!r.last_page.empty()) out += fmt::format("    end: {}\n", quoted(r.last_page));
    out += fmt::format("    year: {}\n    doi: {}\n", r.year, quoted(r.doi));
  }
  return out;
}

}  // namespace

void add_cite_options(CLI::App& command, CiteOptions& options) {
  command.add_option(
      "subject", options.subject,
      "a scene or sweep, the folder of a run from initial values or that of lagroid learn: cite what it rests on "
      "(default: all)");
  command.add_option("--set", options.overrides, "override a key of the scene (repeatable)")->allow_extra_args(false);
  auto* bibtex = command.add_flag("--bibtex", options.bibtex, "print entries for BibTeX (UTF-8)");
  auto* json = command.add_flag("--json", options.json, "print one JSON object");
  auto* cff = command.add_flag("--cff", options.cff, "print CITATION.cff");
  bibtex->excludes(json)->excludes(cff);
  json->excludes(cff);
}

int cite(const CiteOptions& options) {
  try {
    const auto uses = uses_in(options);
    print(options.bibtex ? as_bibtex(uses) : options.json ? as_json(uses) : options.cff ? as_cff(uses) : as_text(uses));
    return 0;
  } catch (const RunError& error) {
    return refuse(options.json, exit_bad_input, "invalid_run", error.what());
  }
}

}  // namespace lagroid::app
