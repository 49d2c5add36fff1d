// The same chain by a scene, by hand and by MuJoCo: what accuracy costs.
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include "../cases/chain_case.hpp"
#include "../report/comparison.hpp"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace bench {

namespace {

using lagroid::multibody::Multibody;
using lagroid::multibody::Vec;

constexpr int links = 20;
constexpr double horizon = 1;  // s

/// The chain as MuJoCo knows chains: bodies in one another, each with a ball joint at its upper end and a small ball at
/// its lower one. A body without extent is none to it; this extent changes the motion by parts in 10^8.
std::string model(const std::string& integrator, double step) {
  std::string out = fmt::format(
      "<mujoco><option timestep='{:.17g}' gravity='0 0 {:.17g}' integrator='{}' iterations='1'>"
      "<flag contact='disable'/></option><worldbody>",
      step, -gravity, integrator);
  Vec parent = Vec::Zero();
  Vec joint = Vec::Zero();
  for (const Vec& place : wound_chain(links)) {
    const Vec at = joint - parent;
    const Vec bob = place - joint;
    out += fmt::format(
        "<body pos='{:.17g} {:.17g} {:.17g}'><joint type='ball'/><inertial pos='{:.17g} {:.17g} {:.17g}' "
        "mass='{:.17g}' diaginertia='1e-12 1e-12 1e-12'/>",
        at(0), at(1), at(2), bob(0), bob(1), bob(2), 1.0 / links);
    parent = joint;
    joint = place;
  }
  for (int i = 0; i < links; ++i) out += "</body>";
  return out + "</worldbody></mujoco>";
}

using Model = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
using Data = std::unique_ptr<mjData, decltype(&mj_deleteData)>;

Model load(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "chain.xml", int(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[1000] = "";
  Model loaded(mj_loadXML("chain.xml", files.get(), error, sizeof error), mj_deleteModel);
  mj_deleteVFS(files.get());
  if (!loaded) throw std::runtime_error(fmt::format("MuJoCo: {}", error));
  return loaded;
}

struct Run {
  Vec tip = Vec::Zero();
  double seconds = 0;  ///< the least of three runs; of those over 0.3 s of one
};

/// `begin` returns what runs the steps and returns the tip.
Run timed_run(const std::function<std::function<Vec()>()>& begin) {
  Run run;
  run.seconds = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3 && !(k > 0 && run.seconds > 0.3); ++k) {
    const auto tip_at_end = begin();
    const auto start = std::chrono::steady_clock::now();
    run.tip = tip_at_end();
    run.seconds =
        std::min(run.seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return run;
}

Run by_scene(int steps) {
  return timed_run([steps]() -> std::function<Vec()> {
    const std::shared_ptr<Multibody> scene = hanging_chain(links, horizon / steps);
    return [scene, steps] {
      for (int k = 0; k < steps; ++k)
        if (!scene->advance().converged()) return Vec(Vec::Constant(std::nan("")));
      return scene->configuration().x[links - 1];
    };
  });
}

Run by_hand(int steps) {
  return timed_run([steps]() -> std::function<Vec()> {
    const auto kernel = std::make_shared<kernels::SphericalChain>(chain_kernel(links, horizon / steps));
    return [kernel, steps] {
      for (int k = 0; k < steps; ++k)
        if (!kernel->step()) return Vec(Vec::Constant(std::nan("")));
      return kernel->places().back().vector();
    };
  });
}

Run by_mujoco(const std::string& integrator, int steps) {
  const std::shared_ptr<mjModel> loaded = load(model(integrator, horizon / steps));
  return timed_run([=]() -> std::function<Vec()> {
    const std::shared_ptr<mjData> data = Data(mj_makeData(loaded.get()), mj_deleteData);
    mj_forward(loaded.get(), data.get());
    return [=] {
      for (int k = 0; k < steps; ++k) mj_step(loaded.get(), data.get());
      mj_forward(loaded.get(), data.get());
      return Vec(Eigen::Map<const Vec>(data->xipos + 3 * links));
    };
  });
}

}  // namespace

std::string chain_accuracy_table() {
  // Of order 2: two steps extrapolated to order 4.
  constexpr int fine = 64000;
  const Vec reference = (4 * by_scene(2 * fine).tip - by_scene(fine).tip) / 3;
  struct Method {
    std::string name;
    std::function<Run(int)> run;
    int first;
    int refinements;
  };
  const std::vector<Method> methods{
      {"scene", by_scene, 100, 6},
      {"by hand", by_hand, 100, 6},
      {"MuJoCo, Euler", [](int n) { return by_mujoco("Euler", n); }, 4000, 4},
      {"MuJoCo, implicit", [](int n) { return by_mujoco("implicit", n); }, 4000, 3},
      {"MuJoCo, RK4", [](int n) { return by_mujoco("RK4", n); }, 50, 6},
  };
  // The cost of an error of a thousandth of the chain, on the line through the two runs beside it (in logarithms).
  constexpr double wanted = 1e-3;
  std::string runs = "| method | steps | error of the tip, m | seconds |\n|---|---|---|---|\n";
  std::string costs =
      fmt::format("| method | ms for an error of {:g} m | over the scene's | us a step |\n|---|---|---|---|\n", wanted);
  double scene_cost = 0;
  for (const Method& method : methods) {
    std::vector<std::pair<double, double>> points;
    double per_step = 0;
    int steps = method.first;
    for (int k = 0; k < method.refinements; ++k, steps *= 2) {
      const Run run = method.run(steps);
      const double error = (run.tip - reference).norm();
      per_step = run.seconds / steps;
      runs += fmt::format("| {} | {} | {:.2g} | {:.3g} |\n", method.name, steps, error, run.seconds);
      if (std::isfinite(error)) points.emplace_back(std::log(error), std::log(run.seconds));
    }
    std::size_t i = 1;
    while (i + 1 < points.size() && points[i].first > std::log(wanted)) ++i;
    const auto [e0, s0] = points[i - 1];
    const auto [e1, s1] = points[i];
    const double cost = std::exp(s0 + (s1 - s0) * (std::log(wanted) - e0) / (e1 - e0));
    if (scene_cost == 0) scene_cost = cost;
    costs +=
        fmt::format("| {} | {:.3g} | {:.3g} | {:.3g} |\n", method.name, 1e3 * cost, cost / scene_cost, 1e6 * per_step);
  }
  return costs + "\n" + runs;
}

}  // namespace bench
