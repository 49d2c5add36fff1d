#include "../../reading/kinds.hpp"
#include "../problems/problems.hpp"
#include "../scene_loop.hpp"
#include "bodies_keys.hpp"
#include "bodies_laws.hpp"

#include <lagroid/solvers/processor_time.hpp>
#include <lagroid/systems/multibody/control/ipopt/scene_chart.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace lagroid::app {

namespace {

using multibody::ControlledNode;
using multibody::ControlledScene;
using multibody::SceneSearch;
using multibody::SceneSolution;
using multibody::Vec;

/// The scene, or why it is none, in one line.
ControlledScene controlled(const Section& scene, const BodiesControl& read) {
  try {
    return ControlledScene(read.task);
  } catch (const std::logic_error& error) {
    scene.fail("", error.what());
  }
}

multibody::SceneSolver solver_of(const BodiesControl& read) {
  if (read.method == ControlMethod::ipopt) return multibody::solve_scene_by_ipopt;
  return multibody::solve_scene;
}

const SceneSolution& best_of(const SceneSearch& found) {
  return found.minima.empty() ? found.best_failure : found.minima.front();
}

/// What is seen of bodies at a node: places, rotation vectors, velocities, and angular ones in the bodies.
class Seen {
 public:
  Seen(ControlledScene& scene, const std::vector<NamedBody>& bodies) : scene_(scene), bodies_(bodies) {}

  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const NamedBody& body : bodies_) {
      const auto add = [&](std::initializer_list<const char*> of) {
        for (const char* each : of) out.push_back(fmt::format("{}.{}", body.name, each));
      };
      if (body.planar) add({"x", "y", "angle", "vx", "vy", "rate"});
      if (!body.planar && body.linear >= 0) add({"x", "y", "z", "vx", "vy", "vz"});
      if (body.body.attitude.index >= 0) add({"rx", "ry", "rz", "wx", "wy", "wz"});
    }
    return out;
  }
  std::vector<double> row(const ControlledNode& node) {
    std::vector<double> out;
    const std::vector<double> velocities = scene_.velocities(node);
    const auto add = [&](const Vec& place, int factor) {
      out.insert(out.end(), place.data(), place.data() + 3);
      out.insert(out.end(), velocities.begin() + 3 * factor, velocities.begin() + 3 * factor + 3);
    };
    for (const NamedBody& body : bodies_) {
      if (body.linear >= 0) {
        const int f = scene_.motion().linear_place(body.linear);
        add(node.places[std::size_t(f)], f);
      }
      if (body.body.attitude.index >= 0) {
        const int r = scene_.motion()(body.body.attitude).index;
        add(SO3::log(node.attitudes[std::size_t(r)]), scene_.linear() + r);
      }
    }
    return out;
  }

 private:
  ControlledScene& scene_;
  const std::vector<NamedBody>& bodies_;
};

std::string groupoid_of(const std::vector<NamedBody>& bodies) {
  std::vector<std::string> parts;
  const auto count = [&](const char* name, const auto& holds) {
    const auto times = std::count_if(bodies.begin(), bodies.end(), holds);
    if (times > 0) parts.push_back(times == 1 ? name : fmt::format("({})^{}", name, times));
  };
  count("Pair(R^2) x Pair(S^1)", [](const NamedBody& body) { return body.planar; });
  count("Pair(R^3)", [](const NamedBody& body) { return !body.planar && body.linear >= 0; });
  count("SO(3) on SO(3)", [](const NamedBody& body) { return body.body.attitude.index >= 0; });
  return fmt::format("{}", fmt::join(parts, " x "));
}

std::vector<std::vector<double>> rows_of(const StageRows& of, long stages) {
  std::vector<std::vector<double>> out;
  for (long k = 0; k < stages; ++k) out.emplace_back(of[k], of[k] + of.length());
  return out;
}

class ControlledBodies final : public ControlProblem {
 public:
  std::string_view name() const override { return "bodies"; }
  std::string_view summary() const override {
    return "a scene of bodies, moved by effects whose strengths are controls";
  }
  std::vector<std::string> states() const override { return {"places, attitudes and velocities of its bodies"}; }
  std::vector<std::string> controls() const override { return {"the effects that [[actuator]] names"}; }
  std::vector<Key> parameters() const override { return {}; }

  ControlResult solve(const Section& text, const std::function<bool(int)>& keep_going) const override {
    const BodiesControl read = read_controlled_bodies(text);
    ControlledScene scene = controlled(text, read);
    const double before = processor_time();
    const SceneSearch found = search_scene(scene, read.search, keep_going, solver_of(read));
    const SceneSolution& best = best_of(found);
    Seen seen(scene, read.bodies);
    ControlResult out;
    out.problem = name();
    out.groupoid = groupoid_of(read.bodies);
    out.states = seen.names();
    const long stages = best.path.stages();
    for (long k = 0; k <= stages; ++k) {
      out.times.push_back(double(k) * best.path.step);
      out.state_rows.push_back(seen.row(best.path.nodes[std::size_t(k)]));
    }
    for (const multibody::Actuator& each : read.task.actuators) {
      out.controls.push_back(each.effect);
      out.lower.push_back(each.lower);
      out.upper.push_back(each.upper);
    }
    for (long k = 0; k < stages; ++k)
      out.control_rows.emplace_back(best.path.controls[k], best.path.controls[k] + scene.actuators());
    out.costate_rows = rows_of(best.costates, stages);
    out.inequality_rows = rows_of(best.inequality_multipliers, stages);
    out.by_ipopt = read.method == ControlMethod::ipopt;
    out.equations = 2 * scene.n();
    out.report = best.report;
    out.crossover = best.crossover;
    out.outcomes = found.outcomes;
    out.iterations = found.iterations;
    for (const SceneSolution& each : found.minima) out.costs.push_back(each.report.cost);
    out.seconds = processor_time() - before;
    return out;
  }

  Certificate certify(const Section& text, int samples, std::uint64_t seed) const override {
    BodiesControl read = read_controlled_bodies(text);
    ControlledScene scene = controlled(text, read);
    Certificate out = certificate_of(scene, read.search, solver_of(read), samples, seed);
    out.system = name();
    out.groupoid = groupoid_of(read.bodies);
    return out;
  }

  std::unique_ptr<SceneLoop> loop(const Section& scene, const std::function<bool(int)>&) const override {
    scene.fail(std::string(keys::control),
               "a loop is of a problem that lagroid control --list names by its state, not of bodies");
  }
};

}  // namespace

const ControlProblem& controlled_bodies() {
  static const ControlledBodies problem;
  return problem;
}

}  // namespace lagroid::app
