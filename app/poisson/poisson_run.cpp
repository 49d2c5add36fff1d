#include "poisson_run.hpp"

#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"
#include "poisson_node.hpp"
#include "poisson_noise.hpp"

#include <lagroid/run/interrupt.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::app {

namespace {

/// Why a step failed, and what to do.
std::string poisson_failure(const StepReport& report, long step, double time, bool by_tolerance) {
  const std::string where = fmt::format("step {} (from t = {:.6g})", step, time);
  if (by_tolerance) {
    if (report.status == SolveStatus::no_step)
      return fmt::format("{}: no step is small enough for the tolerance; use a larger time.tolerance", where);
    if (report.status == SolveStatus::not_converged)
      return fmt::format(
          "{}: too many steps to the next node, or interrupted; use a larger time.tolerance or a smaller "
          "time.step",
          where);
    return fmt::format("{}: the motion left the domain of its energy, or a number overflowed", where);
  }
  switch (report.status) {
    case SolveStatus::left_domain:
      return fmt::format(
          "{}: left the domain in which the symplectic groupoid's chart and the energy are known; use a smaller "
          "time.step",
          where);
    case SolveStatus::singular:
      return fmt::format("{}: the step's equations fold, so that there are two steps or none; use a smaller time.step",
                         where);
    case SolveStatus::not_finite:
      return fmt::format("{}: a number overflowed or became NaN; use a smaller time.step", where);
    default:
      return fmt::format(
          "{}: the step's equations were not solved ({}, residual {:.3g} after {} iterations); use a "
          "smaller time.step",
          where, to_string(report.status), report.residual, report.iterations);
  }
}

class PoissonMotion final : public Motion {
 public:
  PoissonMotion(const PoissonEntry& entry, const PoissonToCheck& asked, long every)
      : entry_(entry),
        system_(asked.system),
        options_(asked.options),
        integrator_(system_->begin(asked.start, options_)),
        stages_(integrator_->traits().stages),
        node_(entry, *system_, *integrator_, every, options_.noise.present()) {}

  std::string name() const override { return entry_.name; }
  MethodTraits traits() const override { return integrator_->traits(); }

  StepReport advance() override {
    const StepReport report = integrator_->advance();
    if (report.converged()) ++index_;
    return report;
  }
  std::string failure(const StepReport& report, long step) const override {
    return poisson_failure(report, step, time(), by_tolerance());
  }
  long evaluations(const StepReport& report) const override {
    return stages_ > 0 ? stages_ : std::max(report.iterations, 1);
  }

  long index() const override { return index_; }
  double time() const override { return integrator_->time(); }
  double step_size() const override { return options_.step; }
  const Observables& look() override {
    node_.see(index_, time(), *integrator_);
    return node_;
  }
  std::string why_not_cut() const override {
    return options_.noise.present() ? "the path of the noise is not known inside of a step"
           : by_tolerance()         ? "steps by a tolerance end at nodes; take another time.method"
                                    : "";
  }
  void keep_node() override {
    kept_ = integrator_->point();
    kept_time_ = time();
    rest_ = 1;
  }
  const Observables* look_within(double share) override {
    if (!go_within(share)) return nullptr;
    node_.see(index_, kept_time_ + share * rest_ * options_.step, *inside_);
    return &node_;
  }
  /// Of a Poisson manifold a kick is one of the state.
  Changeable changeable() const override { return {.momenta = {{"", entry_.labels.size()}}}; }
  std::string refused(double share, const MotionChange& change) override {
    if (!go_within(share)) return "a part of the step does not converge; use a smaller time.step";
    return system_->refusal(kicked(change));
  }
  StepReport change_within(double share, const MotionChange& change) override {
    StepReport report;
    if (!go_within(share)) return report;
    kept_ = kicked(change);
    kept_time_ += share * rest_ * options_.step;
    rest_ *= 1 - share;
    if (!go_within(1)) return report;
    integrator_->go_on_from(inside_->point());
    report.status = SolveStatus::converged;
    return report;
  }
  std::vector<NamedVector> state() const override { return {{"state", integrator_->point()}}; }
  std::optional<double> defect() const override { return {}; }
  bool is_judged_at_every_node() const override { return false; }

  void describe(RunResult& result) const override {
    const KeptStructure kept = integrator_->kept();
    const auto words = [](int power) {
      return power == KeptStructure::to_the_tolerance ? std::string("up to the tolerance")
             : power == 0                             ? std::string("exactly")
             : power == 1                             ? std::string("up to h in a step")
                                                      : fmt::format("up to h^{} in a step", power);
    };
    if (options_.noise.present()) result.notes.push_back(noise_note(options_.noise, entry_));
    result.notes.push_back(fmt::format("the bracket is kept {}, Casimirs{} {}", words(kept.bracket),
                                       kept.energy ? " and energy" : "", words(kept.casimirs)));
    describe_poisson(entry_, result);
  }
  void serialize(NumberArchive& archive) override {
    integrator_->serialize(archive);
    archive(index_);
  }

