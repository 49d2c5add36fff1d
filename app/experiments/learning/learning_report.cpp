#include "learning_hamiltonians.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/machine.hpp>
#include <lagroid/run/reports/clock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

namespace lagroid::app {

const std::vector<const char*> learning_report_files{"report.md", "fits.csv", "figures.gp", "errors.svg"};

namespace {

constexpr double loss_over = 20;  // of the original's loss

const char* name_of(LearningPart part) {
  switch (part) {
    case LearningPart::study:
      return "study";
    case LearningPart::models:
      return "models";
    case LearningPart::integrators:
      return "integrators";
  }
  return "";
}

/// What the original has of a cell; not a number where it has nothing.
struct Original {
  double test = std::nan("");
  double training = std::nan("");
};
Original original_of(const LearningFit& f) {
  if (f.part != LearningPart::study) return {};
  if (f.bodies == 2)
    return f.integrator == "CF4" && f.noise == 0 && f.count == 500 && f.points == 5
               ? Original{published_two, std::nan("")}
               : Original{};
  const PublishedFit* published = published_fit(f.noise, f.integrator, f.count, f.points);
  return published != nullptr ? Original{published->test, loss_over * published->loss} : Original{};
}

std::string fits_csv(const LearningFindings& findings) {
  std::string out =
      "part,bodies,noise,integrator,N,M,model,seed,outcome,training_mse,test_mse,seconds,published_test_mse\n";
  for (const auto& f : findings.fits) {
    const double original = original_of(f).test;
    fmt::format_to(std::back_inserter(out), "{},{},{:g},{},{},{},{},{},{},{:.4g},{:.4g},{:.3g},{}\n", name_of(f.part),
                   f.bodies, f.noise, f.integrator, f.count, f.points, f.model, f.seed, f.outcome, f.training, f.test,
                   f.seconds, original == original ? fmt::format("{:.4g}", original) : std::string());
  }
  return out;
}

std::string figures(const LearningFindings& findings) {
  const auto models = learning_models(findings.study);
  std::string out =
      "# Draws fits.csv; run by lagroid, or by hand: gnuplot figures.gp\nset datafile separator ','\nset grid\n"
      "set terminal svg size 1040,620 background 'white' noenhanced\nset output 'errors.svg'\nset multiplot layout "
      "1,2\nset logscale xy\nset format y '%.0e'\nset ylabel 'test MSE'\nset key below\n";
  const auto curves = [&](const std::string& x, const std::string& rows, bool each_integrator) {
    std::string plot = "plot ";
    const auto add = [&](const std::string& which, const std::string& column, const std::string& title,
                         const std::string& style) {
      plot += fmt::format(
          "{}'fits.csv' using ({}):(({}) && {} ? column('{}') : NaN) smooth unique with linespoints pointtype 7 "
          "pointsize 0.5 {} title '{}'",
          plot == "plot " ? "" : ", \\\n  ", x, rows, which, column, style, title);
    };
    for (const auto& integrator : learning_integrators()) {
      if (!each_integrator && integrator != "CF4") continue;
      const std::string of = fmt::format("(strcol('integrator') eq '{}')", integrator);
      add(of, "published_test_mse", integrator + ", published", "dashtype 2");
      for (const auto& model : models)
        add(fmt::format("{} && (strcol('model') eq '{}')", of, model), "test_mse", integrator + ", " + model, "");
    }
    return plot + "\n";
  };
  out +=
      "set title 'without noise, M = 5'\nset xlabel 'N'\n" +
      curves("column('N')",
             "(strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)",
             true);
  out +=
      fmt::format("set title 'CF4, M = 5, N = {0}'\nset xlabel 'noise'\n", findings.study.largest) +
      curves("column('noise') + 1e-4",
             fmt::format(
                 "(strcol('part') eq 'study') && (column('bodies') == 1) && (column('N') == {}) && (column('M') == 5)",
                 findings.study.largest),
             false);
  return out + "unset multiplot\nset output\n";
}

std::string shown(double x) { return x == x ? fmt::format("{:.2g}", x) : std::string("-"); }

/// In how many cells of one pendulum the model's test error is below the published median, and in how many it is not.
std::pair<long, long> against_published(const LearningFindings& findings, const std::string& model) {
  std::pair<long, long> out{0, 0};
  for (const auto& f : findings.fits) {
    if (f.part != LearningPart::study || f.bodies != 1 || f.model != model || f.seed != findings.study.first_seed)
      continue;
    const PublishedFit* published = published_fit(f.noise, f.integrator, f.count, f.points);
    if (published == nullptr) continue;
    ++(median_of(findings, f, &LearningFit::test) < published->test ? out.first : out.second);
  }
  return out;
}

std::string table(const LearningFindings& findings, int bodies, double noise) {
  const auto models = learning_models(findings.study);
  std::string out = fmt::format(
      "| integrator | N | M | test MSE: published | {0} | {1} | training MSE: published | {0} | {1} | s to train: {0} "
      "| {1} |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      models[0], models[1]);
  for (const auto& f : findings.fits) {
    if (f.part != LearningPart::study || f.bodies != bodies || f.noise != noise || f.model != models[0] ||
        f.seed != findings.study.first_seed)
      continue;
    LearningFit other = f;
    other.model = models[1];
    const auto both = [&](double LearningFit::*value) {
      return fmt::format("{} | {}", shown(median_of(findings, f, value)), shown(median_of(findings, other, value)));
    };
    const Original original = original_of(f);
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", f.integrator, f.count, f.points,
                       shown(original.test), both(&LearningFit::test), shown(original.training),
                       both(&LearningFit::training), both(&LearningFit::seconds));
  }
  return out;
}

/// The smallest and the largest of `ratio` over the study's cells of one pendulum and one model that it is a number
/// for.
std::string range(const LearningFindings& findings, const std::string& model,
                  const std::function<double(const LearningFit&)>& ratio) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (const auto& f : findings.fits) {
    if (f.part != LearningPart::study || f.bodies != 1 || f.model != model || f.seed != findings.study.first_seed)
      continue;
    const double x = ratio(f);
    if (!std::isfinite(x)) continue;
    least = std::min(least, x);
    most = std::max(most, x);
  }
  return fmt::format("{:.2g} to {:.2g}", least, most);
}

std::string models_table(const LearningFindings& findings) {
  std::string out =
      "| k | noise | model | parameters | test MSE | training MSE | s to train |\n|---|---|---|---|---|---|---|\n";
  for (const auto& f : findings.fits)
    if (f.part == LearningPart::models && f.seed == findings.study.first_seed)
      out += fmt::format("| {} | {:g} | {} | {} | {} | {} | {} |\n", f.bodies, f.noise, f.model, f.parameters,
                         shown(median_of(findings, f, &LearningFit::test)),
                         shown(median_of(findings, f, &LearningFit::training)),
                         shown(median_of(findings, f, &LearningFit::seconds)));
  return out;
}

std::string integrators_table(const LearningFindings& findings) {
  std::string out = "| integrator | test MSE | training MSE | s to train |\n|---|---|---|---|\n";
  for (const auto& f : findings.fits)
    if (f.part == LearningPart::integrators && f.seed == findings.study.first_seed)
      out += fmt::format("| {} | {} | {} | {} |\n", f.integrator, shown(median_of(findings, f, &LearningFit::test)),
                         shown(median_of(findings, f, &LearningFit::training)),
                         shown(median_of(findings, f, &LearningFit::seconds)));
  return out;
}

std::string report(const LearningFindings& findings, const std::string& command, bool pictures) {
  const auto models = learning_models(findings.study);
  std::string out = fmt::format(
      "# Learning Hamiltonians: the parameter study\n\nWritten by\n\n    {}\n\non {}.\n\n"
      "N trajectories of M points until t = 0.1 of a spherical pendulum of unit mass, length and gravity, with uniform "
      "errors up to the noise in every number but the first points'. H = p.M(q)^{{-1}} p / 2 + V(q) is fitted through "
      "four integrators, with {} between two points, by Levenberg and Marquardt's method with exact derivatives "
      "(docs/learning.md). V is a network of one hidden layer ({}), or a polynomial ({}), which contains the true "
      "potential. Test MSE: over 100 other trajectories without noise, 15 points until t = 1, by the learned motion "
      "itself, free of the integrator's error. Published: medians of five runs of the original, whose training loss is "
      "the mean squared error over {:g}; for two pendula one run of a notebook, with two steps between points (ours "
      "too). "
      "Ours: {}. With noise a fifth of the "
      "trajectories is held out, to stop early.\n\n",
      command, machine(),
      findings.study.substeps == 1 ? std::string("one step") : fmt::format("{} steps", findings.study.substeps),
      models[0], models[1], loss_over,
      findings.study.runs == 1 ? std::string("one run") : fmt::format("medians of {} runs", findings.study.runs));
  for (const auto& model : models) {
    const auto [below, not_below] = against_published(findings, model);
    out += fmt::format("- {}: below the published median in {} of {} cells.\n", model, below, below + not_below);
  }
  out += fmt::format(
      "- Through the methods of order one, without noise, N >= 500, our training MSE ({}) over the published one is "
      "{}: "
      "what the integrator gets wrong is most of it.\n"
      "- Through CF4 with noise, N >= 500, our training MSE ({}) over the variance of the noise, noise^2 / 3, is {}.\n"
      "\nWithout noise the integrator's error is the floor: a method of order one learns a Hamiltonian whose numerical "
      "motion fits, and that is not the true one.\n",
      models[1],
      range(findings, models[1],
            [&](const LearningFit& f) {
              const bool asked = f.noise == 0 && f.count >= 500 && (f.integrator == "LE" || f.integrator == "EE");
              return asked ? median_of(findings, f, &LearningFit::training) / original_of(f).training : std::nan("");
            }),
      models[0], range(findings, models[0], [&](const LearningFit& f) {
        const bool asked = f.noise > 0 && f.count >= 500 && f.integrator == "CF4";
        return asked ? median_of(findings, f, &LearningFit::training) * 3 / (f.noise * f.noise) : std::nan("");
      }));
  if (pictures) out += "\n![test errors over N and noise](errors.svg)\n";
  std::set<std::pair<int, double>> chapters;
  for (const auto& f : findings.fits)
    if (f.part == LearningPart::study) chapters.emplace(f.bodies, f.noise);
  for (const auto& [bodies, noise] : chapters)
    out += fmt::format("\n## {}, {}\n\n{}", bodies == 1 ? "One pendulum" : "Two pendula",
                       noise == 0 ? std::string("without noise") : fmt::format("noise {:g}", noise),
                       table(findings, bodies, noise));
  out += fmt::format(
      "\n## Models of several sizes\n\nN = {}, M = 5, through CF4 with two steps between points, as `lagroid learn` "
      "does "
      "unless told otherwise. With noise e the training error ends at its variance, e^2 / 3; fewer parameters learn "
      "less "
      "of it.\n\n{}\n## Integrators\n\nOne pendulum, polynomial:1, two steps between points, no noise: the "
      "integrator's own "
      "error is what is left.\n\n{}",
      std::min(500, findings.study.largest), models_table(findings), integrators_table(findings));
  return out;
}

}  // namespace

std::vector<std::filesystem::path> write_learning_report(const LearningFindings& findings, const std::string& command,
                                                         const std::filesystem::path& folder, std::string& note) {
  const auto data = [&](const std::filesystem::path& staging) {
    write_text(fits_csv(findings), staging / "fits.csv");
    write_text(figures(findings), staging / "figures.gp");
    return std::vector<std::string>{"fits.csv", "figures.gp"};
  };
  return write_and_draw(folder, learning_report_files, data, {"figures.gp", {"errors.svg"}}, note,
                        [&](const std::filesystem::path& staging, bool drawn) {
                          write_text(report(findings, command, drawn), staging / "report.md");
                          return std::vector<std::string>{"report.md"};
                        });
}

}  // namespace lagroid::app
