#include "scene_run.hpp"

#include "../simulation.hpp"
#include "../systems/attitude.hpp"
#include "scene_bodies.hpp"

#include <lagroid/run/ledger.hpp>
#include <lagroid/run/stepped_run.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>

namespace lagroid::app {

using multibody::Multibody;
using multibody::Vec;

namespace {

std::string column(const std::string& body, std::string_view what) { return fmt::format("{}.{}", body, what); }

std::vector<std::string> columns(const std::string& body, std::initializer_list<std::string_view> what) {
  std::vector<std::string> out;
  for (const auto& w : what) out.push_back(column(body, w));
  return out;
}

std::vector<std::string> attitude_of(const std::string& body) { return columns(body, {"A_w", "A_x", "A_y", "A_z"}); }

/// The motion at a node, with what is computed of it there once for all who want it.
struct Node {
  explicit Node(const Multibody& at, double cost_so_far = 0)
      : motion(at),
        cost(cost_so_far),
        momenta(at.momenta()),
        kinetic(at.kinetic_energy(momenta)),
        potential(at.potential_energy()),
        residual(at.constraint_residual()) {}

  double energy() const { return kinetic + potential; }
  /// Sizes of the terms of the momenta.
  double momentum_size() const {
    double size = 0;
    for (const Vec& p : momenta.linear) size += p.stableNorm();
    return size;
  }
  double angular_size() const {
    double size = 0;
    for (std::size_t f = 0; f < momenta.linear.size(); ++f)
      size += momenta.linear[f].stableNorm() * motion.configuration().x[f].stableNorm();
    for (const Vec& spin : momenta.spin) size += spin.stableNorm();
    return size;
  }

  const Multibody& motion;
  double cost;
  Multibody::Momenta momenta;
  double kinetic, potential, residual;
};

/// A series and how its row is read off a node.
struct Recorded {
  Columns series;
  std::function<void(const Node&, std::vector<double>&)> read;
};

void put(std::vector<double>& row, const Vec& v) { row.insert(row.end(), v.data(), v.data() + 3); }

/// What is recorded of a scene's motion.
class Record {
 public:
  Record(const SceneBodies& bodies, const std::set<std::string>& chosen, bool controlled) {
    for (const NamedBody& b : bodies.bodies) {
      if (!chosen.empty() && !chosen.contains(b.name)) continue;
      add_body(b);
    }
    for (std::size_t k = 0; k < bodies.lines.size(); ++k)
      for (const auto& [end, name] : {std::pair{&bodies.lines[k].from, "from"}, {&bodies.lines[k].to, "to"}})
        if (end->moved || (end->body && !end->arm.isZero(0) && (chosen.empty() || chosen.contains(end->body->name))))
          add_point(end_column(k, name), end->site);
    series_.push_back({{"energy", {"energy"}, "J", "kinetic and potential energy", false, {}},
                       [](const Node& node, std::vector<double>& row) { row.push_back(node.energy()); }});
    if (controlled)
      series_.push_back({{"step_size", {"h"}, "s", "step size of the arrow that led here", false, {}},
                         [](const Node& node, std::vector<double>& row) { row.push_back(node.motion.step()); }});
    if (bodies.counts_cost)
      series_.push_back(
          {{"cost", {"cost"}, "J s", "of the controls so far: the kinetic terms of the arrows", false, {}},
           [](const Node& node, std::vector<double>& row) { row.push_back(node.cost); }});
    series_.push_back({{"constraint_residual", {"residual"}, "1", "largest |C|, over the size of its terms", false, {}},
                       [](const Node& node, std::vector<double>& row) { row.push_back(node.residual); }});
  }

  static std::string end_column(std::size_t line, const char* end) { return fmt::format("line{}.{}", line, end); }

  void declare(Trajectory& trajectory) const {
    for (const auto& r : series_) trajectory.series.push_back(r.series);
  }

  void observe(const Node& node, Trajectory& trajectory) {
    trajectory.time.push_back(node.motion.time());
    for (std::size_t i = 0; i < series_.size(); ++i) series_[i].read(node, trajectory.series[i].values);
  }

 private:
  void add_point(const std::string& name, multibody::Site site) {
    series_.push_back({{name, columns(name, {"x", "y", "z"}), "m", "position in space", false, {}},
                       [site](const Node& node, std::vector<double>& row) {
                         put(row, node.motion.configuration()(node.motion(site)));
                       }});
  }

