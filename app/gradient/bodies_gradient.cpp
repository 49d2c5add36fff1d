// The subject of `lagroid gradient` and `lagroid fit`, of scenes of bodies.

#include "../bodies/scene_bodies.hpp"
#include "../bodies/scene_numbers.hpp"
#include "../bodies/scene_picture.hpp"
#include "../bodies/scene_run.hpp"
#include "../reading/kinds.hpp"
#include "event_gradient.hpp"
#include "system_gradients.hpp"

#include <lagroid/run/events/derivatives/motion_through_events.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_controlled_scene.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace lagroid::app {

namespace {

using multibody::LinearisedControlledScene;
using multibody::LinearisedScene;
using multibody::Multibody;
using multibody::ObservedScene;
using V = VariedNumber;
using VariedBodies = BasicSceneBodies<V>;

/// What is observed, by groups, in the order and by the names of the columns that runs record:
/// group(name, labels(), values(node)), of which one is asked for at every node, and the other once.
template <class Group> void each_group(const BasicNamedBody<V>& b, const Group& group) {
  const auto of_body = [&](const char* name, std::initializer_list<std::string_view> labels, const auto& values) {
    group(
        name, [&] { return columns(b.name, labels); }, values);
  };
  const multibody::Attitude a = b.body.attitude;
  of_body("position", {"x", "y", "z"},
          [&](const ObservedScene& n) -> const multibody::VariedVec& { return n(b.body.centre); });
  if (a.index >= 0) {
    const auto spin = [&](const ObservedScene& n) -> const multibody::VariedVec& { return n.spin_of(a); };
    group(
        "attitude", [&] { return attitude_of(b.name); },
        [&](const ObservedScene& n) -> const Vector<V, 4>& { return n.quaternion(a); });
    of_body("spin", {"M1", "M2", "M3"}, spin);
    of_body("angular_velocity", {"w1", "w2", "w3"}, [&](const ObservedScene& n) -> multibody::VariedVec {
      return spin(n).cwiseQuotient(n.model.factors.moments[std::size_t(n.model.places(a).index)]);
    });
  }
  if (b.linear < 0) return;
  const auto momentum = [&](const ObservedScene& n) -> const multibody::VariedVec& { return n.momentum_of(b.linear); };
  if (!b.planar) {
    of_body("momentum", {"px", "py", "pz"}, momentum);
    return;
  }
  const auto place = [&](const ObservedScene& n) { return std::size_t(n.model.linear_places[std::size_t(b.linear)]); };
  of_body("angle", {"angle"}, [&](const ObservedScene& n) { return Vector<V, 1>(n.at.x[place(n)](2)); });
  of_body("momentum", {"px", "py", "L"}, momentum);
  of_body("angular_velocity", {"w"},
          [&](const ObservedScene& n) { return Vector<V, 1>(momentum(n)(2) / n.model.factors.inertia[place(n)](2)); });
}

std::vector<GradientName> names_of_observed(const VariedBodies& bodies, bool timed) {
  std::vector<GradientName> out;
  for (const BasicNamedBody<V>& b : bodies.bodies)
    each_group(b, [&](const char* name, const auto& labels, const auto&) {
      for (const std::string& label : labels()) out.push_back({name, label});
    });
  out.push_back({"energy", "energy"});
  if (timed) out.push_back({"time", "t"});
  return out;
}

/// Of steps that vary with the time.
multibody::VariedNumbers observed(const VariedBodies& bodies, const ObservedScene& node, bool timed) {
  std::vector<V> out;
  for (const BasicNamedBody<V>& b : bodies.bodies)
    each_group(b, [&](const char*, const auto&, const auto& values) {
      const auto& all = values(node);
      out.insert(out.end(), all.data(), all.data() + all.size());
    });
  out.push_back(node.kinetic + node.potential);
  if (timed) out.push_back(node.at.time);
  return Eigen::Map<const multibody::VariedNumbers>(out.data(), Eigen::Index(out.size()));
}

/// A scene as a function of numbers in it.
multibody::WriteScene write_with(const Section& scene, const std::vector<SceneNumber>& numbers, bool timed = false) {
  return [scene, numbers, timed](const std::vector<V>& x) {
    std::vector<VariedAt> varied;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!multibody::stays_zero(x[i] - x[i].value))
        for (VariedAt& each : numbers[i].varied(x[i])) varied.push_back(std::move(each));
    const auto bodies = std::make_shared<VariedBodies>(read_varied_scene(scene, varied));
    return multibody::WrittenScene{std::move(bodies->scene),
                                   [=](const ObservedScene& node) { return observed(*bodies, node, timed); },
                                   bodies->projects};
  };
}

