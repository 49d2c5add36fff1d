#include "scene_run.hpp"

#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"
#include "scene_bodies.hpp"
#include "scene_node.hpp"
#include "scene_numbers.hpp"
#include "scene_picture.hpp"

#include <lagroid/solvers/step/step_messages.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

using multibody::Multibody;
using multibody::Vec;

namespace {

const KeyOf<Text> name_of_scene{"name", {}, "", "what reports call the scene", "scene"};
const KeyOf<Whole> max_iterations{
    "max_iterations", {1, most_iterations}, "", "of a step", multibody::Options().max_iterations};
const KeyOf<Number> tolerance{"tolerance",
                              {{"between 0 and 0.001", [](double x) { return x >= 0 && x <= 1e-3; }}},
                              "",
                              solver_keys::tolerance.meaning,
                              0.0};

/// Joints are violated by less, over the sizes of their terms.
constexpr double joints_hold = 1e-8;

/// The words of [time] mode and method; the first are the defaults.
std::vector<std::string> modes() {
  return {std::string(mode_of_equal_steps), std::string(integration_method({.mode = TimeMode::controlled}).name)};
}
std::vector<std::string> methods() { return {std::string(integration_method(IntegratorOptions{}).name)}; }

/// [time] and [solver]: how the scene is stepped.
multibody::Options read_options(const Section& scene, const SceneBodies& bodies) {
  refuse_accuracy(scene);
  const Section solver = scene.section_or_empty("solver");
  multibody::Options options;
  options.max_iterations = int(read_key(solver, max_iterations));
  options.tolerance = read_key(solver, tolerance);
  const Section time = scene.section("time", "step and steps, or duration and steps");
  options.controlled = !read_bodies_method(time).equal_steps();
  if (options.controlled) refuse_duration(time);
  options.composition = read_composition(time, compositions::all);
  if (options.composition.stages() > 1 && (options.controlled || !is_composable(bodies)))
    time.fail(
        time.has("order") ? "order" : "composition",
        "above 2 goes with equal steps of scenes without damping, magnetic fields and turning frames, and without "
        "joints that hold velocities");
  return options;
}

/// The motion of the scene at its start. Refuses scenes that have none.
std::unique_ptr<Multibody> motion_of(const Section& scene, SceneBodies& bodies, double step,
                                     const multibody::Options& options) {
  if (const double damped = step * bodies.damping_rate; !(damped <= 2))
    scene.section("time", "")
        .fail("step", fmt::format("drag stops a body within less than half a step (drag over inertia times the step is "
                                  "{:.4g}): use a step below {:.3g}",
                                  damped, 2 / bodies.damping_rate));
  try {
    return std::make_unique<Multibody>(std::move(bodies.scene), step, options);
  } catch (const std::domain_error& error) {
    scene.fail("joint", fmt::format("{}, on bodies that joints tie together", error.what()));
  } catch (const std::invalid_argument& error) {
    if (options.controlled)
      scene.section("time", "")
          .fail("mode",
                "\"controlled\" needs a time scale: a scene with central_gravity or mutual_gravity, and "
                "without joints and other effects");
    scene.fail("", fmt::format("{}: a position, a length or a point is too large or too small", error.what()));
  }
}

/// The same, begun. Refuses starts that are none.
std::unique_ptr<Multibody> begin(const Section& scene, SceneBodies& bodies, double step,
                                 const multibody::Options& options) {
  std::unique_ptr<Multibody> motion = motion_of(scene, bodies, step, options);
  const double given = bodies.projects ? motion->given_kinetic_energy() : 0;
  if (bodies.projects) motion->make_tangent();
  if (const double defect = motion->velocity_defect(given); !(defect < joints_hold))
    scene.fail("", fmt::format("the velocities at the start do not agree with the joints (by a share {:.3g}); mend "
                               "them{}",
                               defect,
                               bodies.projects ? ": what the joints allow of them was not found"
                                               : ", or take what the joints allow of them with project_velocities = "
                                                 "true"));
  if (!std::isfinite(motion->kinetic_energy(motion->momenta()) + motion->potential_energy()))
    scene.fail("",
               "the energy at the start is no finite number: a velocity or a mass is too large, or bodies that act "
               "on each other meet");
  return motion;
}

MethodTraits traits_of(const SceneBodies& bodies, const multibody::Options& options) {
  const Composition& composition = options.composition;
  return {options.controlled         ? "controlled steps"
          : composition.stages() > 1 ? std::string(composition.name)
                                     : "steps of the discrete Lagrangian",
          composition.order, true, is_variational(bodies) && !options.controlled, false};
}

/// A scene's motion. Looking at a node costs about as much as a step.
class BodiesMotion final : public Motion {
 public:
  BodiesMotion(const Section& scene, std::string name, SceneBodies bodies, double step,
               const multibody::Options& options, std::set<std::string> chosen)
      : name_(std::move(name)),
        scene_(scene),
        step_(step),
        options_(options),
        bodies_(std::move(bodies)),
        chosen_(std::move(chosen)),
        controlled_(options.controlled),
        traits_(traits_of(bodies_, options)),
        motion_(begin(scene, bodies_, step, options)),
        node_(*motion_, bodies_, chosen_, controlled_) {
    if (motion_->dependent_rows() > 0)
      notes_.push_back(
          fmt::format("{} of {} equations of the joints depend on the others at the start; they hold because those do, "
                      "and are left out",
                      motion_->dependent_rows(), motion_->rows()));
    if (const double hardest = motion_->hardest_damper(); hardest > 1)
      notes_.push_back(fmt::format(
          "a damper is harder than the step resolves (damping times step over twice the inertia is {:.3g}): "
          "places follow the motion, momenta and energies alternate; use a step below {:.3g}",
          hardest, step / hardest));
  }