  void add_body(const NamedBody& b) {
    add_point(b.name, b.body.centre);
    if (b.body.attitude.index >= 0) {
      series_.push_back({{b.name + ".attitude",
                          attitude_of(b.name),
                          "1",
                          "rotation A from body to space, unit quaternion w, x, y, z",
                          false,
                          {}},
                         [a = b.body.attitude](const Node& node, std::vector<double>& row) {
                           const auto& q = node.motion.quaternion(a);
                           row.insert(row.end(), q.data(), q.data() + 4);
                         }});
      series_.push_back(
          {{b.name + ".spin", columns(b.name, {"M1", "M2", "M3"}), "kg m^2/s", "body angular momentum", false, {}},
           [a = b.body.attitude](const Node& node, std::vector<double>& row) {
             put(row, node.momenta.spin[std::size_t(node.motion(a).index)]);
           }});
      series_.push_back({{b.name + ".angular_velocity",
                          columns(b.name, {"w1", "w2", "w3"}),
                          "rad/s",
                          "angular velocity in the body",
                          false,
                          {}},
                         [a = b.body.attitude, inertia = b.inertia](const Node& node, std::vector<double>& row) {
                           const Vec& spin = node.momenta.spin[std::size_t(node.motion(a).index)];
                           put(row, spin.cwiseQuotient(inertia));
                         }});
    }
    if (const int linear = b.linear; linear >= 0) {
      const auto momentum = [linear](const Node& node, std::vector<double>& row) {
        put(row, node.momenta.linear[std::size_t(node.motion.linear_place(linear))]);
      };
      if (b.planar) {
        series_.push_back({{b.name + ".angle", {column(b.name, "angle")}, "rad", "of the body in the plane", false, {}},
                           [linear](const Node& node, std::vector<double>& row) {
                             row.push_back(
                                 node.motion.configuration().x[std::size_t(node.motion.linear_place(linear))](2));
                           }});
        series_.push_back({{b.name + ".momentum",
                            columns(b.name, {"px", "py", "L"}),
                            "kg m/s; kg m^2/s",
                            "momentum, and angular momentum about the centre",
                            false,
                            {}},
                           momentum});
        series_.push_back(
            {{b.name + ".angular_velocity", {column(b.name, "w")}, "rad/s", "of the body in the plane", false, {}},
             [linear, inertia = b.inertia(2)](const Node& node, std::vector<double>& row) {
               row.push_back(node.momenta.linear[std::size_t(node.motion.linear_place(linear))](2) / inertia);
             }});
      } else {
        series_.push_back(
            {{b.name + ".momentum", columns(b.name, {"px", "py", "pz"}), "kg m/s", "momentum in space", false, {}},
             momentum});
      }
    }
  }

