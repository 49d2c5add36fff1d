#include "sphere_run.hpp"

#include "../simulation.hpp"
#include "sphere_record.hpp"
#include "sphere_start.hpp"
#include "sphere_time.hpp"

#include <lagroid/run/output_folder.hpp>
#include <lagroid/run/stepped_run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace lagroid::app {

namespace {

/// A scene that has been read.
struct SphereScene {
  SphereScene(const SphereEntry& entry, const Section& scene, const RunContext& context)
      : system(entry.read(scene)),
        options(read_sphere_time(scene, *system)),
        start(read_start(scene, *system, options.form)),
        pace(read_pace(scene, context)) {
    if (!pace.scene.empty()) pace.scene = parse_scene(pace.scene, scene.file(), system->pinned()).whole();
    scene.choice("system", {std::string(entry.name)});
    scene.finish();
  }

  std::unique_ptr<SphereMarch> begin() const { return system->begin(start, options); }

  std::shared_ptr<const SphereSystem> system;
  SphereMarchOptions options;
  SphereMarch::Points start;
  Pace pace;
};

/// Why a step failed, and what to do.
std::string sphere_failure(const StepReport& report, long step, double time, const SphereMarchOptions& options) {
  const std::string where = fmt::format("step {} (from t = {:.6g})", step, time);
  switch (report.status) {
    case SolveStatus::not_finite:
      return fmt::format("{}: a number overflowed or became NaN; use a smaller or a larger time.step", where);
    case SolveStatus::no_step:
      return fmt::format("{}: the error stays above time.tolerance = {:g} however small the inner steps; raise it",
                         where, options.tolerance);
    default:
      if (options.tolerance > 0)
        return fmt::format(
            "{}: {} inner steps did not reach the next node; raise time.tolerance, or use a smaller "
            "time.step",
            where, report.iterations);
      return fmt::format(
          "{}: no tensions were found that keep the rods' lengths over this step (a rod would turn by a right angle, "
          "or "
          "nearly, or a bob is too light for its neighbours); use a smaller time.step",
          where);
  }
}

class SphereRun final : public SteppedRun {
 public:
  SphereRun(SphereScene scene, const RunContext& context)
      : scene_(std::move(scene)),
        context_(context),
        march_(scene_.begin()),
        record_(*scene_.system, scene_.options.form),
        promises_(*scene_.system, march_->traits(), keeps_spheres(scene_.options), scene_.pace.every) {
    result_.system = scene_.system->name();
    result_.method = description(march_->traits());
    if (scene_.options.tolerance > 0) result_.method += fmt::format(", tolerance {:g}", scene_.options.tolerance);
    if (context_.record) record_.declare(result_.trajectory);
  }

  RunResult go() {
    result_.initial = endpoint();
    drive(*this, scene_.pace, context_, result_);
    if (last_observed_ != result_.steps && !see(result_.steps) && result_.converged()) {
      result_.status = std::string(to_string(SolveStatus::not_finite));
      result_.message = "energy or directions are no finite numbers at the end; use a smaller step";
    }
    promises_.report(result_.ledger);
    record_.describe(result_);
    result_.final = endpoint();
    return std::move(result_);
  }

  StepReport advance() override { return march_->advance(); }
  std::string failure(const StepReport& report, long step) const override {
    return sphere_failure(report, step, march_->time(), scene_.options);
  }
  bool observe(long step) override { return step % scene_.pace.every != 0 || see(step); }
  Trajectory& trajectory() override { return result_.trajectory; }
  void persist(Archive& archive) override {
    const std::vector<double> now = scene_.system->from_files();
    std::vector<double> then = now;
    archive("from files", then);
    if (then != now) throw RunError("the file that the scene's system is read from has changed; run the scene anew");
    archive.tape("march", [&](Tape& tape) { march_->persist(tape); });
    archive("last observed", last_observed_);
    archive("promises", promises_);
  }

 private:
  Endpoint endpoint() const {
    Endpoint end;
    end.time = march_->time();
    const auto z = scene_.system->in_form(march_->point(), scene_.options.form, SphereForm::momenta);
    for (Eigen::Index i = 0; i < z.cols(); ++i) {
      end.position.insert(end.position.end(), z.col(i).data(), z.col(i).data() + 3);
      end.momentum.insert(end.momentum.end(), z.col(i).data() + 3, z.col(i).data() + 6);
    }
    return end;
  }

  /// False where something is no finite number.
  bool see(long step) {
    last_observed_ = step;
    const SphereNode node(*scene_.system, scene_.options.form, march_->time(), march_->point());
    promises_.observe(node);
    if (context_.record) record_.observe(node, result_.trajectory);
    return node.finite();
  }

  SphereScene scene_;
  RunContext context_;
  std::unique_ptr<SphereMarch> march_;
  SphereRecord record_;
  SpherePromises promises_;
  long last_observed_ = -1;
  RunResult result_;
};

/// States are compared as directions and momenta, whatever the form.
class SphereTrial final : public Trial {
 public:
  explicit SphereTrial(SphereScene scene)
      : scene_(std::move(scene)), march_(scene_.begin()), traits_(march_->traits()) {}

  StepReport advance(Work& work) override {
    const StepReport report = march_->advance();
    if (!report.converged()) return report;
    const int inner = scene_.options.tolerance > 0 ? report.iterations : 1;
    count(work, report, inner * traits_.stages);
    return report;
  }
  StepReport run(double end, Work& work) override {
    StepReport report;
    report.status = SolveStatus::converged;
    while (report.converged() && end - march_->time() > 0.5 * scene_.options.step) report = advance(work);
    return report;
  }
  double time() const override { return march_->time(); }
  MethodTraits traits() const override { return traits_; }

  Sight see() override {
    const SphereSystem& system = *scene_.system;
    const SphereNode node(system, scene_.options.form, march_->time(), march_->point());
    const auto z = system.in_form(node.z, scene_.options.form, SphereForm::momenta);
    Sight sight;
    Block directions{"directions", {}}, momenta{"momenta", {}};
    for (Eigen::Index i = 0; i < z.cols(); ++i) {
      directions.values.insert(directions.values.end(), z.col(i).data(), z.col(i).data() + 3);
      momenta.values.insert(momenta.values.end(), z.col(i).data() + 3, z.col(i).data() + 6);
    }
    sight.state = {std::move(directions), std::move(momenta)};
    const auto quantities = system.quantities();
    for (std::size_t i = 0; i < quantities.size(); ++i)
      sight.invariants.push_back({quantities[i].name, {node.measured[i].value}, node.measured[i].size});
    sight.constrained = true;
    sight.constraint = node.residual;
    return sight;
  }

 private:
  SphereScene scene_;
  std::unique_ptr<SphereMarch> march_;
  MethodTraits traits_;
};

}  // namespace

RunResult run_spheres(const SphereEntry& entry, const Section& scene, const RunContext& context, long most_steps) {
  SphereScene read(entry, scene, context);
  read.pace.steps = std::min(read.pace.steps, most_steps);
  return SphereRun(std::move(read), context).go();
}

SphereTrialOf begin_spheres(const SphereEntry& entry, const Section& scene) {
  SphereScene read(entry, scene, {});
  auto methods = sphere_methods(*read.system);
  return {std::make_unique<SphereTrial>(std::move(read)), std::move(methods)};
}

SpheresToCheck spheres_to_check(const SphereEntry& entry, const Section& scene) {
  const SphereScene read(entry, scene, {});
  return {read.system, read.options, read.start};
}

}  // namespace lagroid::app
