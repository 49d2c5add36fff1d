#pragma once
/// The parameter study of [H]: Hamiltonians learned from trajectories of one and two spherical pendula.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// What the original found.
struct PublishedFit {
  double noise;
  std::string_view integrator;
  int count;    ///< N, trajectories
  int points;   ///< M, points of each
  double test;  ///< E1, mean squared error on trajectories that were not trained on
  double loss;  ///< mean squared error of training, over 20
};
/// Its median of that cell (one pendulum); null where there is none.
const PublishedFit* published_fit(double noise, std::string_view integrator, int count, int points);
/// For two pendula, N = 500, M = 5, no noise, CF4.
inline constexpr double published_two = 2.181239068433486e-06;

struct LearningStudy {
  int runs = 1;             ///< data sets of each cell, of which medians are taken
  unsigned first_seed = 1;  ///< of the first
  int largest = 1500;       ///< cells with more trajectories are left out
  int units = 8;            ///< of the network's hidden layer
  int substeps = 1;         ///< of the integrator between two points, for one pendulum; elsewhere two
  int threads = 2;          ///< cells at a time; nothing but the time depends on it
};

/// What a fit is made for.
enum class LearningPart {
  study,       ///< the original's cells: four integrators, N, M and noise
  models,      ///< models of several sizes on the original's data, N = 500 and M = 5, through CF4
  integrators  ///< all of them, with four parameters
};

/// One fit.
struct LearningFit {
  LearningPart part = LearningPart::study;
  int bodies = 1;
  double noise = 0;
  std::string integrator;
  int count = 0;
  int points = 0;
  int substeps = 1;
  std::string model = {};
  unsigned seed = 0;
  std::string outcome = {};
  long parameters = 0;
  double training = 0;  ///< mean squared error
  double test = 0;      ///< E1
  double seconds = 0;   ///< of the processor, to train
};

struct LearningFindings {
  LearningStudy study;
  std::vector<LearningFit> fits;
};

/// The integrators' names in the original, in the order of its tables.
const std::vector<std::string>& learning_integrators();
/// The models of the study: the network, and the polynomial that contains the true potential.
std::vector<std::string> learning_models(const LearningStudy& study);

/// `report(done, all)` is called after each fit.
LearningFindings run_learning_study(const LearningStudy& study, const std::function<void(long, long)>& report);

/// Median over runs; not a number where there are none.
double median_of(const LearningFindings& findings, const LearningFit& cell, double LearningFit::*value);

extern const std::vector<const char*> learning_report_files;

/// report.md, fits.csv and the figure. `note` says why there is no picture, where there is none.
std::vector<std::filesystem::path> write_learning_report(const LearningFindings& findings, const std::string& command,
                                                         const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