  bool has_time_scale() const { return motion_->has_time_scale(); }

  std::string name() const override { return name_; }
  MethodTraits traits() const override { return traits_; }

  StepReport advance() override {
    const StepReport report = motion_->advance();
    if (bodies_.counts_cost && report.converged()) cost_ += motion_->arrow_cost();
    return report;
  }
  std::string failure(const StepReport& report, long step) const override {
    if (!motion_->dependence_ended())
      return step_failure(report, step, time(), controlled_ ? TimeMode::controlled : TimeMode::fixed);
    return fmt::format(
        "step {} (from t = {:.6g}): equations of joints that depended on others at the start no longer do; the scene "
        "starts in a singular position (parts in line, a taut loop): start it elsewhere",
        step, time());
  }

  long index() const override { return motion_->index(); }
  double time() const override { return motion_->time(); }
  double step_size() const override { return motion_->step(); }
  const Observables& look() override {
    if (whole_) motion_->restore(*std::exchange(whole_, std::nullopt));
    node_.see(cost_);
    return node_;
  }
  std::string why_not_cut() const override { return ""; }
  void keep_node() override {
    kept_ = motion_->state();
    rest_.reset();
  }
  const Observables* look_within(double share) override {
    if (!go_within(share)) return nullptr;
    node_.see(cost_);
    return &node_;
  }
  Changeable changeable() const override {
    Changeable out;
    for (const NamedBody& body : bodies_.bodies)
      out.momenta.push_back(
          {body.name, (body.linear >= 0 ? 3u : 0u) + (body.body.attitude.index >= 0 ? std::size_t(3) : 0)});
    // Controlled steps are of a time scale of all that acts.
    if (controlled_) return out;
    for (const SceneNumber& number : numbers()) out.parameters.push_back(number.name);
    const multibody::Switches& switches = motion_->switches();
    for (std::size_t k = 1; k < switches.names.size(); ++k)
      out.switches.push_back({switches.names[k], switches.on[k] != 0});
    return out;
  }
  std::string refused(double share, const MotionChange& change) override {
    if (!go_within(share)) return "a part of the step does not converge; use a smaller time.step";
    if (!change.parameters.empty()) return refused_numbers(change);
    for (const Switched& each : change.switches)
      if (const double defect = motion_->violation(number_of(each)); each.on && !(defect < joints_hold))
        return fmt::format("\"{}\" is switched on where it does not hold: it is violated by a share {:.3g}", each.name,
                           defect);
    return "";
  }
  StepReport change_within(double share, const MotionChange& change) override {
    StepReport report;
    if (!go_within(share)) return report;
    if (!change.kick.empty()) kick(change.kick);
    if (!change.switches.empty()) motion_->switch_to(switched(change.switches));
    if (!change.parameters.empty()) set_numbers(changed_numbers(change.parameters));
    const multibody::SceneState end = *std::exchange(whole_, std::nullopt);
    const double rest = (1 - share) * std::exchange(whole_step_, 0.0);
    kept_ = motion_->state();
    kept_.index = end.index - 1;
    report.status = SolveStatus::converged;
    if (rest > 0) report = motion_->advance_by(rest);
    if (report.converged())
      motion_->end_part(end);
    else
      motion_->restore(end);
    rest_ = rest;
    return report;
  }
  std::vector<NamedVector> state() const override {
    const auto momenta = motion_->momenta();
    const auto& configuration = motion_->configuration();
    NamedVector places{"places", {}}, attitudes{"attitudes", {}}, linear{"momenta", {}}, spins{"spins", {}};
    const auto append = [](NamedVector& block, const auto& all, int width) {
      for (const auto& each : all) block.values.insert(block.values.end(), each.data(), each.data() + width);
    };
    append(places, std::span(configuration.x).first(momenta.linear.size()), 3);
    append(attitudes, std::span(configuration.attitude).first(momenta.spin.size()), 9);
    append(linear, momenta.linear, 3);
    append(spins, momenta.spin, 3);
    std::vector<NamedVector> state;
    for (NamedVector* block : {&places, &attitudes, &linear, &spins})
      if (!block->values.empty()) state.push_back(std::move(*block));
    return state;
  }
  std::optional<double> defect() const override {
    if (motion_->rows() == 0) return std::nullopt;
    return motion_->constraint_residual();
  }
  bool is_judged_at_every_node() const override { return false; }

