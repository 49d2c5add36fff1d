#include "fit_command.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace lagroid::app {

namespace {

/// NAME=NUMBER, or NAME=LOW:HIGH.
double number_in(const std::string& word, std::size_t from, std::size_t to, const char* form) {
  double x = 0;
  const char* const end = word.data() + to;
  const auto read = std::from_chars(word.data() + from, end, x);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(x))
    throw GradientRefused(fmt::format("{}: give {}", word, form));
  return x;
}

CLI::Validator positive_number() {
  return {[](std::string& given) {
            double x = 0;
            const bool number = CLI::detail::lexical_cast(given, x);
            return number && x > 0 && std::isfinite(x) ? std::string()
                                                       : fmt::format("give a positive number, not {}", given);
          },
          "positive"};
}

/// An option that is a list of words, separated by commas.
void add_list(CLI::App& app, const char* name, std::vector<std::string>& words, const char* meaning) {
  app.add_option(name, words, meaning)->delimiter(',')->allow_extra_args(false)->transform(named());
}

/// Keeps what a word gives a name; refuses another for it.
template <class Given, class Value>
void give_once(Given& given, const char* option, const std::string& name, const Value& value) {
  if (!given.emplace(name, value).second) throw GradientRefused(fmt::format("{} {}: it is given twice", option, name));
}

}  // namespace

CLI::Validator named() {
  return {[](std::string& word) {
            CLI::detail::trim(word);
            return std::string(word.empty() ? "an empty name; give one, or leave the option out" : "");
          },
          ""};
}

void add_fit_options(CLI::App& app, FitCommandOptions& options) {
  app.add_option("data", options.data, "CSV or HDF5 files with t and columns of the run; one for each run")->required();
  add_list(app, "--wrt", options.fit.unknowns,
           "what is fitted: initial.NAME or parameters.NAME, separated by commas (default: all)");
  add_list(app, "--of", options.fit.columns, "columns of the data to use, separated by commas (default: all)");
  app.add_option("--combination", options.combinations,
                 "NAME=EXPRESSION of initial.NAME and parameters.NAME: how well it is known; may be repeated")
      ->allow_extra_args(false);
  add_list(app, "--sigma", options.sigma,
           "COLUMN=SIGMA, separated by commas: the standard deviations of its errors (default: 1)");
  add_list(app, "--bounds", options.bounds, "NAME=LOW:HIGH, separated by commas: what is fitted stays between");
  app.add_option("--huber", options.fit.huber, "residuals beyond so many sigma weigh by their size, not its square")
      ->check(positive_number());
  auto* starts = app.add_option("--starts", options.fit.starts, "guesses: the scene, and others drawn around it")
                     ->check(CLI::Range(1, 10'000));
  app.add_option("--spread", options.fit.spread, "of these, relative to each unknown (default 0.3)")
      ->check(positive_number())
      ->needs(starts);
  app.add_option("--seed", options.fit.seed, "of these")->needs(starts);
  app.add_option("--out", options.out,
                 "a folder for residuals, summary and a plot of what was measured beside what the fitted run has")
      ->transform(named());
  app.add_option("--residuals", options.residuals, "a CSV file to write: what was measured and what the fitted run has")
      ->transform(named());
}

FitOptions fit_options(const FitCommandOptions& options) {
  FitOptions out = options.fit;
  for (const std::string& word : options.combinations) {
    out.combinations.push_back(named_text(word));
    const std::string& name = out.combinations.back().first;
    if (std::count_if(out.combinations.begin(), out.combinations.end(),
                      [&](const NamedText& each) { return each.first == name; }) > 1)
      throw GradientRefused(fmt::format("--combination {}: it is given twice", name));
  }
  for (const std::string& word : options.sigma) {
    const std::size_t at = std::min(word.find('='), word.size());
    const double sigma = number_in(word, std::min(at + 1, word.size()), word.size(), "COLUMN=SIGMA");
    if (!(sigma > 0)) throw GradientRefused(fmt::format("{}: a sigma is positive", word));
    give_once(out.sigma, "--sigma", word.substr(0, at), sigma);
  }
  for (const std::string& word : options.bounds) {
    const std::size_t at = std::min(word.find('='), word.size()), colon = std::min(word.find(':', at), word.size());
    const char* const form = "NAME=LOW:HIGH";
    const double low = number_in(word, std::min(at + 1, word.size()), colon, form);
    const double high = number_in(word, std::min(colon + 1, word.size()), word.size(), form);
    if (!(low < high)) throw GradientRefused(fmt::format("{}: the first bound is the lower one", word));
    give_once(out.bounds, "--bounds", word.substr(0, at), std::array<double, 2>{low, high});
  }
  return out;
}

void require_place_of_residuals(const FitCommandOptions& options) {
  namespace fs = std::filesystem;
  const std::string& file = options.residuals;
  if (file.empty()) return;
  std::error_code none;
  const auto is_same = [&](const std::string& other) { return fs::equivalent(file, other, none); };
  if (is_same(options.scene) || std::any_of(options.data.begin(), options.data.end(), is_same))
    throw GradientRefused(fmt::format("--residuals {}: it is read by this very fit; name another file", file));
  const bool is_new = !fs::exists(file, none);
  if (!std::ofstream(file, std::ios::app))
    throw GradientRefused(
        fmt::format("--residuals {}: it cannot be written; name a file in a folder that is there", file));
  if (is_new) fs::remove(file, none);
}

}  // namespace lagroid::app
