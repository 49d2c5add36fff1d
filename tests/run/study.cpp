// Studies: what they measure, what they recommend, what a scene with a target error gets.

#include "../app/command_line.hpp"

#include <lagroid/run/study/findings/costs.hpp>
#include <lagroid/run/study/measure.hpp>
#include <lagroid/run/study/methods.hpp>
#include <lagroid/run/study/survey.hpp>
#include <study/accuracy.hpp>
#include <study/scene_experiment.hpp>

#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/kepler.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>

using namespace lagroid;
using namespace lagroid::app;

namespace run_study_tests {
namespace {

Section example(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return read_scene(std::string(LAGROID_EXAMPLES) + "/" + name + ".toml", overrides);
}

Section orbit(const std::vector<std::string>& overrides = {}) {
  return parse_scene(
             "system = \"kepler\"\n[initial]\nposition = [0.4, 0]\nmomentum = [0, 2]\n[time]\nduration = 10\nsteps = "
             "500\n",
             "orbit.toml", {})
      .set(overrides);
}

const Method& method_named(const std::vector<Method>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Method& m) { return m.name == name; });
  if (found == all.end()) throw std::out_of_range(name);
  return *found;
}

std::set<std::string> names(const std::vector<Method>& all) {
  std::set<std::string> out;
  for (const Method& m : all) out.insert(m.name);
  return out;
}

TEST(Methods, DeclareThemselves) {
  const auto body = names(read_experiment(example("rigid_body")).methods);
  for (const char* name : {"variational", "variational/kahan-li-8", "splitting", "splitting/blanes-moan-6",
                           "moser-veselov/10", "runge-kutta", "adaptive", "controlled"})
    EXPECT_TRUE(body.contains(name)) << name;
  EXPECT_FALSE(body.contains("splitting/nystrom-6")) << "its kinetic energy is no potential's partner";
  const auto orbits = names(read_experiment(example("kepler")).methods);
  EXPECT_TRUE(orbits.contains("splitting/nystrom-6"));
  EXPECT_TRUE(orbits.contains("transformed/kahan-li-8"));
  EXPECT_FALSE(orbits.contains("moser-veselov/10"));
  EXPECT_EQ(names(read_experiment(example("rolling_disk")).methods), std::set<std::string>{"variational"});
  const auto chain = names(read_experiment(example("chain_drop")).methods);
  EXPECT_TRUE(chain.contains("variational/suzuki"));
  EXPECT_FALSE(chain.contains("controlled"));
  EXPECT_TRUE(names(read_experiment(example("figure_eight")).methods).contains("controlled"));
}

/// Whatever a method declares is accepted by the scene that it was declared for, and integrates with its order.
TEST(Methods, AreAcceptedByTheirScenes) {
  for (const char* name : {"kepler", "rigid_body", "heavy_top", "pendulum", "spherical_pendulum", "damped_pendulum",
                           "driven_pendulum", "driven_body", "rolling_ball", "chaplygin_sleigh", "chain_drop",
                           "figure_eight", "tops", "pendulum_chain", "pendulum_chain_adaptive"}) {
    const Experiment experiment = read_experiment(example(name));
    for (const Method& method : experiment.methods) {
      const auto motion = experiment.begin(method, experiment.step);
      EXPECT_EQ(motion->traits().order, method.order) << name << ' ' << method.name;
      IntegrationCost work;
      const StepReport report = advance(*motion, work);
      EXPECT_TRUE(report.converged() || !method.equal_steps) << name << ' ' << method.name;
      EXPECT_EQ(work.steps, report.converged() ? 1 : 0);
      EXPECT_FALSE(motion->state().empty());
    }
  }
}

