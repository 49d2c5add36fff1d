#pragma once
/// Pages and sources as text, and what is looked for in them.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::documentation_tests {

inline const std::filesystem::path root = LAGROID_ROOT;

inline std::string read(const std::filesystem::path& path) {
  std::ifstream file(root / path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The page's section of that heading.
inline std::string section(const std::string& page, const std::string& heading) {
  const auto start = page.find("\n" + heading + "\n");
  if (start == std::string::npos) throw std::runtime_error("no section " + heading);
  return page.substr(start, page.find("\n## ", start + 1) - start);
}

/// The text of all files of that ending in those folders.
inline std::string text_of(const std::vector<std::string>& folders, const std::string& ending) {
  std::string out;
  for (const auto& folder : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ending) out += read(entry.path());
  return out;
}

/// What matches the pattern's group, lines joined.
inline std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::string joined = std::regex_replace(text, std::regex("\\s+"), " ");
  const std::regex expression(pattern);
  std::vector<std::string> out;
  for (std::sregex_iterator at(joined.begin(), joined.end(), expression); at != std::sregex_iterator(); ++at)
    out.push_back((*at)[1]);
  return out;
}

/// The page without its fenced blocks.
inline std::string prose_of(std::string page) {
  for (auto at = page.find("```"); at != std::string::npos; at = page.find("```", at))
    page.erase(at, page.find("```", at + 3) + 3 - at);
  return page;
}

/// Whether the text has the word, which is part of no longer one. (A regular expression takes a hundred times as long.)
inline bool has_word(const std::string& text, const std::string& word) {
  const auto goes_on = [&](std::size_t at, char end) {
    const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    return at < text.size() && is_letter(text[at]) && is_letter(end);
  };
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if (!goes_on(at - 1, word.front()) && !goes_on(at + word.size(), word.back())) return true;
  return false;
}

/// The files, tests and identifiers and tables of scenes in `backquotes` and the laws in "quotes" that do not exist.
inline std::vector<std::string> unknown_names(const std::string& page) {
  const std::string headers = text_of({"core", "groupoids", "run", "solvers", "systems"}, ".hpp");
  const std::string tests = text_of({"tests"}, ".cpp");
  const std::string scenes = text_of({"examples"}, ".toml");
  std::vector<std::string> out;
  const auto require = [&](const std::string& name, bool exists) {
    if (!exists) out.push_back(name);
  };
  for (const auto& name : matches(page, "`([^`]+)`")) {
    const auto dot = name.find('.');
    if (name.front() == '[') {  // a table of scenes
      require(name, scenes.find('\n' + name + '\n') != std::string::npos);
    } else if (name.find('/') != std::string::npos) {
      require(name, exists(root / name));
    } else if (dot != std::string::npos) {
      require(name, tests.find("TEST(" + name.substr(0, dot) + ", " + name.substr(dot + 1) + ")") != std::string::npos);
    } else {
      require(name, has_word(headers, name));
    }
  }
  for (const auto& law : matches(page, "\"([^\"]+)\"")) require(law, headers.find(law + "\"") != std::string::npos);
  return out;
}

/// The text of a test, from its name to the next one at most; empty if there is none.
inline std::string body_of(const std::string& test, const std::string& tests) {
  const auto dot = test.find('.');
  const auto start = tests.find("TEST(" + test.substr(0, dot) + ", " + test.substr(dot + 1) + ")");
  if (start == std::string::npos) return {};
  return tests.substr(start, std::min(tests.find("\nTEST", start), tests.find("\n}\n", start)) - start);
}

/// For every statement, the laws that none of the tests said to fail them mentions, and those of these tests that
/// mention none of the laws. What fails is named in the sentence "Fails: ...", or anywhere in a statement without.
inline std::vector<std::string> unfounded_failures(const std::string& page) {
  const std::string tests = text_of({"tests"}, ".cpp");
  std::vector<std::string> out;
  for (std::size_t start = 0; start < page.size();) {
    const auto end = std::min(page.find("\n\n", start), page.size());
    const std::string statement = page.substr(start, end - start);
    start = end + 2;
    const auto laws = matches(statement, "\"([^\"]+)\"");
    if (laws.empty()) continue;
    const auto fails = matches(statement, "Fails:((?:[^.]|\\.\\w)*)");
    const auto failing = matches(fails.empty() ? statement : fails.front(), "`(\\w+\\.\\w+)`");
    const auto mentions = [&](const std::string& test, const std::string& law) {
      return body_of(test, tests).find(law + "\"") != std::string::npos;
    };
    for (const auto& law : laws)
      if (std::none_of(failing.begin(), failing.end(), [&](const auto& test) { return mentions(test, law); }))
        out.push_back(law);
    for (const auto& test : failing)
      if (std::none_of(laws.begin(), laws.end(), [&](const auto& law) { return mentions(test, law); }))
        out.push_back(test);
  }
  return out;
}

inline const std::vector<std::string> none;

}  // namespace lagroid::documentation_tests
