#pragma once
/// What tables of derivatives have in common, of runs and of minima: their lines, what differences say of them, and the
/// same as JSON.
///
///     std::string text = lines_of(table);
///     if (table.checked) text += words_of_differences(table, "minimisations");
///
/// Requires a table with its rows, columns and derivatives. Nothing throws.

#include "../gradient_table.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace lagroid::app {

/// Values and derivatives; of one row by many columns a line for each of these.
std::string lines_of(const GradientTable& table);
/// To how much extrapolated differences of `what` agree, what they contradict and what they cannot tell.
std::string words_of_differences(const GradientTable& table, const std::string& what);

/// `values` and `derivatives`.
void add_derivatives(const GradientTable& table, nlohmann::ordered_json& out);
/// `notes`, and of a checked table what differences say.
void add_notes_and_check(const GradientTable& table, nlohmann::ordered_json& out);

}  // namespace lagroid::app