  std::vector<Recorded> series_;
};

/// The shapes of bodies and lines, in the columns that are recorded.
std::vector<Shape> shapes(const SceneBodies& bodies, const std::set<std::string>& chosen) {
  std::vector<Shape> out = bodies.scenery;
  const double extent = bodies.extent > 0 ? bodies.extent : 1;
  double heaviest = 0;
  for (const auto& b : bodies.bodies) heaviest = std::max(heaviest, b.mass);
  const auto seen = [&](const NamedBody& b) { return chosen.empty() || chosen.contains(b.name); };
  const auto at = [](const std::string& name) -> std::vector<Coordinate> {
    return {column(name, "x"), column(name, "y"), column(name, "z")};
  };
  for (const auto& b : bodies.bodies) {
    if (!seen(b)) continue;
    Shape shape;
    if (b.radius > 0) {
      shape = {"sphere", {b.radius}};
      shape.attitude = attitude_of(b.name);
    } else if (b.body.attitude.index >= 0) {
      const Vec& c = b.to_centre;
      const Vec moments = b.inertia - b.mass * (Vec::Constant(c.squaredNorm()) - c.cwiseAbs2());
      const bool box = b.mass > 0 && 2 * moments.maxCoeff() < moments.sum();
      shape = box ? box_of_mass(b.mass, {moments(0), moments(1), moments(2)})
                  : box_of({b.inertia(0), b.inertia(1), b.inertia(2)});
      shape.attitude = attitude_of(b.name);
      shape.offset = {c(0), c(1), c(2)};
    } else if (b.planar) {
      const double side = std::sqrt(12 * b.inertia(2) / b.mass);
      shape = {"box", {side, 0.1 * side, 0.1 * side}};
      shape.turns = {{{0, 0, 1}, column(b.name, "angle")}};
    } else {
      shape = {"sphere", {0.03 * extent * std::cbrt(b.mass / heaviest)}};
    }
    shape.position = at(b.name);
    shape.trail = bodies.bodies.size() <= 12 || &b == &bodies.bodies.back();
    out.push_back(shape);
  }
  for (std::size_t k = 0; k < bodies.lines.size(); ++k) {
    const auto& line = bodies.lines[k];
    const auto end = [&](const End& e, const char* name) -> std::vector<Coordinate> {
      if (!e.body && !e.moved) return {e.place(0), e.place(1), e.place(2)};
      return at(e.body && e.arm.isZero(0) ? e.body->name : Record::end_column(k, name));
    };
    if ((line.from.body && !seen(*line.from.body)) || (line.to.body && !seen(*line.to.body))) continue;
    Shape rod{"rod", {(line.to.place - line.from.place).norm(), line.width * extent}};
    rod.position = end(line.from, "from");
    rod.to = end(line.to, "to");
    out.push_back(rod);
  }
  return out;
}

bool turns_in_space(const NamedBody& b) { return b.body.attitude.index >= 0; }
bool moves_about(const NamedBody& b) { return b.linear >= 0; }
bool moves_in_the_plane(const NamedBody& b) { return moves_about(b) && b.planar; }

/// The last of the bodies that are recorded and of the kind that is asked for, so few that their curves can be told
/// apart.
std::vector<const NamedBody*> last_few(const SceneBodies& bodies, const std::set<std::string>& chosen,
                                       bool (*is_wanted)(const NamedBody&), std::ptrdiff_t most) {
  std::vector<const NamedBody*> few;
  for (const auto& b : bodies.bodies)
    if (is_wanted(b) && (chosen.empty() || chosen.contains(b.name))) few.push_back(&b);
  if (std::ssize(few) > most) few.erase(few.begin(), few.end() - most);
  return few;
}

/// Places of the bodies whose centres move, the turning of those that turn, in space and in the plane, and their
/// momenta.
std::vector<Panel> panels(const SceneBodies& bodies, const std::set<std::string>& chosen) {
  std::vector<Panel> out{{"energy", "t", "energy", "t", {"energy"}}};
  const auto together = [&](const std::vector<const NamedBody*>& few, const std::string& title, const char* what) {
    Panel panel{title, "t", what, "t", {}};
    for (const auto* b : few) panel.curves.push_back(column(b->name, what));
    if (!panel.curves.empty()) out.push_back(panel);
  };
  const auto moving = last_few(bodies, chosen, moves_about, 4);
  const auto planar = last_few(bodies, chosen, moves_in_the_plane, 4);
  together(moving, "positions x", "x");
  together(moving, "positions y", "y");
  if (planar.size() < moving.size()) together(moving, "positions z", "z");
  together(planar, "angles", "angle");
  together(planar, "angular velocities", "w");
  together(planar, "angular momenta about the centres", "L");
  for (const auto* b : last_few(bodies, chosen, turns_in_space, 2)) {
    out.push_back(attitude_panel(attitude_of(b->name), "attitude of " + b->name));
    out.push_back({"angular velocity in " + b->name, "t", "w", "t", columns(b->name, {"w1", "w2", "w3"})});
    out.push_back({"angular momentum in " + b->name, "t", "M", "t", columns(b->name, {"M1", "M2", "M3"})});
    if (moves_about(*b)) out.push_back({"momentum of " + b->name, "t", "p", "t", columns(b->name, {"px", "py", "pz"})});
  }
  out.push_back({"constraints", "t", "residual", "t", {"residual"}});
  return out;
}

/// Watches the quantities that the scene promises.
class Promises {
 public:
  explicit Promises(const SceneBodies& bodies)
      : keeps_energy_(!bodies.driven && !bodies.timed),
        isolated_(bodies.isolated),
        energy_(bodies.dissipates ? "energy and what drag took" : "energy", Promise::bounded, 1),
        momentum_("momentum", Promise::conserved, 3),
        angular_("angular momentum", Promise::conserved, 3) {}

