// Fits whose answers are known: starts by velocities, deviations under Huber's loss and without anything left over, and
// what no scene allows.
#include "subject_of_run.hpp"

#include <families/family.hpp>
#include <gradient/fit/fit.hpp>
#include <gradient/system_gradients.hpp>
#include <gradient/uncertainty.hpp>
#include <program.hpp>

#include <lagroid/core/derivatives/velocity_start.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/run/motion/parameter_values.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/mechanical.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {
const SystemModule& chaplygin_sleigh_module();
std::optional<GradientSubject> chaplygin_sleigh_gradient(const Section& scene);

namespace fits_tests {
namespace {

/// A file, gone with this.
class Data {
 public:
  explicit Data(const std::string& text) {
    static int count = 0;
    file_ = std::filesystem::temp_directory_path() / fmt::format("lagroid-fits-{}-{}.csv", getpid(), ++count);
    std::ofstream(file_) << text;
  }
  ~Data() { std::filesystem::remove(file_); }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  std::vector<std::string> files() const { return {file_.string()}; }

 private:
  std::filesystem::path file_;
};

/// A column of a subject's own run, with errors.
std::string measured(const GradientSubject& subject, const std::vector<std::size_t>& columns,
                     const std::function<double()>& error) {
  std::string out = "t";
  for (const std::size_t c : columns) out += "," + subject.observed[c].name;
  const auto motion = subject.begin({}, {});
  for (long k = 0; k <= subject.steps; ++k) {
    const bool is_there = k == 0 || motion->advance().converged();
    EXPECT_TRUE(is_there);
    out += fmt::format("\n{}", motion->time());
    for (const std::size_t c : columns) out += fmt::format(",{}", motion->observe().values(Eigen::Index(c)) + error());
  }
  return out + "\n";
}
std::string exact(const GradientSubject& subject, const std::vector<std::size_t>& columns) {
  return measured(subject, columns, [] { return 0.0; });
}

GradientSubject sleigh(std::vector<std::string> settings) {
  use_families({&systems_family()});
  use_systems({&chaplygin_sleigh_module()});
  settings.insert(settings.begin(), {"time.duration=4", "time.steps=80", "initial.velocity=[0.4,-0.6]"});
  const auto out = chaplygin_sleigh_gradient(read_scene(LAGROID_EXAMPLES "/chaplygin_sleigh.toml", settings));
  EXPECT_TRUE(out.has_value());
  return *out;
}

/// It names velocities and no momentum that they come to.
struct NearlyStarted : System<NearlyStarted, SE2> {
  static constexpr std::array<std::string_view, 2> velocity_names{"w", "v1"};
  template <class S> S lagrangian(const Arrow<S>& g) const { return SE2::log(g).squaredNorm() * 0.5; }
  static Vector<double, 2> velocities(const State<SE2>& z) { return z.momentum.head<2>(); }
};
static_assert(StartsByVelocity<ChaplyginSleigh> && velocity_start_fits<ChaplyginSleigh>);
static_assert(!velocity_start_fits<NearlyStarted>, "would start by its momentum without a word");

TEST(VelocityStarts, AreKeptWhereParametersAreFitted) {
  const Data data(exact(sleigh({"parameters.mass=1.3", "parameters.offset=0.6"}), {0, 1, 2}));
  const Fit fit = fit_scene(sleigh({}), data.files(), {.unknowns = {"parameters.mass", "parameters.offset"}});
  ASSERT_TRUE(fit.converged()) << fit.status << fit.failure;
  EXPECT_NEAR(fit.unknowns[0].value, 1.3, 1e-9);
  EXPECT_NEAR(fit.unknowns[1].value, 0.6, 1e-9);
}

TEST(VelocityStarts, AreFitted) {
  const Data data(exact(sleigh({"initial.velocity=[0.5,-0.7]", "parameters.mass=1.1"}), {0, 1, 2}));
  const Fit fit = fit_scene(sleigh({}), data.files(), {.unknowns = {"initial", "parameters.mass"}});
  ASSERT_TRUE(fit.converged()) << fit.status << fit.failure;
  // Where it starts is none of what is fitted on a group, and is told.
  ASSERT_EQ(fit.unknowns.size(), 3u);
  ASSERT_EQ(fit.notes.size(), 1u);
  EXPECT_NE(fit.notes[0].find("initial.displacement.0"), std::string::npos) << fit.notes[0];
  EXPECT_EQ(fit.unknowns[0].name, "initial.w");
  EXPECT_NEAR(fit.unknowns[0].value, 0.5, 1e-9);
  EXPECT_NEAR(fit.unknowns[1].value, -0.7, 1e-9);
  EXPECT_NEAR(fit.unknowns[2].value, 1.1, 1e-9);
}

TEST(VelocityStarts, HaveTheDerivativesOfTheProgram) {
  const std::vector<std::string> of{"final"}, by{"initial", "parameters"};
  EXPECT_GT(differentiate(sleigh({}), of, by, /*check=*/true).digits_agreed, 8);
  // With the momentum held they are others.
  GradientSubject held = sleigh({});
  held.begun_by = [](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
    Eigen::MatrixXd out = sleigh({}).begun_by(parameters, nudges);
    out.rightCols(Eigen::Index(parameters.size())).setZero();
    return out;
  };
  EXPECT_LT(differentiate(held, of, by, /*check=*/true).digits_agreed, 2);
}

/// A bob on a spring.
struct Bob : MechanicalSystem<Bob, 1> {
  double stiffness = 3;
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * q(0) * (varied<S>(stiffness) * 0.5); }
  static auto parameters() { return std::tuple(parameter("stiffness", &Bob::stiffness, "N/m", "of it", positive)); }
};
GradientSubject bob(double stiffness) {
  Bob bob;
  bob.h = 0.1;
  bob.stiffness = stiffness;
  GradientSubject out = subject_of_run<1>("bob", bob, {Vector<double, 1>(1), Vector<double, 1>(0.1)}, 40,
                                          {{"position", "q"}, {"momentum", "p"}});
  out.refusal = [bob](const std::vector<Nudge>& nudges) {
    Bob other = bob;
    nudge_parameters(other, nudges);
    return set_parameters(other, parameter_values(other));
  };
  return out;
}

TEST(Fits, UnderHubersLossAreAsFarOffAsTheirDeviationsSay) {
  const GradientSubject subject = bob(3);
  constexpr double sigma = 0.01;
  constexpr int sets = 300;
  const auto ratio_of = [&](double outliers, double huber) {
    std::mt19937_64 draw(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> any(0, 1);
    double squares = 0;
    for (int k = 0; k < sets; ++k) {
      const Data data(measured(subject, {0}, [&] { return sigma * (any(draw) < outliers ? 20 : 1) * normal(draw); }));
      const Fit fit =
          fit_scene(subject, data.files(),
                    {.unknowns = {"initial", "parameters.stiffness"}, .sigma = {{"q", sigma}}, .huber = huber});
      EXPECT_TRUE(fit.converged()) << fit.failure;
      const Fit::Unknown& stiffness = fit.unknowns[2];
      squares += std::pow((stiffness.value - 3) / stiffness.deviation, 2);
    }
    return squares / sets;
  };
  // Chi squared over its 300 is one within a quarter, four deviations of it, and more is for what is no normal error.
  for (const auto& [outliers, huber] : {std::pair{0.0, 0.0}, {0.0, 0.5}, {0.0, 1.5}, {0.1, 1.5}})
    EXPECT_NEAR(ratio_of(outliers, huber), 1, 0.35) << outliers << " " << huber;
}

TEST(Fits, OfAsManyNumbersAsUnknownsKnowNoErrorsButThoseTheyAreTold) {
  const GradientSubject subject = bob(3);
  const Data data("t,q\n1,-0.1\n");
  FitOptions options{.unknowns = {"parameters.stiffness"}};
  const Fit unknown = fit_scene(subject, data.files(), options);
  ASSERT_TRUE(unknown.converged());
  EXPECT_TRUE(std::isnan(unknown.unknowns[0].deviation));
  EXPECT_NE(text_of(unknown).find("not known"), std::string::npos) << text_of(unknown);
  EXPECT_NE(json_of(unknown).find("\"deviation\": null"), std::string::npos);
  options.sigma = {{"q", 0.01}};
  const double deviation = fit_scene(subject, data.files(), options).unknowns[0].deviation;
  options.sigma = {{"q", 0.03}};
  EXPECT_NEAR(fit_scene(subject, data.files(), options).unknowns[0].deviation, 3 * deviation, 1e-9 * deviation);
  // As the derivative has it.
  const GradientTable table = differentiate(bob(unknown.unknowns[0].value), {"node.10.q"}, {"parameters"}, false);
  EXPECT_NEAR(deviation, 0.01 / std::abs(table.derivatives(0, 0)), 1e-6 * deviation);
}

TEST(Fits, StayWhereScenesAreAllowed) {
  // A bob that runs away without end pulls the stiffness below zero.
  const Data data("t,q\n0,1\n0.5,1.4\n1,2.1\n1.5,3.2\n2,5\n");
  const Fit fit = fit_scene(bob(3), data.files(), {.unknowns = {"parameters.stiffness"}});
  ASSERT_TRUE(fit.failure.empty()) << fit.failure;
  EXPECT_GT(fit.unknowns[0].value, 0);
  EXPECT_LT(fit.unknowns[0].value, 1e-5);
  EXPECT_TRUE(fit.unknowns[0].at_bound);
  EXPECT_EQ(fit.rank, 0);
  // Without what scenes refuse it is there.
  GradientSubject any = bob(3);
  any.refusal = nullptr;
  EXPECT_LT(fit_scene(any, data.files(), {.unknowns = {"parameters.stiffness"}}).unknowns[0].value, -0.1);
}

TEST(Fits, RefuseAStartThatCannotBeChangedAlone) {
  GradientSubject tied = bob(3);
  tied.refusal = [](const std::vector<Nudge>& nudges) -> std::string {
    for (const Nudge& nudge : nudges)
      if (nudge.parameter.empty() && nudge.index == 0 && nudge.by != 0) return "the start is off the wall";
    return "";
  };
  const Data data(exact(tied, {0}));
  EXPECT_THROW(
      try { fit_scene(tied, data.files(), {.unknowns = {"initial.q"}}); } catch (const GradientRefused& refused) {
        EXPECT_STREQ(refused.what(), "initial.q: with another one alone the start is off the wall; fit others");
        throw;
      },
      GradientRefused);
  const Fit fit = fit_scene(tied, data.files(), {.unknowns = {"initial"}});
  ASSERT_EQ(fit.unknowns.size(), 1u);
  EXPECT_EQ(fit.unknowns[0].name, "initial.p");
}

TEST(Fits, DrawsThatScenesRefuseDoNotCount) {
  const GradientSubject subject = bob(0.1);
  const InputErrors errors = independent_errors(subject, {"parameters.stiffness=0.1"});
  const Uncertainty found = uncertainty_of(subject, {"final.q"}, errors, {.count = 200});
  // A sixth of them are below zero.
  EXPECT_GT(found.sample->refused, 15);
  EXPECT_LT(found.sample->refused, 55);
  EXPECT_NE(text_of(found).find(fmt::format("{} of which have numbers that scenes refuse", found.sample->refused)),
            std::string::npos)
      << text_of(found);
}

}  // namespace
}  // namespace fits_tests
}  // namespace lagroid::app