std::vector<double> values_of(const std::vector<SceneNumber>& numbers) {
  std::vector<double> out;
  for (const SceneNumber& number : numbers) out.push_back(number.value);
  return out;
}

/// Directions of the start, in the order of the motion's states: where bodies are and how they are turned, and momenta.
void name_start(const Multibody& motion, const VariedBodies& bodies, GradientSubject& out) {
  const multibody::SceneState& state = motion.state();
  const std::size_t linear = state.momentum.size(), n = 3 * (linear + state.spin.size());
  out.start.resize(2 * n);
  out.sizes.assign(2 * n, 0.0);
  const auto name = [&](std::size_t at, const char* group, const std::vector<std::string>& labels,
                        const multibody::Vec& sizes) {
    for (std::size_t i = 0; i < 3; ++i) {
      out.start[at + i] = {group, labels[i]};
      out.sizes[at + i] = sizes(Eigen::Index(i));
    }
  };
  for (const BasicNamedBody<V>& b : bodies.bodies) {
    if (b.linear >= 0) {
      const auto f = std::size_t(motion.linear_place(b.linear));
      name(3 * f, "position", columns(b.name, {"x", "y", b.planar ? "angle" : "z"}), state.at.x[f]);
      name(n + 3 * f, "momentum", columns(b.name, {"px", "py", b.planar ? "L" : "pz"}), state.momentum[f]);
    }
    if (b.body.attitude.index >= 0) {
      const auto r = std::size_t(motion(b.body.attitude).index);
      name(3 * (linear + r), "turn", columns(b.name, {"turn1", "turn2", "turn3"}), multibody::Vec::Ones());
      name(n + 3 * (linear + r), "spin", columns(b.name, {"M1", "M2", "M3"}), state.spin[r]);
    }
  }
}

/// Where among all momenta the first of each three numbers of a body's kick is.
std::vector<Eigen::Index> places_of_kick(const std::string& body, const Multibody& motion, const VariedBodies& bodies) {
  std::vector<Eigen::Index> out;
  for (const BasicNamedBody<V>& b : bodies.bodies) {
    if (b.name != body) continue;
    if (b.linear >= 0) out.push_back(3 * Eigen::Index(motion.linear_place(b.linear)));
    if (b.body.attitude.index >= 0)
      out.push_back(3 * Eigen::Index(motion.state().momentum.size() + std::size_t(motion(b.body.attitude).index)));
  }
  return out;
}

/// The events of a scene, of the time and of what is observed. Throws std::invalid_argument for one that has no
/// derivative.
std::vector<ObservedEvent> observed_events(const std::vector<Event>& events, const std::vector<GradientName>& observed,
                                           const Multibody& motion, const VariedBodies& bodies) {
  const auto momenta = Eigen::Index(3 * (motion.state().momentum.size() + motion.state().spin.size()));
  std::vector<ObservedEvent> out;
  for (const Event& event : events) {
    const auto texts = std::make_shared<EventExpressions>(event, observed, int(event.kick.size()));
    ObservedEvent smooth = observed_event(event, texts);
    if (!event.kick.empty())
      smooth.kick = [texts, momenta, places = places_of_kick(event.body, motion, bodies)](const VariedVector& seen) {
        VariedVector by = VariedVector::Constant(momenta, V(0));
        for (std::size_t k = 0; k < texts->kick.size(); ++k)
          by(places[k / 3] + Eigen::Index(k % 3)) = texts->kick[k](seen);
        return by;
      };
    for (const std::string& name : event.switch_on) smooth.switches.emplace_back(name, true);
    for (const std::string& name : event.switch_off) smooth.switches.emplace_back(name, false);
    out.push_back(std::move(smooth));
  }
  return out;
}