  void observe(const Node& node) {
    const auto& [motion, cost, m, kinetic, potential, residual] = node;
    residual_ = std::isnan(residual) ? residual : std::max(residual_, residual);
    const auto& places = motion.configuration().x;
    positions_.observe(
        [&] { return std::span<const double>(places.empty() ? nullptr : places.front().data(), 3 * places.size()); });
    if (keeps_energy_) {
      const double energy = kinetic + potential + motion.dissipated();
      energy_.observe(&energy, kinetic + std::abs(potential));
    }
    if (!isolated_) return;
    momentum_.observe(motion.linear_momentum(m).data(), node.momentum_size());
    angular_.observe(motion.angular_momentum(m).data(), node.angular_size());
  }

  void persist(Archive& archive) {
    archive("residual", residual_);
    archive("positions", positions_);
    archive("energy", energy_);
    archive("momentum", momentum_);
    archive("angular momentum", angular_);
  }

  void report(const Multibody& motion, Ledger& ledger) const {
    if (motion.rows() > 0) ledger.entries.push_back(constraint_entry(residual_, 1));
    if (keeps_energy_) ledger.entries.push_back(energy_.entry());
    if (isolated_) {
      ledger.entries.push_back(momentum_.entry());
      ledger.entries.push_back(angular_.entry());
    }
    positions_.withhold_verdicts(ledger);
  }

