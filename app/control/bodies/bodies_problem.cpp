#include "../../bodies/scene_picture.hpp"
#include "../../reading/kinds.hpp"
#include "../../scenes/arrow_format.hpp"
#include "../problems/problems.hpp"
#include "../scene_loop.hpp"
#include "bodies_keys.hpp"
#include "bodies_laws.hpp"

#include <lagroid/solvers/processor_time.hpp>
#include <lagroid/systems/multibody/control/ipopt/scene_chart.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

  void name(std::vector<std::string>& names, std::vector<std::string>& units) const {
    for (const NamedBody& body : bodies_) {
      const auto add = [&](std::initializer_list<const char*> of, const char* unit) {
        for (const char* each : of) {
          names.push_back(column(body.name, each));
          units.emplace_back(unit);
        }
      };
      if (body.planar) {
        add({"x", "y"}, "m");
        add({"angle"}, "rad");
        add({"vx", "vy"}, "m/s");
        add({"rate"}, "rad/s");
      } else if (body.linear >= 0) {
        add({"x", "y", "z"}, "m");
        add({"vx", "vy", "vz"}, "m/s");
      }
      if (body.body.attitude.index >= 0) {
        add({"rx", "ry", "rz"}, "rad");
        add({"wx", "wy", "wz"}, "rad/s");
      }
    }
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

/// Of the scene's factors, each momentum at both ends of an arrow.
std::vector<EquationName> equation_names(const ControlledScene& scene, const std::vector<NamedBody>& bodies) {
  std::vector<std::string> momenta(std::size_t(scene.n()));
  std::vector<std::string> units(momenta.size());
  const auto name = [&](int factor, const NamedBody& body, const std::array<const char*, 3>& of, bool is_planar,
                        const char* unit) {
    for (std::size_t i = 0; i < 3; ++i) {
      momenta[std::size_t(3 * factor) + i] = column(body.name, of[i]);
      units[std::size_t(3 * factor) + i] = is_planar && i == 2 ? "kg m^2/s" : unit;
    }
  };
  for (const NamedBody& body : bodies) {
    if (body.linear >= 0)
      name(scene.motion().linear_place(body.linear), body, {"px", "py", body.planar ? "L" : "pz"}, body.planar,
           "kg m/s");
    if (body.body.attitude.index >= 0)
      name(scene.linear() + scene.motion()(body.body.attitude).index, body, {"M1", "M2", "M3"}, false, "kg m^2/s");
  }
  std::vector<EquationName> out;
  add_momentum_equations(momenta, units, out);
  return out;
}

/// What the conditions on nodes say: joints at all, what is given at the last.
std::vector<std::vector<std::string>> conditions_of(const ControlledScene& scene, const BodiesControl& read) {
  std::vector<std::string> joints;
  for (int row = 0; row < scene.joints(); ++row) joints.push_back(fmt::format("row {} of the joints", row + 1));
  std::vector<std::string> all = joints;
  const auto add = [&](const std::vector<std::string>& words, int times) {
    for (const std::string& each : words)
      for (int i = 0; i < times; ++i) all.push_back(each + " as given at the end");
  };
  add(read.end.places, 1);
  add(read.end.turns, 3);
  add(read.end.velocities, 1);
  add(read.end.turnings, 1);
  std::vector<std::string> at_end;
  for (const int row : scene.end_rows()) at_end.push_back(all[std::size_t(row)]);
  std::vector<std::vector<std::string>> out(std::size_t(read.task.stages), joints);
  out.back() = std::move(at_end);
  return out;
}

std::vector<std::string> inequality_names(const ControlledScene& scene) {
  std::vector<std::string> out;
  for (int i = 0; i < scene.limits().size(); ++i) out.push_back(scene.limits().name(i));
  for (const multibody::Actuator& each : scene.task().actuators) {
    if (std::isfinite(each.upper)) out.push_back("upper bound of " + each.effect);
    if (std::isfinite(each.lower)) out.push_back("lower bound of " + each.effect);
  }
  return out;
}

/// What the bodies' shapes need beside their states: centres, attitudes as quaternions and the ends of lines.
std::vector<Columns> seen_of(ControlledScene& scene, const SceneBodies& bodies,
                             const std::vector<ControlledNode>& nodes) {
  std::vector<Columns> out;
  const auto add = [&](const std::string& name, std::vector<std::string> labels, const char* unit, const char* meaning,
                       const auto& row) {
    Columns& columns = out.emplace_back(Columns{name, std::move(labels), unit, meaning, false, {}});
    for (const ControlledNode& node : nodes) {
      const auto numbers = row(node);
      columns.values.insert(columns.values.end(), numbers.begin(), numbers.end());
    }
  };
  const auto add_point = [&](const std::string& name, multibody::Site site) {
    add(name + ".place", columns(name, {"x", "y", "z"}), "m", "position in space",
        [&scene, site](const ControlledNode& node) {
          const Vec place = scene.forces(node)(site);
          return std::array<double, 3>{place(0), place(1), place(2)};
        });
  };
  for (const NamedBody& body : bodies.bodies) {
    if (body.linear < 0) add_point(body.name, body.body.centre);
    if (body.planar)
      add(body.name + ".height", {column(body.name, "z")}, "m", "height, which it keeps",
          [z = body.place(2)](const ControlledNode&) { return std::array<double, 1>{z}; });
    if (body.body.attitude.index >= 0)
      add(body.name + ".attitude", attitude_of(body.name), "1",
          "rotation A from body to space, unit quaternion w, x, y, z",
          [&scene, a = body.body.attitude](const ControlledNode& node) {
            return quaternion_of(scene.forces(node)(a));
          });
  }
  for (std::size_t k = 0; k < bodies.lines.size(); ++k)
    for (const auto& [end, name] : {std::pair{&bodies.lines[k].from, "from"}, {&bodies.lines[k].to, "to"}})
      if (bodies.lines[k].switched_by != 0 || (end->body && !end->arm.isZero(0)))
        add_point(end_column(k, name), end->site);
  return out;
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
    seen.name(out.states, out.state_units);
    const long stages = best.path.stages();
    for (long k = 0; k <= stages; ++k) {
      out.times.push_back(double(k) * best.path.step);
      out.state_rows.push_back(seen.row(best.path.nodes[std::size_t(k)]));
    }
    for (const multibody::Actuator& each : read.task.actuators) {
      out.controls.push_back(each.effect);
      out.control_units.emplace_back("1");
      out.lower.push_back(each.lower);
      out.upper.push_back(each.upper);
    }
    for (long k = 0; k < stages; ++k)
      out.control_rows.emplace_back(best.path.controls[k], best.path.controls[k] + scene.actuators());
    out.costate_rows = rows_of(best.costates, stages);
    out.inequality_rows = rows_of(best.inequality_multipliers, stages);
    out.by_ipopt = read.method == ControlMethod::ipopt;
    out.equations = equation_names(scene, read.bodies);
    out.conditions = conditions_of(scene, read);
    out.inequalities = inequality_names(scene);
    const SceneBodies drawn = read_scene_bodies(text);
    out.shapes = shapes_of(drawn, {});
    out.seen = seen_of(scene, drawn, best.path.nodes);
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