/// Of chains, every method with equal steps, in both forms, shows its order.
TEST(Methods, OfChainsHaveTheirOrders) {
  const Experiment experiment = read_experiment(example("pendulum_chain", {"time.steps=250"}));
  const auto reference = extrapolated_reference(experiment, 5);
  EXPECT_LT(reference->uncertainty, 1e-11);
  int equal = 0;
  for (const Method& method : experiment.methods) {
    if (!method.equal_steps) continue;
    ++equal;
    const auto error = [&](int steps) {
      return measure_once(experiment, method, experiment.end / steps, reference.get(), 60).trajectory;
    };
    const double order = laws::measured_order(error, method.order == 1 ? 1000 : method.order == 8 ? 60 : 200);
    EXPECT_GT(order, method.order - 0.15) << method.name;
    EXPECT_LT(order, method.order + (method.order == 8 ? 1 : 0.5)) << method.name;
  }
  EXPECT_EQ(equal, 6 + 16) << "rattle and its compositions, and eight methods in two forms";
}

/// Steps by a tolerance come near it, whatever the distance of the nodes.
TEST(Methods, OfChainsWithATolerance) {
  const Experiment experiment = read_experiment(example("pendulum_chain", {"time.steps=250"}));
  const auto reference = extrapolated_reference(experiment, 5);
  for (const std::string by : {"munthe-kaas-54", "extrapolation"})
    for (const auto& [word, tolerance] :
         {std::pair("1e-6", 1e-6), std::pair("1e-9", 1e-9), std::pair("1e-12", 1e-12)}) {
      const Method& method = method_named(experiment.methods, by + "/" + word);
      const auto run = measure_once(experiment, method, experiment.end / 5, reference.get(), 60);
      ASSERT_TRUE(run.converged()) << method.name;
      EXPECT_EQ(run.work.steps, 5);
      EXPECT_GT(run.work.evaluations, 5 * 6);
      EXPECT_LT(run.trajectory, 10 * tolerance) << method.name;
    }
}

TEST(Methods, AreFoundByPatterns) {
  const auto all = read_experiment(orbit()).methods;
  EXPECT_EQ(matching("", all).size(), all.size());
  const auto some = matching("runge*,splitting/*-8,runge-kutta", all);
  ASSERT_EQ(some.size(), 3u);
  EXPECT_EQ(some[0].name, "runge-kutta");
  EXPECT_THROW(matching("split", all), UnknownMethod);
}

TEST(Experiments, AreOfScenesThatChooseTheirMethodThemselves) {
  for (const char* name : {"pendulum_adaptive", "kepler_controlled", "kepler_order_8", "rigid_body_moser_veselov"})
    EXPECT_FALSE(read_experiment(example(name)).methods.empty()) << name;
}
TEST(Experiments, AreOfInitialValues) { EXPECT_THROW(read_experiment(example("kepler_boundary")), SceneError); }

TEST(References, AreTheSolution) {
  const Experiment experiment = read_experiment(orbit());
  const Kepler kepler;
  const State<Pair<2>> start{{0.4, 0}, {0, 2}};
  const auto reference = extrapolated_reference(experiment, 5);
  for (const double time : {10.0, 9.3}) {
    const auto exact = kepler.reference(start, time);
    const auto state = reference->at(time);
    ASSERT_EQ(state.size(), 2u);
    EXPECT_NEAR(state[0].values[2], exact.object(0), 1e-11);
    EXPECT_NEAR(state[1].values[1], exact.momentum(1), 1e-11);
  }
  EXPECT_LT(reference->uncertainty, 1e-11);
  // A poor one knows that it is.
  const auto poor = method_reference(experiment, method_named(experiment.methods, "splitting"), 0.01);
  const auto exact = kepler.reference(start, 10);
  const double error =
      std::hypot(poor->at(10)[0].values[2] - exact.object(0), poor->at(10)[0].values[3] - exact.object(1));
  EXPECT_GT(poor->uncertainty, 0.1 * error);
  EXPECT_LT(poor->uncertainty, 10 * error);
}