  void describe(RunResult& result) const override {
    result.notes.insert(result.notes.end(), notes_.begin(), notes_.end());
    if (bodies_.counts_cost) result.cost = cost_;
    if (numbers_ && *numbers_ != numbers_of_scene(scene_))
      result.notes.emplace_back(
          "numbers of the scene were changed on the way; the pictures are made with the first ones");
    result.trajectory.conventions = {{"position", "of centres of mass, pivots or point masses, in space, z up"},
                                     {"attitude", "A carries body to space"},
                                     {"momenta", "tangent to the joints"}};
    result.panels = panels_of(bodies_, chosen_);
    if (controlled_) result.panels.push_back({"step size", "t", "h", "t", {"h"}});
    if (bodies_.counts_cost) result.panels.push_back({"cost of the controls", "t", "cost", "t", {"cost"}});
    result.shapes = shapes_of(bodies_, chosen_);
  }
  void serialize(NumberArchive& archive) override {
    std::vector<double> values;
    for (const SceneNumber& number : numbers()) values.push_back(number.value);
    const std::vector<double> first = values;
    if (!values.empty()) archive(values);
    if (values != first) {
      std::vector<SceneNumber> then = numbers();
      for (std::size_t i = 0; i < then.size(); ++i) then[i].value = values[i];
      set_numbers(std::move(then));
    }
    motion_->serialize(archive);
    archive(cost_);
  }

 private:
  /// The motion is where a share of the last step, or of what a change left of it, leads to.
  bool go_within(double share) {
    if (!whole_) {
      whole_ = motion_->state();
      whole_step_ = rest_.value_or(motion_->step());
    }
    motion_->restore(kept_);
    const double size = share * whole_step_;
    return size == 0 || motion_->advance_by(size).converged();
  }
  /// As they are now. Most scenes have no use for them, and large ones many.
  const std::vector<SceneNumber>& numbers() const {
    if (!numbers_) numbers_ = numbers_of_scene(scene_);
    return *numbers_;
  }
  std::vector<SceneNumber> changed_numbers(const std::vector<ParameterValue>& to) const {
    std::vector<SceneNumber> out = numbers();
    for (const ParameterValue& each : to)
      std::find_if(out.begin(), out.end(), [&](const SceneNumber& n) { return n.name == each.name; })->value =
          each.value;
    return out;
  }
  /// Why numbers cannot become others here, together with what is switched.
  std::string refused_numbers(const MotionChange& change) const {
    try {
      const std::unique_ptr<Multibody> motion = motion_with(changed_numbers(change.parameters));
      motion->switch_to(switched(change.switches));
      if (const double defect = motion->constraint_residual(); !(defect < joints_hold))
        return fmt::format("with what it sets the joints do not hold: they are violated by a share {:.3g}", defect);
    } catch (const SceneError& error) {
      return error.problem();
    } catch (const std::invalid_argument& error) {
      return fmt::format("what it sets makes another scene of it: {}", error.what());
    }
    return "";
  }
  std::vector<char> switched(const std::vector<Switched>& changes) const {
    std::vector<char> on = motion_->switches().on;
    for (const Switched& each : changes) on[std::size_t(number_of(each))] = each.on;
    return on;
  }
  /// The motion where it is, of the scene with these numbers.
  std::unique_ptr<Multibody> motion_with(const std::vector<SceneNumber>& numbers) const {
    const Section scene = scene_with(scene_, numbers);
    SceneBodies bodies = read_scene_bodies(scene, true);
    // What is watched for was chosen at the start.
    if ((bodies.timed && !bodies_.timed) || (bodies.driven && !bodies_.driven) ||
        (bodies.dissipates && !bodies_.dissipates))
      scene.fail("", "what it sets begins to drive or to damp the scene; let a small number do so from the start");
    std::unique_ptr<Multibody> motion = motion_of(scene, bodies, step_, options_);
    motion->go_on_from(*motion_);
    return motion;
  }
  /// What is seen knows the motion by its place.
  void set_numbers(std::vector<SceneNumber> numbers) {
    *motion_ = std::move(*motion_with(numbers));
    numbers_ = std::move(numbers);
  }
  int number_of(const Switched& each) const {
    const std::vector<std::string>& names = motion_->switches().names;
    return int(std::find(names.begin(), names.end(), each.name) - names.begin());
  }
  void kick(const std::vector<double>& by) {
    const double* next = by.data();
    const auto take = [&next](bool is_there) {
      if (!is_there) return Vec(Vec::Zero());
      next += 3;
      return Vec(Eigen::Map<const Vec>(next - 3));
    };
    for (const NamedBody& body : bodies_.bodies) {
      const Vec momentum = take(body.linear >= 0);
      const Vec spin = take(body.body.attitude.index >= 0);
      motion_->kick(body.linear, momentum, body.body.attitude, spin);
    }
  }