/// Why there is no derivative by these numbers, changed together: scenes with a little more and with a little less of
/// them are none, or joints that hold would not. Empty where there is one.
std::string why_not_changed(const Section& scene, const std::vector<SceneNumber>& numbers,
                            const std::function<Multibody(const Section&)>& begun) {
  std::vector<std::string> names;
  for (const SceneNumber& number : numbers) names.push_back(number.name);
  std::string why;
  for (const double share : {1e-3, -1e-3}) {
    std::vector<SceneNumber> others = numbers;
    for (SceneNumber& other : others) other.value += share * (other.value == 0 ? 1 : other.value);
    try {
      begun(scene_with(scene, others));
      LinearisedScene first(begun(scene), names, values_of(numbers), write_with(scene, numbers));
      if (first.advance().converged()) first.linearise();
      return "";
    } catch (const WithoutDerivative& refusal) {
      return refusal.what();
    } catch (const SceneError& error) {
      why = fmt::format(
          "a scene with another one is refused ({}); what follows from the start, as a length that is "
          "not given, changes with it",
          error.problem());
    }
  }
  return why;
}

/// All that a scene of bodies may be differentiated by, each with a name of its own: what has that of another before it
/// is called by where it stands.
std::vector<SceneNumber> offered_numbers(const Section& scene) {
  std::vector<SceneNumber> out = numbers_to_differentiate(scene);
  for (SceneNumber& number : places_of_joints(scene, read_scene_bodies(scene))) out.push_back(std::move(number));
  std::set<std::string> names;
  for (SceneNumber& number : out)
    if (!names.insert(number.name).second && !number.path.empty()) names.insert(number.name = number.path);
  return out;
}

/// Asks of many at once which have a derivative, of those that do not bear upon each other: masses and inertias, which
/// no joint reads, and places of joints, by each of which both points move.
void ask_for_derivatives(const Section& scene, const std::function<Multibody(const Section&)>& begun,
                         GradientSubject& out, std::vector<SceneNumber>& numbers) {
  const std::vector<SceneNumber> offered = offered_numbers(scene);
  const auto is_place = [](const SceneNumber& number) { return !number.shared.empty(); };
  const auto is_mass = [](const SceneNumber& number) {
    return number.path.starts_with("body.") &&
           (number.path.ends_with(".mass") || number.path.find(".inertia") != std::string::npos);
  };
  const auto all_have = [&](const auto& are_meant) {
    std::vector<SceneNumber> some;
    std::copy_if(offered.begin(), offered.end(), std::back_inserter(some), are_meant);
    return !some.empty() && why_not_changed(scene, some, begun).empty();
  };
  const bool masses = all_have(is_mass), places = all_have(is_place);
  const auto has_place = [&](const SceneNumber& number) {
    const std::string joint = number.name.substr(0, number.name.find(".points."));
    return joint.size() < number.name.size() &&
           std::any_of(offered.begin(), offered.end(),
                       [&](const SceneNumber& each) { return each.name == joint + ".place.0"; });
  };
  for (const SceneNumber& number : offered) {
    const bool is_known = (masses && is_mass(number)) || (places && is_place(number));
    if (std::string why = is_known ? "" : why_not_changed(scene, {number}, begun); !why.empty()) {
      if (has_place(number)) why += ", and by NAME.place both points of a joint move";
      out.refused.emplace_back("parameters." + number.name, std::move(why));
      continue;
    }
    numbers.push_back(number);
    out.parameters.push_back({"parameters", number.name});
    out.sizes.push_back(number.value);
  }
}

}  // namespace

