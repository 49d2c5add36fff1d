#include "sphere_run.hpp"

#include "../scenes/simulation.hpp"
#include "sphere_node.hpp"
#include "sphere_start.hpp"
#include "sphere_time.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/solvers/step/step_messages.hpp>

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

/// Why a step failed, and what to do.
std::string sphere_failure(const StepReport& report, long step, double time, const SphereIntegratorOptions& options) {
  if (options.tolerance > 0 || report.status == SolveStatus::not_finite)
    return tolerance_failure(report, step, time, options.tolerance, options.most_inner);
  return fmt::format(
      "step {} (from t = {:.6g}): no tensions were found that keep the rods' lengths over this step (a rod would turn "
      "by a right angle, or nearly, or a bob is too light for its neighbours); use a smaller time.step",
      step, time);
}

/// States are compared as directions and momenta, whatever the form. Looking at a node costs about as much as a step.
class SphereMotion final : public Motion {
 public:
  SphereMotion(const SpheresToCheck& asked, long every)
      : system_(asked.system),
        options_(asked.options),
        integrator_(system_->begin(asked.start, options_)),
        stages_(integrator_->traits().stages),
        node_(*system_, options_.form, integrator_->traits(), keeps_spheres(options_), every) {}

  std::string name() const override { return std::string(system_->name()); }
  MethodTraits traits() const override { return integrator_->traits(); }

  StepReport advance() override {
    const StepReport report = integrator_->advance();
    if (report.converged()) ++index_;
    return report;
  }
  std::string failure(const StepReport& report, long step) const override {
    return sphere_failure(report, step, time(), options_);
  }
  long evaluations(const StepReport& report) const override {
    return options_.tolerance > 0 || stages_ == 0 ? report.iterations : stages_;
  }

  long index() const override { return index_; }
  double time() const override { return double(index_) * options_.step; }
  double step_size() const override { return options_.step; }
  const Observables& look() override {
    node_.see(index_, time(), integrator_->point());
    return node_;
  }
  std::string why_not_cut() const override { return ""; }
  void keep_node() override {
    kept_ = integrator_->point();
    kept_time_ = time();
    rest_ = 1;
  }
  const Observables* look_within(double share) override {
    const std::optional<Points> inside = within(share);
    if (!inside) return nullptr;
    node_.see(index_, time_within(share), *inside);
    return &node_;
  }
  Changeable changeable() const override { return {.momenta = {{"", std::size_t(3 * system_->count())}}}; }
  StepReport change_within(double share, const MotionChange& change) override {
    StepReport report;
    const std::optional<Points> inside = within(share);
    if (!inside) return report;
    kept_time_ = time_within(share);
    rest_ *= 1 - share;
    kept_ = kicked(*inside, change.kick);
    const std::optional<Points> end = within(1);
    if (!end) return report;
    // What an integrator remembers of its steps is of another motion.
    integrator_ = system_->begin(*end, options_);
    report.status = SolveStatus::converged;
    return report;
  }
  std::vector<NamedVector> state() const override {
    const auto z = system_->in_form(integrator_->point(), options_.form, SphereForm::momenta);
    NamedVector directions{"directions", {}}, momenta{"momenta", {}};
    for (Eigen::Index i = 0; i < z.cols(); ++i) {
      directions.values.insert(directions.values.end(), z.col(i).data(), z.col(i).data() + 3);
      momenta.values.insert(momenta.values.end(), z.col(i).data() + 3, z.col(i).data() + 6);
    }
    return {std::move(directions), std::move(momenta)};
  }
  std::optional<double> defect() const override { return off_spheres(integrator_->point()); }
  bool is_judged_at_every_node() const override { return false; }

  void describe(RunResult& result) const override {
    if (options_.tolerance > 0) result.method += fmt::format(", tolerance {:g}", options_.tolerance);
    describe_spheres(*system_, options_.form, result);
  }
  void serialize(NumberArchive& archive) override {
    for (const double now : system_->from_files()) {
      double then = now;
      archive(then);
      if (then != now) throw RunError("the file that the scene's system is read from has changed; run the scene anew");
    }
    integrator_->serialize(archive);
    archive(index_);
  }

 private:
  using Points = SphereIntegrator::Points;

  double time_within(double share) const { return kept_time_ + share * rest_ * options_.step; }
  /// Where a share of the last step, or of what a change left of it, leads to; none where it does not converge.
  std::optional<Points> within(double share) const {
    SphereIntegratorOptions part = options_;
    part.step *= share * rest_;
    if (part.step == 0) return kept_;
    const auto step = system_->begin(kept_, part);
    if (!step->advance().converged()) return std::nullopt;
    return step->point();
  }
  /// With these vectors added to the momenta, as far as they are tangent to the spheres.
  Points kicked(const Points& z, const std::vector<double>& by) const {
    Points changed = system_->in_form(z, options_.form, SphereForm::momenta);
    for (Eigen::Index i = 0; i < changed.cols(); ++i) {
      const Vector<double, 3> q = changed.col(i).head<3>();
      const auto kick = Eigen::Map<const Vector<double, 3>>(by.data() + 3 * i);
      changed.col(i).tail<3>() += kick - q * (q.dot(kick) / q.squaredNorm());
    }
    return system_->in_form(changed, SphereForm::momenta, options_.form);
  }

  std::shared_ptr<const SphereSystem> system_;
  SphereIntegratorOptions options_;
  std::unique_ptr<SphereIntegrator> integrator_;
  int stages_;
  SphereNode node_;
  long index_ = 0;
  Points kept_;  ///< from which steps are made in part
  double kept_time_ = 0;
  double rest_ = 1;  ///< of a step, that begins there
};

}  // namespace

SphereScene read_spheres(const SphereEntry& entry, const Section& scene, const RunContext& context) {
  SphereScene out;
  SpheresToCheck& read = out.to_check;
  read.system = entry.read(scene);
  read.options = read_sphere_time(scene, entry, *read.system);
  read.start = read_start(scene, *read.system, read.options.form);
  out.extent = read_extent(scene, context);
  if (!out.extent.scene.empty())
    out.extent.scene = parse_scene(out.extent.scene, scene.file(), read.system->pinned()).whole();
  scene.choice("system", {std::string(entry.name)});
  scene.finish();
  out.methods = sphere_methods(entry, *read.system);
  out.motion = std::make_unique<SphereMotion>(read, out.extent.every);
  return out;
}

}  // namespace lagroid::app
