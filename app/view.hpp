#pragma once
/// The page and the plots of a run, from its folder.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::app {

/// A folder that holds no run, or one that cannot be shown. The message is one line with the remedy.
class RunError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ViewOptions {
  std::string run;        ///< the folder
  long most_rows = 4000;  ///< of the trajectory on the page
};

/// Writes view.html into the run's folder: one page that needs nothing else, with the bodies of the run in motion, its
/// curves and its ledger. Of a longer trajectory, evenly chosen rows and the last. Throws RunError; OutputError where
/// the page cannot be written.
std::filesystem::path write_view(const ViewOptions& options);

/// Draws plot.svg and plot.png of a run anew, by its plot.gp, which may have been edited. Throws as `write_view`.
std::vector<std::filesystem::path> draw_plots(const std::string& run);

}  // namespace lagroid::app
