#pragma once
/// The page and the plots of a run, from its folder.

#include <lagroid/run/files/output_folder.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// Throws RunError where the folder holds what `lagroid control` found, which is no run.
void refuse_found_control(const std::filesystem::path& folder);

struct ViewOptions {
  std::string run;        ///< the folder
  long most_rows = 4000;  ///< of the trajectory on the page
};

/// Writes view.html into the run's folder: one page that needs nothing else, with the bodies of the run in motion, its
/// curves and its ledger; of what `lagroid control` found the motion, with bands where inequalities act. Of a longer
/// trajectory, evenly chosen rows and the last. Throws RunError; OutputError where the page cannot be written.
std::filesystem::path write_view(const ViewOptions& options);

struct PlotOptions {
  std::string run;          ///< the folder
  bool own_script = false;  ///< draw by plot.gp although it is not the one that the run wrote
};

/// Draws plot.svg and plot.png of a run anew, by its plot.gp. Scripts of gnuplot can run anything: one that its
/// summary does not give is refused unless `own_script`. Throws as `write_view`.
std::vector<std::filesystem::path> draw_plots(const PlotOptions& options);

}  // namespace lagroid::app