  std::string name_;
  Section scene_;
  mutable std::optional<std::vector<SceneNumber>> numbers_;  ///< once something asked for them
  double step_;
  multibody::Options options_;
  SceneBodies bodies_;
  std::set<std::string> chosen_;
  bool controlled_;
  MethodTraits traits_;
  std::unique_ptr<Multibody> motion_;
  SceneNode node_;
  std::vector<std::string> notes_;
  double cost_ = 0;
  multibody::SceneState kept_;                  ///< from which steps are made in part
  std::optional<multibody::SceneState> whole_;  ///< where the motion is, while a point inside of its step is looked at
  double whole_step_ = 0;
  std::optional<double> rest_;  ///< what a change left of the last step (s)
};

}  // namespace

const IntegrationMethod& read_bodies_method(const Section& time) {
  const IntegrationMethod& equal = integration_method(IntegratorOptions{});
  const IntegrationMethod& controlled = integration_method({.mode = TimeMode::controlled});
  const std::string mode = read_key(time, time_keys::mode(modes()));
  read_key(time, time_keys::method(methods()));
  return mode == mode_of_equal_steps ? equal : controlled;
}

Table scene_of_bodies_table() {
  Table output = output_table();
  output.keys.push_back(chosen_bodies);
  Table time{grid_keys()};
  time.keys.insert(time.keys.end(), {time_keys::mode(modes()), time_keys::method(methods()), time_keys::order(),
                                     time_keys::composition(compositions::all)});
  Table table = bodies_table();
  table.keys.insert(table.keys.begin(), name_of_scene);
  table.keys.push_back(optional_table("output", output, "what is recorded"));
  table.kinds =
      initial_values({optional_table("solver", {{max_iterations, tolerance}}, "of the equations of a step")}, time);
  table.about = "bodies, what ties them and what acts on them";
  return table;
}

multibody::Multibody begin_bodies(const Section& scene, double step, const multibody::Options& options) {
  SceneBodies bodies = read_scene_bodies(scene);
  return std::move(*begin(scene, bodies, step, options));
}

BodiesScene read_bodies(const Section& scene, const RunContext& context) {
  SceneBodies bodies = read_scene_bodies(scene);
  if (bodies.bodies.empty()) scene.fail("body", "there is no body in it");
  const std::string name = read_key(scene, name_of_scene);
  const double step = read_time(scene).step;
  const multibody::Options options = read_options(scene, bodies);
  const Section output = scene.section_or_empty("output");
  BodiesScene out;
  out.extent = read_extent(scene, context);
  std::set<std::string> chosen;
  for (const NamedBody* body : bodies.chosen(output))
    if (output.has("bodies")) chosen.insert(body->name);
  scene.finish();
  out.methods = composed_methods(integration_method(IntegratorOptions{}).name, steps_composed(is_composable(bodies)));
  out.options = options;
  out.to_check = {name, [scene] { return std::move(read_scene_bodies(scene).scene); }, step, is_symplectic(bodies),
                  is_reversible(bodies)};
  auto motion = std::make_unique<BodiesMotion>(scene, name, std::move(bodies), step, options, std::move(chosen));
  if (motion->has_time_scale()) {
    const IntegrationMethod& controlled = integration_method({.mode = TimeMode::controlled});
    out.methods.push_back({std::string(controlled.name),
                           controlled.order,
                           controlled.stages,
                           controlled.equal_steps(),
                           {fmt::format("time.mode={}", controlled.name)}});
  }
  out.motion = std::move(motion);
  return out;
}

}  // namespace lagroid::app