 private:
  bool by_tolerance() const { return integrator_->kept().bracket == KeptStructure::to_the_tolerance; }
  bool go_within(double share) {
    PoissonOptions part = options_;
    const double size = share * rest_;
    if (size > 0) part.step *= size;  // there is no step of size zero
    inside_ = system_->begin(kept_, part);
    return size == 0 || inside_->advance().converged();
  }
  /// Where it is within, changed.
  std::vector<double> kicked(const MotionChange& change) const {
    std::vector<double> x = inside_->point();
    for (std::size_t i = 0; i < change.kick.size(); ++i) x[i] += change.kick[i];
    return x;
  }

  const PoissonEntry& entry_;
  std::shared_ptr<const AnyPoissonSystem> system_;
  PoissonOptions options_;
  std::unique_ptr<PoissonIntegrator> integrator_;
  int stages_;
  PoissonNode node_;
  long index_ = 0;
  std::vector<double> kept_;  ///< the node before the last step, or where it was changed
  double kept_time_ = 0;
  double rest_ = 1;                            ///< of the step, from there on
  std::unique_ptr<PoissonIntegrator> inside_;  ///< of a share of that step
};

KeyOf<NumberArray> state_key(const PoissonEntry& entry) {
  return {"state", {entry.labels.size()}, "", fmt::format("{} at the start", fmt::join(entry.labels, ", "))};
}
KeyOf<OneOf> method_key(const PoissonEntry& entry) {
  std::vector<std::string> names;
  for (const DeclaredMethod* each : entry.methods) names.emplace_back(each->name);
  return time_keys::method(std::move(names));
}

std::vector<Method> methods_of(const PoissonEntry& entry) {
  std::vector<Method> all;
  for (const DeclaredMethod* each : entry.methods) {
    std::vector<Method> made;
    if (each->other_orders == OtherOrders::composed_steps) {
      made = composed_methods(each->name, compositions::all);
    } else if (poisson_methods::by_tolerance(*each)) {
      for (const char* tolerance : {"1e-6", "1e-9", "1e-12"})
        made.push_back({fmt::format("{}/{}", each->name, tolerance),
                        each->order,
                        each->stages,
                        false,
                        {fmt::format("time.method={}", each->name), fmt::format("time.tolerance={}", tolerance)}});
    } else {
      made.push_back(
          {std::string(each->name), each->order, each->stages, true, {fmt::format("time.method={}", each->name)}});
    }
    for (Method& method : made) {
      method.to_compare = each->to_compare;
      all.push_back(std::move(method));
    }
  }
  return all;
}

}  // namespace

Table poisson_start_table(const PoissonEntry& entry) { return {{state_key(entry)}}; }

Table poisson_time_table(const PoissonEntry& entry) {
  Table table{grid_keys()};
  table.keys.insert(table.keys.end(), {method_key(entry), time_keys::order(), time_keys::composition(compositions::all),
                                       time_keys::tolerance});
  return table;
}

ReadMethod read_poisson_method(const Section& time, const PoissonEntry& entry) {
  const std::string name = read_key(time, method_key(entry));
  const auto found = std::find_if(entry.methods.begin(), entry.methods.end(),
                                  [&](const DeclaredMethod* each) { return each->name == name; });
  const DeclaredMethod& declared = **found;
  if (declared.other_orders == OtherOrders::composed_steps)
    return {&declared, read_composition(time, compositions::all)};
  if (time.has("composition")) time.fail("composition", fmt::format("is of steps of order two, not of {}", name));
  if (time.has("order") && poisson_methods::by_tolerance(declared))
    time.fail("order", fmt::format("of {} follows its tolerance; leave it out", name));
  if (time.has("order") && read_key(time, time_keys::order()) != declared.order)
    time.fail("order", fmt::format("{} is of order {}", name, declared.order));
  return {&declared, compositions::single};
}

PoissonScene read_poisson(const PoissonEntry& entry, const Section& scene, const RunContext& context) {
  PoissonScene out;
  PoissonToCheck& read = out.to_check;
  read.system = entry.read(scene);
  const Section initial = scene.section("initial", "state");
  read.start = read_key(initial, state_key(entry));
  if (const std::string why = read.system->refusal(read.start); !why.empty()) initial.fail("state", why);
  const Section time = scene.section("time", "step and steps, or duration and steps");
  read.options.step = read_time(scene).step;
  refuse_accuracy(scene);
  const ReadMethod method = read_poisson_method(time, entry);
  read.options.method = method.declared->name;
  read.options.composition = method.composition;
  if (const auto tolerance = read_tolerance(time, poisson_methods::by_tolerance(*method.declared))) {
    read.options.tolerance = *tolerance;
    read.options.stop = &InterruptGuard::interrupted;
    if (!(read.options.step > 0))
      time.fail("step", "is the distance of nodes, to which steps by a tolerance go forward");
  }
  read.options.noise = read_noise(scene, entry);
  if (read.options.noise.present()) refuse_for_noise(time, *method.declared, method.composition);
  out.extent = read_extent(scene, context);
  scene.choice("system", {entry.name});
  scene.finish();
  out.methods = methods_of(entry);
  out.motion = std::make_unique<PoissonMotion>(entry, read, out.extent.every);
  return out;
}

}  // namespace lagroid::app