std::optional<GradientSubject> bodies_gradient(const Section& given) {
  if (!given.has(keys::bodies)) return std::nullopt;
  const BodiesScene read = read_bodies(given, {});
  const Section scene = with_constants(given);
  if (read.options.tolerance > 0)
    given.section("solver", "")
        .fail("tolerance", "derivatives are of steps that are solved to round-off; leave it out");
  const bool controlled = read.options.controlled;
  if (controlled && !read.extent.events.empty())
    given.fail("event",
               "of scenes of bodies there are no derivatives through events by controlled steps; leave out the "
               "events, or time.mode");
  const double step = read.to_check.step;
  const auto begun = [step, options = read.options](const Section& of) { return begin_bodies(of, step, options); };
  const auto begun_singly = [step, options = read.options](const Section& of) {
    multibody::Options single = options;
    single.composition = compositions::single;
    single.controlled = false;
    return begin_bodies(of, step, single);
  };
  const auto stages = [begun_singly, shares = read.options.composition.coefficients](
                          const Section& of) -> std::optional<LinearisedScene::Stages> {
    if (shares.size() <= 1) return std::nullopt;
    return LinearisedScene::Stages{begun_singly(of), {shares.begin(), shares.end()}};
  };
  const Multibody motion = begun(scene);
  GradientSubject out;
  out.system = read.to_check.name;
  out.steps = read.extent.steps;
  const VariedBodies bodies = read_varied_scene(scene, {});
  out.observed = names_of_observed(bodies, controlled);
  name_start(motion, bodies, out);
  std::vector<SceneNumber> numbers;
  ask_for_derivatives(scene, begun_singly, out, numbers);
  const bool tied = motion.rows() > 0;
  if (tied)
    out.notes.emplace_back(
        "derivatives by the start are along what the joints allow of a displacement and of a momentum");
  /// made(motion, names, numbers, write, scene): the motion of the scene that differs, linearised.
  const auto begun_with = [scene, numbers, begun](const std::vector<std::string>& parameters,
                                                  const std::vector<Nudge>& nudges, const auto& made) {
    const auto named = [&](const std::string& name) {
      SceneNumber number =
          *std::find_if(numbers.begin(), numbers.end(), [&](const SceneNumber& n) { return n.name == name; });
      for (const Nudge& nudge : nudges)
        if (nudge.parameter == name) number.value += nudge.by;
      return number;
    };
    std::vector<SceneNumber> changes, chosen;
    for (const Nudge& nudge : nudges)
      if (!nudge.parameter.empty()) changes.push_back(named(nudge.parameter));
    for (const std::string& name : parameters) chosen.push_back(named(name));
    const Section changed = scene_with(scene, changes);
    Multibody from = begun(changed);
    Eigen::VectorXd by =
        Eigen::VectorXd::Zero(Eigen::Index(6 * (from.state().momentum.size() + from.state().spin.size())));
    for (const Nudge& nudge : nudges)
      if (nudge.parameter.empty()) by(nudge.index) += nudge.by;
    if (!by.isZero(0)) displace(from, by);
    return made(std::move(from), chosen, changed);
  };
  const auto begin = [begun_with, stages](const std::vector<std::string>& parameters,
                                          const std::vector<Nudge>& nudges) {
    return begun_with(parameters, nudges,
                      [&](Multibody from, const std::vector<SceneNumber>& chosen, const Section& changed) {
                        return std::make_unique<LinearisedScene>(std::move(from), parameters, values_of(chosen),
                                                                 write_with(changed, chosen), stages(changed));
                      });
  };
  out.begin = begin;
  out.refusal = [begun_with](const std::vector<Nudge>& nudges) -> std::string {
    try {
      return begun_with(
          {}, nudges, [](const Multibody&, const std::vector<SceneNumber>&, const Section&) { return std::string(); });
    } catch (const SceneError& error) {
      return error.problem();
    } catch (const std::domain_error& error) {
      return error.what();
    }
  };
  if (controlled)
    out.begin = [begun_with](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      return begun_with(parameters, nudges,
                        [&](Multibody from, const std::vector<SceneNumber>& chosen, const Section& changed) {
                          return std::make_unique<LinearisedControlledScene>(
                              std::move(from), parameters, values_of(chosen), write_with(changed, chosen, true));
                        });
    };
  if (tied)
    out.begun_by = [begin](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      const Eigen::MatrixXd allowed = begin({}, nudges)->allowed_directions();
      // What numbers do to the start is part of the first step.
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(allowed.rows(), allowed.cols() + Eigen::Index(parameters.size()));
      all.leftCols(allowed.cols()) = allowed;
      return all;
    };
  if (read.extent.events.empty()) return out;
  require_events(read.extent.events, *read.motion);
  const std::vector<ObservedEvent> events = observed_events(read.extent.events, out.observed, motion, bodies);
  go_through_events(begin, events, out);
  return out;
}

}  // namespace lagroid::app
