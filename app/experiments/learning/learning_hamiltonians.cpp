#include "learning_hamiltonians.hpp"

#include <lagroid/solvers/ensemble/tasks.hpp>
#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/systems/pendulums/chain_trajectories.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>

namespace lagroid::app {

namespace {

using learning::Model;
using learning::Trajectories;

constexpr int counts[] = {50, 500, 1000, 1500};
constexpr int numbers_of_points[] = {2, 3, 5};
constexpr double noises[] = {0, 0.001, 0.01, 0.1};
constexpr unsigned test_seed = 1'000'007;

/// By its name in the original, or in the library.
LieGroupMethod method_of(const std::string& integrator) {
  if (const LieGroupMethod* method = lie_group_methods::named(integrator)) return *method;
  return integrator == "CF4"   ? lie_group_methods::commutator_free_4
         : integrator == "LE"  ? lie_group_methods::lie_euler
         : integrator == "RK4" ? lie_group_methods::runge_kutta_4
                               : lie_group_methods::euler;
}

/// kind:size.
std::unique_ptr<Model> model_of(int bodies, const std::string& name) {
  const int size = std::stoi(name.substr(name.find(':') + 1));
  if (name.starts_with("network")) return learning::network_model(bodies, {size});
  return learning::polynomial_model(bodies, size);
}

/// Unit masses, lengths and gravity.
PendulumChain<Eigen::Dynamic> chain(int bodies) {
  return {Eigen::VectorXd::Ones(bodies), Eigen::VectorXd::Ones(bodies), 1};
}
/// The original's test data: a hundred trajectories of 15 points until t = 1.
Trajectories test_data(int bodies) {
  return assemble(draw_trajectories(chain(bodies), {.count = 100, .points = 15, .duration = 1, .seed = test_seed}));
}

/// The fits to be made, without their findings.
std::vector<LearningFit> cells(const LearningStudy& study) {
  std::vector<LearningFit> out;
  const auto add = [&](LearningFit fit, const std::vector<std::string>& models) {
    for (const std::string& model : models)
      for (int run = 0; run < study.runs; ++run) {
        fit.model = model;
        fit.seed = study.first_seed + unsigned(run);
        out.push_back(fit);
      }
  };
  const auto models = learning_models(study);
  for (const double noise : noises)
    for (const std::string& integrator : learning_integrators())
      for (const int count : counts)
        for (const int points : numbers_of_points)
          if (count <= study.largest)
            add({LearningPart::study, 1, noise, integrator, count, points, study.substeps}, models);
  const int usual = std::min(500, study.largest);
  constexpr int substeps = 2;
  for (const double noise : {0.0, 0.01})
    for (const std::string& integrator : learning_integrators())
      for (const int count : {50, 500})
        for (const int points : numbers_of_points)
          if (count <= study.largest) add({LearningPart::study, 2, noise, integrator, count, points, substeps}, models);
  for (const double noise : {0.0, 0.01})
    for (const int bodies : {1, 2})
      add({LearningPart::models, bodies, noise, "CF4", usual, 5, substeps},
          {"polynomial:1", "polynomial:2", "network:8", "network:12"});
  for (const auto& method : lie_group_methods::all)
    add({LearningPart::integrators, 1, 0, std::string(method.name), usual, 5, substeps}, {"polynomial:1"});
  return out;
}

void fit(LearningFit& cell, const Trajectories& test) {
  const auto observed = draw_trajectories(
      chain(cell.bodies),
      {.count = cell.count, .points = cell.points, .duration = 0.1, .noise = cell.noise, .seed = cell.seed});
  const auto model = model_of(cell.bodies, cell.model);
  const auto trained = train(*model, learning::assemble(observed, cell.noise),
                             {.method = method_of(cell.integrator),
                              .substeps = cell.substeps,
                              .seed = cell.seed,
                              .threads = 1,
                              .validation = cell.noise > 0 ? 0.2 : 0});
  cell.outcome = std::string(to_string(trained.outcome));
  cell.training = trained.mse;
  cell.parameters = model->size();
  cell.seconds = trained.seconds;
  cell.test = std::numeric_limits<double>::quiet_NaN();
  if (!trained.usable()) return;
  const auto measured = measure(*model, trained.parameters, test);
  if (measured.lost == 0) cell.test = measured.mse;
}

}  // namespace

const std::vector<std::string>& learning_integrators() {
  static const std::vector<std::string> names{"CF4", "RK4", "LE", "EE"};
  return names;
}
std::vector<std::string> learning_models(const LearningStudy& study) {
  return {fmt::format("network:{}", study.units), "polynomial:2"};
}

LearningFindings run_learning_study(const LearningStudy& study, const std::function<void(long, long)>& report) {
  LearningFindings findings{study, cells(study)};
  const Trajectories tests[] = {test_data(1), test_data(2)};
  std::mutex reporting;
  long done = 0;
  for_each_task(long(findings.fits.size()), study.threads, [&](long i) {
    LearningFit& cell = findings.fits[std::size_t(i)];
    fit(cell, tests[cell.bodies - 1]);
    const std::lock_guard guard(reporting);
    report(++done, long(findings.fits.size()));
  });
  return findings;
}

double median_of(const LearningFindings& findings, const LearningFit& cell, double LearningFit::*value) {
  std::vector<double> found;
  for (const LearningFit& f : findings.fits)
    if (f.part == cell.part && f.bodies == cell.bodies && f.noise == cell.noise && f.integrator == cell.integrator &&
        f.count == cell.count && f.points == cell.points && f.model == cell.model)
      found.push_back(f.*value);
  if (found.empty()) return std::numeric_limits<double>::quiet_NaN();
  // Fits that failed count as the worst.
  std::sort(found.begin(), found.end(), [](double a, double b) { return a < b || (a == a && b != b); });
  return found[found.size() / 2];
}

}  // namespace lagroid::app
