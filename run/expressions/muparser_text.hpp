#pragma once
/// A text of named numbers as muparser reads it, whose own names are words.
///
///     parser.DefineVar(detail::word_of(0), &value);
///     parser.SetExpr(detail::in_words("velocity.x - 1", {"velocity.x"}));
///
/// Requires nothing. Returns texts. Nothing throws.

#include <cstddef>
#include <string>
#include <vector>

namespace lagroid::detail {

/// The word under which muparser knows the i-th name.
std::string word_of(std::size_t i);

/// The text with words in place of the names, of which the longest that fits is meant.
std::string in_words(const std::string& text, const std::vector<std::string>& names);

/// Reads the number that the text begins with, whatever the locale. Returns its length; 0 where there is none.
int read_number(const char* text, double& value);

}  // namespace lagroid::detail