TEST(Measurements, ShowOrdersInvariantsAndDrift) {
  const Experiment experiment = read_experiment(orbit({"time.duration=200"}));
  const auto reference = extrapolated_reference(experiment, 5);
  const auto at = [&](const char* name, double h) {
    return measure_once(experiment, method_named(experiment.methods, name), h, reference.get(), 10);
  };
  for (const char* name : {"splitting", "splitting/nystrom-4", "runge-kutta"}) {
    const Method& method = method_named(experiment.methods, name);
    const double h = 0.02 * std::sqrt(method.stages);
    const auto coarse = at(name, h);
    const auto fine = at(name, h / 2);
    ASSERT_TRUE(coarse.converged() && fine.converged());
    EXPECT_NEAR(double(fine.work.steps), 2.0 * double(coarse.work.steps), 1);
    if (method.order == 2) {
      EXPECT_NEAR(std::log2(coarse.invariants / fine.invariants), 2, 0.2) << name;
    } else {
      EXPECT_GT(std::log2(coarse.trajectory / fine.trajectory), 3.5) << name;
    }
  }
  const auto symplectic = at("splitting", 0.01);
  EXPECT_LT(std::abs(symplectic.drift), 5 * symplectic.drift_error + 1e-3 * symplectic.invariants);
  const auto drifting = at("runge-kutta", 0.02);
  EXPECT_GT(std::abs(drifting.drift), 50 * drifting.drift_error);
  EXPECT_TRUE(std::isnan(symplectic.constraint)) << "the plane has no equations";
}

TEST(Measurements, SeeConstraintsAndTheGroup) {
  const Experiment experiment = read_experiment(example("rigid_body"));
  const auto off = [&](const char* name) {
    return measure_once(experiment, method_named(experiment.methods, name), 0.1, nullptr, 10).constraint;
  };
  EXPECT_LT(off("splitting"), 1e-14);
  EXPECT_GT(off("runge-kutta"), 1e-9);
}

TEST(Measurements, MarkWhatFails) {
  const Experiment experiment = read_experiment(example("rigid_body"));
  const auto reference = extrapolated_reference(experiment, 2);
  const auto found = survey(experiment, matching("moser-veselov/10,splitting", experiment.methods), {{5.0, 0.01}, 1},
                            *reference, 2, Budget(60), [](double) { return true; });
  EXPECT_TRUE(found.left_out.empty());
  const auto& runs = found.runs;
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_EQ(runs[0].status, "refused");
  EXPECT_NE(runs[0].message.find("too long"), std::string::npos) << runs[0].message;
  EXPECT_TRUE(runs[1].converged());
  EXPECT_EQ(runs[1].seconds.size(), 2u);
  EXPECT_TRUE(std::isfinite(runs[1].trajectory));
}

/// A run that ends farther off than the motion is large has failed; and it is no point of a figure where its error is
/// larger than that.
TEST(Measurements, BeyondTheMotionsSizeAreNone) {
  const Experiment experiment = read_experiment(orbit());
  const auto reference = extrapolated_reference(experiment, 5);
  const auto run = measure_once(experiment, method_named(experiment.methods, "runge-kutta"), 1.25, reference.get(), 10);
  EXPECT_GT(run.trajectory, 2);
  EXPECT_EQ(run.status, "astray");
  EXPECT_NE(run.message.find("times the size of the motion"), std::string::npos) << run.message;
  EXPECT_FALSE(is_point(run, Axis::invariants));
  Measurement lost = run;
  lost.status = "converged";
  lost.trajectory = 1.5;  // out of phase
  lost.invariants = 1e-3;
  EXPECT_FALSE(is_point(lost, Axis::trajectory));
  EXPECT_TRUE(is_point(lost, Axis::invariants));
  EXPECT_FALSE(is_point(lost, Axis::constraint)) << "there is none";
}

Measurement made_up(const char* method, double step, double error, double seconds) {
  Measurement m;
  m.method = method;
  m.step = step;
  m.trajectory = error;
  m.seconds = {seconds};
  m.work.evaluations = long(1 / step);
  return m;
}

