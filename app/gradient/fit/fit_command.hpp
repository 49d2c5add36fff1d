#pragma once
/// The command line of `lagroid fit`, as words and as what they ask for.
///
///     FitCommandOptions options;
///     add_fit_options(app, options);  // then parse
///     const Fit fit = fit_scene(subject, options.data, fit_options(options));
///
/// Errors: GradientRefused, one line, for words of another form, what is given twice, and a file of residuals that is
/// one of those read or cannot be written.

#include "../../command/command.hpp"
#include "fit.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

struct FitCommandOptions : SceneOptions {
  std::vector<std::string> data;
  FitOptions fit;
  std::vector<std::string> columns, combinations, sigma, bounds;
  std::string residuals;
  std::optional<std::string> out;
};

/// Of a word that names something: without blanks at its ends, and not empty.
CLI::Validator named();

/// Those of its own, but for --column.
void add_fit_options(CLI::App& app, FitCommandOptions& options);

FitOptions fit_options(const FitCommandOptions& options);

/// Before anything is computed.
void require_place_of_residuals(const FitCommandOptions& options);

}  // namespace lagroid::app
