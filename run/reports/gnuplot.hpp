#pragma once
/// Text in gnuplot's scripts. What a scene says comes into them by this, and else by the files of data that they draw.

#include <string>
#include <string_view>

namespace lagroid {

/// The text as a string of gnuplot's, its quotes included. In single quotes gnuplot expands no macros, runs nothing in
/// backquotes and knows no escapes; a quote is doubled. There is no end of line in it: control characters are visible
/// (text.hpp).
std::string gnuplot_string(std::string_view text);

}  // namespace lagroid
