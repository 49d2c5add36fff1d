#pragma once
/// The parts of the page that shows a run, built into the program.

#include <string_view>

namespace lagroid::app::viewer {

/// The page, with @STYLE@, @RUN@ and @PROGRAM@ where the parts go.
std::string_view page();
std::string_view style();
/// viewer.js with the libraries it uses, as one script.
std::string_view program();

}  // namespace lagroid::app::viewer