 private:
  bool keeps_energy_;
  bool isolated_;
  double residual_ = 0;
  PositionWatch positions_;
  QuantityWatch energy_, momentum_, angular_;
};

/// Whether steps are controlled.
bool read_mode(const Section& scene) {
  const Section time = scene.section("time", "step and steps, or duration and steps");
  const bool controlled = time.choice_or("mode", "fixed", {"fixed", "controlled"}) == "controlled";
  if (controlled) refuse_duration(time);
  return controlled;
}

/// A scene's motion with all that is told of it.
class Run final : public SteppedRun {
 public:
  Run(const Section& scene, const RunContext& context, long most_steps)
      : bodies_(read_scene_bodies(scene)), context_(context) {
    if (bodies_.bodies.empty()) scene.fail("body", "there is no body in it");
    result_.system = scene.has("name") ? scene.text("name", "what the scene shows") : "scene";
    step_ = read_time(scene).step;
    refuse_accuracy(scene);
    const Section solver = scene.section_or_empty("solver");
    multibody::Options options;
    options.max_iterations = int(solver.integer_or("max_iterations", options.max_iterations, 1, 100000));
    options.tolerance =
        solver.number_or("tolerance", 0, {"between 0 and 0.001", [](double x) { return x >= 0 && x <= 1e-3; }});
    options.controlled = controlled_ = read_mode(scene);
    const Section time = scene.section("time", "step and steps, or duration and steps");
    time.choice_or("method", "variational", {"variational"});
    options.composition = read_composition(time, compositions::all);
    if (options.composition.stages() > 1 && (controlled_ || !is_composable(bodies_)))
      time.fail(time.has("order") ? "order" : "composition",
                "above 2 goes with equal steps of scenes without damping and without joints that hold velocities");
    if (const double damped = step_ * bodies_.damping_rate; !(damped <= 2))
      scene.section("time", "")
          .fail("step",
                fmt::format("drag stops a body within less than half a step (drag over inertia times the step is "
                            "{:.4g}): use a step below {:.3g}",
                            damped, 2 / bodies_.damping_rate));
    const Section output = scene.section_or_empty("output");
    pace_ = read_pace(scene, context);
    pace_.steps = std::min(pace_.steps, most_steps);
    for (const NamedBody* body : bodies_.chosen(output, "bodies"))
      if (output.has("bodies")) chosen_.insert(body->name);
    scene.finish();

    try {
      motion_ = std::make_unique<Multibody>(std::move(bodies_.scene), step_, options);
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
    if (bodies_.projects) motion_->make_tangent();
    if (const double defect = motion_->velocity_defect(); !(defect < 1e-8))
      scene.fail("", fmt::format("the velocities at the start do not agree with the joints (by a share {:.3g}); mend "
                                 "them, or take what the joints allow of them with project_velocities = true",
                                 defect));
    if (!std::isfinite(Node(*motion_).energy()))
      scene.fail("",
                 "the energy at the start is no finite number: a velocity or a mass is too large, or bodies that act "
                 "on each other meet");
    const Composition& composition = options.composition;
    traits_ = {options.controlled         ? "controlled steps"
               : composition.stages() > 1 ? std::string(composition.name)
                                          : "steps of the discrete Lagrangian",
               composition.order, true, is_variational(bodies_) && !options.controlled, false};
    result_.method = description(traits_);
    if (motion_->dependent_rows() > 0)
      result_.notes.push_back(
          fmt::format("{} of {} equations of the joints depend on the others at the start; they hold because those do, "
                      "and are left out",
                      motion_->dependent_rows(), motion_->rows()));
    if (const double hardest = motion_->hardest_damper(); hardest > 1)
      result_.notes.push_back(fmt::format(
          "a damper is harder than the step resolves (damping times step over twice the inertia is {:.3g}): "
          "places follow the motion, momenta and energies alternate; use a step below {:.3g}",
          hardest, step_ / hardest));
    record_.emplace(bodies_, chosen_, options.controlled);
    promises_.emplace(bodies_);
    if (context_.record) record_->declare(result_.trajectory);
  }

  /// What is asked instead of running it; `scene` is the one that was read.
  BodiesToCheck to_check(const Section& scene) const {
    return {result_.system, [scene] { return std::move(read_scene_bodies(scene).scene); }, step_,
            is_symplectic(bodies_), is_reversible(bodies_)};
  }

  const std::string& name() const { return result_.system; }
  MethodTraits traits() const { return traits_; }
  Multibody& motion() { return *motion_; }
  /// What is kept: energy where nothing drives the bodies, momenta where nothing holds them.
  std::vector<Block> invariants(const Node& node) const {
    std::vector<Block> out;
    if (!bodies_.driven && !bodies_.timed)
      out.push_back({"energy", {node.energy() + node.motion.dissipated()}, node.kinetic + std::abs(node.potential)});
    if (!bodies_.isolated) return out;
    const auto list = [](const Vec& v) { return std::vector<double>(v.data(), v.data() + 3); };
    out.push_back({"momentum", list(node.motion.linear_momentum(node.momenta)), node.momentum_size()});
    out.push_back({"angular momentum", list(node.motion.angular_momentum(node.momenta)), node.angular_size()});
    return out;
  }
  std::vector<Method> methods() const {
    std::vector<Method> all = composed_methods("variational", steps_composed(is_composable(bodies_)));
    if (motion_->has_time_scale()) all.push_back({"controlled", 2, 1, false, {"time.mode=controlled"}});
    return all;
  }

  RunResult go() {
    result_.initial = endpoint();
    drive(*this, pace_, context_, result_);
    if (last_observed_ != motion_->index() && !see() && result_.converged()) {
      result_.status = std::string(to_string(SolveStatus::not_finite));
      result_.message = "energy or constraints are no finite numbers at the end; use a smaller or a larger step";
    }
    if (bodies_.counts_cost) result_.cost = cost_;
    promises_->report(*motion_, result_.ledger);
    result_.trajectory.conventions = {{"position", "of centres of mass, pivots or point masses, in space, z up"},
                                      {"attitude", "A carries body to space"},
                                      {"momenta", "tangent to the joints"}};
    result_.final = endpoint();
    result_.panels = panels(bodies_, chosen_);
    if (controlled_) result_.panels.push_back({"step size", "t", "h", "t", {"h"}});
    if (bodies_.counts_cost) result_.panels.push_back({"cost of the controls", "t", "cost", "t", {"cost"}});
    result_.shapes = shapes(bodies_, chosen_);
    return std::move(result_);
  }

  StepReport advance() override { return motion_->advance(); }
  std::string failure(const StepReport& report, long step) const override {
    if (!motion_->dependence_ended())
      return step_failure(report, step, motion_->time(), controlled_ ? TimeMode::controlled : TimeMode::fixed);
    return fmt::format(
        "step {} (from t = {:.6g}): equations of joints that depended on others at the start no longer do; the scene "
        "starts in a singular position (parts in line, a taut loop): start it elsewhere",
        step, motion_->time());
  }
  bool observe(long step) override {
    if (bodies_.counts_cost && step > 0) cost_ += motion_->arrow_cost();
    return step % pace_.every != 0 || see();
  }
  Trajectory& trajectory() override { return result_.trajectory; }
  void persist(Archive& archive) override {
    archive.tape("motion", [&](Tape& tape) { motion_->persist(tape); });
    archive("cost", cost_);
    archive("last observed", last_observed_);
    archive("promises", *promises_);
  }

 private:
  /// Places of the bodies, and inertia times velocity of those that move, one after another.
  Endpoint endpoint() const {
    Endpoint end;
    end.time = motion_->time();
    const auto momenta = motion_->momenta();
    for (const NamedBody& b : bodies_.bodies) {
      if (!chosen_.empty() && !chosen_.contains(b.name)) continue;
      put(end.position, motion_->configuration()((*motion_)(b.body.centre)));
      if (b.linear >= 0) put(end.momentum, momenta.linear[std::size_t(motion_->linear_place(b.linear))]);
      if (b.body.attitude.index >= 0) put(end.momentum, momenta.spin[std::size_t((*motion_)(b.body.attitude).index)]);
    }
    return end;
  }

  /// False where energy or constraints are no finite numbers.
  bool see() {
    last_observed_ = motion_->index();
    const Node node(*motion_, cost_);
    promises_->observe(node);
    if (context_.record) record_->observe(node, result_.trajectory);
    return std::isfinite(node.energy()) && std::isfinite(node.residual);
  }

  SceneBodies bodies_;
  MethodTraits traits_;
  RunContext context_;
  double step_ = 0;
  bool controlled_ = false;
  Pace pace_;
  std::set<std::string> chosen_;
  std::unique_ptr<Multibody> motion_;
  std::optional<Record> record_;
  std::optional<Promises> promises_;
  long last_observed_ = -1;
  double cost_ = 0;
  RunResult result_;
};

/// Such a motion alone.
class MotionTrial final : public Trial {
 public:
  explicit MotionTrial(std::unique_ptr<Run> run) : run_(std::move(run)), motion_(run_->motion()) {}

