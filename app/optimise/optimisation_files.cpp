#include "optimisation_files.hpp"

#include <lagroid/run/files/hdf5_file.hpp>
#include <lagroid/run/reports/clock.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using optimisation::Result;

constexpr std::array<const char*, 7> files{"history.csv", "result.h5", "summary.json", "summary.txt",
                                           "plot.gp",     "plot.svg",  "plot.png"};

/// The reference, or where there is none the least value met.
double least(const OptimisationScene& scene, const Result& result) {
  if (scene.least) return *scene.least;
  double out = result.value;
  for (const auto& now : result.history) out = std::min(out, now.value);
  return out;
}

std::string history_csv(const OptimisationScene& scene, const Result& result) {
  std::string out = "iteration,value,gap,gradient,seconds,values,gradients,hessians\n";
  const double lowest = least(scene, result);
  for (const auto& now : result.history)
    fmt::format_to(std::back_inserter(out), "{},{:.17g},{:.6g},{:.6g},{:.6g},{},{},{}\n", now.iteration, now.value,
                   now.value - lowest, now.gradient, now.seconds, now.evaluations.values, now.evaluations.gradients,
                   now.evaluations.hessians);
  return out;
}

std::string gnuplot_script(const OptimisationScene& scene) {
  std::string out =
      "# Draws history.csv; run by lagroid, or by hand: gnuplot plot.gp\n"
      "set datafile separator ','\nset grid\nunset key\nset logscale y\nset format y '%.0e'\nset xlabel 'iteration'\n";
  for (const auto& [file, terminal] : {std::pair("plot.svg", "svg size 1040,400 background 'white' noenhanced"),
                                       std::pair("plot.png", "pngcairo size 1040,400 noenhanced")}) {
    out += fmt::format("\nset terminal {}\nset output '{}'\nset multiplot layout 1,2\n", terminal, file);
    out += fmt::format("set title 'f above {}'\n", scene.least ? "its minimum" : "the least value met");
    out += "plot 'history.csv' using 'iteration':(column('gap') > 0 ? column('gap') : NaN) with lines linewidth 1.5\n";
    out +=
        "set title 'Riemannian gradient'\nplot 'history.csv' using 'iteration':'gradient' with lines linewidth 1.5\n";
    out += "unset multiplot\nset output\n";
  }
  return out;
}

void write_point(const OptimisationScene& scene, const Result& result, const fs::path& file) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor x = Eigen::Map<const Eigen::MatrixXd>(result.x.data(), scene.instance.rows, scene.instance.columns);
  write_hdf5(file, [&](const H5::H5File& out) {
    set_attribute(out, "generator", "lagroid");
    set_attribute(out, "problem", scene.problem);
    set_attribute(out, "manifold", scene.instance.manifold->name());
    set_attribute(out, "status", std::string(to_string(result.outcome)));
    const std::vector<double> values(x.data(), x.data() + x.size());
    set_attribute(add_dataset(out, "x", values, std::size_t(x.cols())), "meaning", "the point with the least value");
  });
}

}  // namespace

nlohmann::ordered_json optimisation_json(const OptimisationScene& scene, const Result& result) {
  nlohmann::ordered_json out;
  out["status"] = to_string(result.outcome);
  if (!result.message.empty()) out["message"] = result.message;
  out["problem"] = scene.problem;
  out["manifold"] = scene.instance.manifold->name();
  out["method"] = scene.method->name();
  out["value"] = result.value;
  out["gradient"] = result.gradient;
  out["constraints"] = result.residual;
  if (scene.penalty) out["off_manifold"] = result.off_manifold;
  if (scene.least) {
    out["reference"] = *scene.least;
    out["reference_by"] = scene.instance.least_by;
    out["gap"] = result.value - *scene.least;
  }
  out["iterations"] = result.iterations;
  out["evaluations"] = {{"values", result.evaluations.values},
                        {"gradients", result.evaluations.gradients},
                        {"hessians", result.evaluations.hessians}};
  out["seconds"] = result.seconds;
  return out;
}

std::string optimisation_text(const OptimisationScene& scene, const Result& result) {
  std::string out = fmt::format("{} on the {}, {}: {}\n", scene.problem, scene.instance.manifold->name(),
                                scene.method->name(), to_string(result.outcome));
  out += fmt::format("  value        {:.15g}\n  gradient     {:.2e}\n  constraints  {:.1e}\n", result.value,
                     result.gradient, result.residual);
  if (scene.penalty)
    out += fmt::format("  off it by    {:.1e} where the penalty was least, before the nearest point was taken\n",
                       result.off_manifold);
  if (scene.least)
    out += fmt::format("  reference    {:.15g} by {}; f is above it by {:.1e}\n", *scene.least, scene.instance.least_by,
                       result.value - *scene.least);
  out += fmt::format("  iterations   {}: {} gradients, {} values, {} Hessians times vectors, {}\n", result.iterations,
                     result.evaluations.gradients, result.evaluations.values, result.evaluations.hessians,
                     duration(result.seconds));
  return out;
}

OutputFolder folder_for_optimisation(const fs::path& folder, const Section& scene) {
  return {folder, OutputKind::optimum, OutputSource{{"scene", scene.whole()}}, files};
}

std::vector<fs::path> write_optimisation(const OptimisationScene& scene, const Result& result, const fs::path& folder,
                                         std::string& note) {
  const auto make = [&](const fs::path& staging) {
    write_text(history_csv(scene, result), staging / "history.csv");
    write_point(scene, result, staging / "result.h5");
    write_text(json_text(optimisation_json(scene, result)) + "\n", staging / "summary.json");
    write_text(visible(optimisation_text(scene, result), "\n"), staging / "summary.txt");
    write_text(gnuplot_script(scene), staging / "plot.gp");
    return std::vector<std::string>{"result.h5", "history.csv", "summary.json", "summary.txt", "plot.gp"};
  };
  return write_and_draw(folder, files, make, {"plot.gp", {"plot.svg", "plot.png"}}, note);
}

}  // namespace lagroid::app
