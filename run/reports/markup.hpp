#pragma once
/// Text that anyone may have written, in HTML, Markdown, CSV and JSON: it is shown as it is, and has no meaning there.
/// Characters that a terminal would obey are visible (text.hpp).
///
///     page += "<h1>" + in_html(name) + "</h1>";

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace lagroid {

/// Between tags, or in an attribute's quotes.
std::string in_html(std::string_view text);

/// In a line, or a table's cell.
std::string in_markdown(std::string_view text);

/// As one field: in quotes where it needs them.
std::string in_csv(std::string_view text);

/// The JSON with two spaces of indent; bytes that are not UTF-8 become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

/// The JSON on one line, as it may stand inside a script element.
std::string in_script(const nlohmann::ordered_json& json);

}  // namespace lagroid