  StepReport advance(Work& work) override {
    const StepReport report = motion_.advance();
    if (report.converged()) count(work, report, report.iterations > 0 ? 0 : 1);  // free flight: forces alone
    return report;
  }
  StepReport run(double end, Work& work) override {
    StepReport report;
    report.status = SolveStatus::converged;
    while (report.converged() && end - motion_.time() > 0.5 * motion_.step()) report = advance(work);
    return report;
  }
  double time() const override { return motion_.time(); }
  MethodTraits traits() const override { return run_->traits(); }

  Sight see() override {
    const Node node(motion_);
    Sight sight;
    Block places{"places", {}}, attitudes{"attitudes", {}}, momenta{"momenta", {}}, spins{"spins", {}};
    for (std::size_t f = 0; f < node.momenta.linear.size(); ++f) put(places.values, motion_.configuration().x[f]);
    for (std::size_t r = 0; r < node.momenta.spin.size(); ++r) {
      const auto& a = motion_.configuration().attitude[r];
      attitudes.values.insert(attitudes.values.end(), a.data(), a.data() + 9);
    }
    for (const Vec& p : node.momenta.linear) put(momenta.values, p);
    for (const Vec& m : node.momenta.spin) put(spins.values, m);
    for (Block* block : {&places, &attitudes, &momenta, &spins})
      if (!block->values.empty()) sight.state.push_back(std::move(*block));
    sight.invariants = run_->invariants(node);
    sight.constrained = motion_.rows() > 0;
    sight.constraint = node.residual;
    return sight;
  }

 private:
  std::unique_ptr<Run> run_;
  Multibody& motion_;
};

}  // namespace

BodiesTrial begin_bodies(const Section& scene) {
  auto run = std::make_unique<Run>(scene, RunContext{}, std::numeric_limits<long>::max());
  const std::string name = run->name();
  auto methods = run->methods();
  return {name, std::make_unique<MotionTrial>(std::move(run)), std::move(methods)};
}

RunResult run_bodies(const Section& scene, const RunContext& context, long most_steps) {
  return Run(scene, context, most_steps).go();
}

BodiesToCheck bodies_to_check(const Section& scene) { return Run(scene, {}, 0).to_check(scene); }

}  // namespace lagroid::app