TEST(Costs, AreInterpolatedAndLeast) {
  std::vector<Measurement> all{made_up("a", 0.1, 1e-2, 1), made_up("a", 0.05, 1e-4, 2), made_up("a", 0.025, 1e-6, 4),
                               made_up("b", 0.1, 1e-3, 3), made_up("b", 0.05, 1e-9, 6)};
  const auto cost = cost_of(all, "a", Axis::trajectory, 1e-3);
  ASSERT_TRUE(cost);
  EXPECT_NEAR(cost->seconds, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(cost->step, 0.1 / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(least_cost(all, Axis::trajectory, 1e-5)->method, "a");
  EXPECT_EQ(least_cost(all, Axis::trajectory, 1e-8)->method, "b");
  EXPECT_FALSE(least_cost(all, Axis::trajectory, 1e-12));
  EXPECT_FALSE(cost_of(all, "a", Axis::invariants, 1e-3)) << "nothing was measured of them";
  // What is below the error by chance, with a large step, is not trusted.
  all.push_back(made_up("a", 0.2, 1e-7, 0.5));
  EXPECT_NEAR(cost_of(all, "a", Axis::trajectory, 1e-3)->seconds, std::sqrt(2.0), 1e-12);
  // What drowned in round-off hides no run that did not.
  all.push_back(made_up("b", 0.01, 1e-7, 30));
  EXPECT_EQ(least_cost(all, Axis::trajectory, 1e-8)->step, cost_of(all, "b", Axis::trajectory, 1e-8)->step);
  // Runs that failed cost nothing and give nothing.
  all.push_back(made_up("c", 0.1, 1e-9, 0.1));
  all.back().status = "not_finite";
  EXPECT_EQ(least_cost(all, Axis::trajectory, 1e-8)->method, "b");
}

TEST(Costs, NameTheCheapestMethods) {
  const std::vector<Measurement> all{made_up("dear", 0.1, 1e-2, 10),  made_up("dear", 0.05, 1e-9, 20),
                                     made_up("low", 0.1, 2e-2, 0.1),  made_up("low", 0.01, 2e-4, 1),
                                     made_up("high", 0.1, 1e-2, 0.5), made_up("high", 0.05, 1e-8, 1.2)};
  EXPECT_EQ(cheapest_methods(all, Axis::trajectory, &Cost::seconds, 1e-7), (std::vector<std::string>{"low", "high"}));
  EXPECT_EQ(cheapest_methods(all, Axis::trajectory, &Cost::seconds, 1e-9),
            (std::vector<std::string>{"low", "high", "dear"}));
}

/// Where time is short it goes to what is cheap: a method of order 2 is given up while one of order 6 goes on.
TEST(Surveys, SpendTheirTimeWhereItTellsMost) {
  Experiment experiment = read_experiment(orbit({"time.duration=200", "time.steps=20000"}));
  const auto reference = extrapolated_reference(experiment, 5);
  const auto methods = matching("splitting,splitting/nystrom-6", experiment.methods);
  const Budget budget(3);
  const Survey found = survey(experiment, methods, {{}, 60}, *reference, 2, budget, [](double) { return true; });
  EXPECT_LT(budget.spent(), 12);
  ASSERT_FALSE(found.left_out.empty());
  const auto least_error = [&](const char* name) {
    double least = 1;
    for (const Measurement& m : found.runs)
      if (m.method == name && m.converged()) least = std::min(least, m.trajectory);
    return least;
  };
  EXPECT_LT(least_error("splitting/nystrom-6"), 0.01 * least_error("splitting"));
  EXPECT_EQ(found.left_out.front().method, "splitting");
  EXPECT_FALSE(found.left_out.front().why.empty());
  for (const Measurement& m : found.runs) EXPECT_FALSE(m.seconds.empty()) << m.method;
}

/// The error that a scene with a target really has, against a reference far below it.
double error_reached(const Section& scene) {
  const AccuracyChoice choice = choose_by_accuracy(scene);
  EXPECT_FALSE(choice.scene.has("accuracy"));
  const Experiment experiment = read_experiment(choice.scene);
  const auto reference = extrapolated_reference(experiment, 10);
  const Section time = choice.scene.section("time", "");
  std::string name = time.text("method", "");
  const std::string composition = time.has("composition") ? time.text("composition", "") : "";
  if (name == "moser-veselov") name += "/" + std::to_string(time.integer("order", 2, 10));
  if (!composition.empty() && composition != "single") name += "/" + composition;
  if (time.has("tolerance")) {
    Method by_tolerance = method_named(experiment.methods, name + "/1e-9");
    by_tolerance.settings.back() = "time.tolerance=" + std::to_string(time.number("tolerance") * 1e15) + "e-15";
    return measure_once(experiment, by_tolerance, experiment.step, reference.get(), 100).trajectory;
  }
  return measure_once(experiment, method_named(experiment.methods, name), experiment.step, reference.get(), 100)
      .trajectory;
}

TEST(Accuracy, IsReached) {
  for (const double target : {1e-3, 1e-6, 1e-9}) {
    const std::vector<std::string> goal{"accuracy.target=" + std::to_string(target * 1e9) + "e-9"};
    EXPECT_LT(error_reached(orbit(goal)), target) << "kepler " << target;
    EXPECT_LT(error_reached(example("rigid_body", goal)), target) << "rigid body " << target;
    EXPECT_LT(error_reached(example("spherical_pendulum", goal)), target) << "spherical pendulum " << target;
  }
  // Long ones, whose coarse runs go far astray: errors are relative to the true motion all the same.
  EXPECT_LT(error_reached(example("kepler", {"accuracy.target=1e-4"})), 1e-4);
  EXPECT_LT(error_reached(example("spring_pendulum", {"accuracy.target=1e-5"})), 1e-5);
  EXPECT_LT(error_reached(example("driven_pendulum", {"accuracy.target=1e-5"})), 1e-5);
}

TEST(Accuracy, IsPredictedForLongMotions) {
  // A pilot of hundredths of a second cannot follow all of it; where the machine does something else just then, it
  // finds nothing, and is asked again.
  const Section scene =
      orbit({"accuracy.target=1e-4", "accuracy.pilot=0.02", "time.duration=3000", "time.steps=100000"});
  std::optional<double> error;
  for (int attempt = 0; attempt < 20 && !error; ++attempt) try {
      error = error_reached(scene);
    } catch (const SceneError&) {
    }
  ASSERT_TRUE(error.has_value());
  EXPECT_LT(*error, 1e-3);
}

TEST(Accuracy, RefusesWhatItCannotMean) {
  EXPECT_THROW(choose_by_accuracy(orbit({"accuracy.target=1e-6", "time.method=splitting"})), SceneError);
  EXPECT_THROW(choose_by_accuracy(orbit({"accuracy.target=-1"})), SceneError);
  EXPECT_THROW(choose_by_accuracy(orbit({"accuracy.target=1e-6", "accuracy.metods=x"})), SceneError);
  EXPECT_THROW(choose_by_accuracy(orbit({"accuracy.target=1e-6", "accuracy.methods=nystrom"})), SceneError);
  EXPECT_THROW(choose_by_accuracy(orbit({"accuracy.target=1e-6", "accuracy.methods=runge-kutta"})), SceneError);
  // A chain that has long been chaotic.
  EXPECT_THROW(choose_by_accuracy(example("chain_drop", {"accuracy.target=1e-6", "accuracy.pilot=1"})), SceneError);
}

class Study : public CommandLine {
 protected:
  std::string scene() const {
    const fs::path file = folder_ / "orbit.toml";
    std::ofstream(file) << orbit().whole();
    return file.string();
  }
};

TEST_F(Study, WritesItsPage) {
  const fs::path out = folder_ / "out";
  const Outcome r = run("study " + scene() +
                        " --methods 'splitting,splitting/nystrom-6,runge-kutta,variational' --steps 0.2:0.01:4 "
                        "--repetitions 2 --json --out " +
                        out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json.at("runs").size(), 16u);
  EXPECT_FALSE(json.at("recommendation").empty());
  EXPECT_FALSE(json.at("machine").get<std::string>().empty());
  for (const char* file : {"study.csv", "study.json", "study.gp", "study.md", "study.html", "study.svg", "study.png"})
    EXPECT_GT(fs::file_size(out / file), 500u) << file;
  std::ifstream page(out / "study.html");
  const std::string html{std::istreambuf_iterator<char>(page), {}};
  EXPECT_NE(html.find("<svg"), std::string::npos);
  EXPECT_NE(html.find("nystrom-6"), std::string::npos);
  // Its reference serves a later one.
  const Outcome again =
      run("study " + scene() + " --methods splitting --steps 0.1 --repetitions 1 --json --reference " +
          (out / "study.json").string());
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out).at("runs").at(0).at("status"), "converged");
  const Outcome other =
      run("study " + std::string(LAGROID_EXAMPLES) + "/pendulum.toml --reference " + (out / "study.json").string());
  EXPECT_EQ(other.code, 2);
}

