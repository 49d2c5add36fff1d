#pragma once
/// Text in gnuplot's scripts. Text of a scene enters a script by this function, and else by the files of data that it
/// draws.
///
///     script += "set title " + gnuplot_string(name);  // whatever the name contains, it is shown and not run

#include <string>
#include <string_view>

namespace lagroid {

/// The text as a string of gnuplot's, its quotes included. In single quotes gnuplot expands no macros, runs nothing in
/// backquotes and knows no escapes; a quote is doubled. There is no end of line in it: control characters are visible
/// (text.hpp).
std::string gnuplot_string(std::string_view text);

}  // namespace lagroid