/// The example as it stands, 62832 steps by 26 methods, in the time that it is given.
TEST_F(Study, KeepsItsBudgetAndSaysWhatItLeftOut) {
  const fs::path out = folder_ / "out";
  const auto start = std::chrono::steady_clock::now();
  const Outcome r = run("study " + CommandLine::example("kepler") + " --budget 10 --out " + out.string());
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_LT(took, 40);
  const std::string first = r.out.substr(0, r.out.find('\n'));
  EXPECT_NE(first.find("within 10 s (--budget)"), std::string::npos) << first;
  const auto json = nlohmann::json::parse(std::ifstream(out / "study.json"));
  EXPECT_EQ(json.at("budget"), 10);
  ASSERT_FALSE(json.at("not_measured").empty());
  const std::string left_out = json.at("not_measured").at(0).at("method");
  for (const char* file : {"study.md", "study.html"}) {
    std::ifstream in(out / file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(text.find("ot measured: " + left_out), std::string::npos) << file;
    EXPECT_NE(text.find("the budget was 10 s"), std::string::npos) << file;
  }
  EXPECT_NE(json.at("recommendation").at(0).get<std::string>().find("use "), std::string::npos);
  // No two methods are drawn alike, and the cheapest strongly.
  std::ifstream script(out / "study.gp");
  std::map<std::string, std::string> legend;
  for (std::string line; std::getline(script, line);) {
    if (!line.starts_with("plot [0:1]")) continue;
    static const std::regex entry("NaN with linespoints ([^,]*) title '([^']*)'");
    for (std::sregex_iterator at(line.begin(), line.end(), entry), end; at != end; ++at) legend[(*at)[2]] = (*at)[1];
  }
  std::set<std::string> methods, styles;
  for (const auto& run : json.at("runs")) methods.insert(run.at("method").get<std::string>());
  for (const auto& [method, style] : legend) styles.insert(style);
  EXPECT_EQ(legend.size(), methods.size());
  EXPECT_EQ(styles.size(), methods.size());
  for (const auto& level : json.at("least_time").at("trajectory"))
    EXPECT_NE(legend.at(level.at("method")).find("linewidth 2.2"), std::string::npos) << level;
}

TEST_F(Study, ListsMethods) {
  const Outcome r = run("study " + scene() + " --list");
  EXPECT_EQ(r.code, 0);
  EXPECT_NE(r.out.find("splitting/nystrom-6"), std::string::npos);
  EXPECT_NE(r.out.find("composition = \"nystrom-6\""), std::string::npos);
}

TEST_F(Study, RefusesMistakesInOneLine) {
  for (const char* bad :
       {"--methods nystrom", "--steps 0", "--steps 0.1,x", "--steps 1:0.1:1", "--steps 100", "--reference nowhere.json",
        "--reference splitting@0", "--reference euler@0.1", "--reference @0.1", "--reference controlled@0.1",
        "--reference /tmp", "--target 2", "--target nan", "--out /proc/no/where", "--set time.stps=3",
        "--set accuracy.target=1e-6 --set accuracy.metods=x"})
    expect_refused("study " + scene() + " " + bad);
}

TEST_F(Study, ASceneWithATargetIsRunAndResumed) {
  const fs::path out = folder_ / "run";
  const Outcome r = run("run " + scene() + " --set accuracy.target=1e-6 --json --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  ASSERT_GE(json.at("notes").size(), 3u);
  EXPECT_NE(json.at("notes").at(0).get<std::string>().find("accuracy: for an error of 1e-06"), std::string::npos);
  EXPECT_NE(json.at("notes").at(1).get<std::string>().find("ten times better"), std::string::npos);
  const long steps = json.at("steps");
  const Outcome on = run("resume " + out.string() + " --json --set time.steps=" + std::to_string(steps + 7));
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_EQ(nlohmann::json::parse(on.out).at("steps"), steps + 7);
}

}  // namespace
}  // namespace run_study_tests
