#pragma once
/// An integrator of a full system whose steps are those of its reduction: what is seen of it is the full motion.
///
/// Loop, recorder, ledger and checkpoints then take a reduced run as any other.
///
///     Reconstruction<Kepler, Reduction<PolarQuotient>> down(declared, kepler, state, configuration);
///     ReducedIntegrator<Kepler, Reduction<PolarQuotient>> orbit(down, {});
///     while (orbit.advance().converged()) std::cout << orbit.point().state.object.transpose() << '\n';
///
/// Requires the methods of the reduced system (integrator_methods.hpp). Errors are those of `make_integrator`.

#include <lagroid/core/reduction/reconstruction.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>

#include <memory>
#include <utility>

namespace lagroid {

template <DiscreteSystem Sys, class Declared> class ReducedIntegrator final : public Integrator<Sys> {
 public:
  using Down = Reconstruction<Sys, Declared>;
  using Below = typename Down::Below;

  ReducedIntegrator(const Down& down, const IntegratorOptions& options)
      : down_(down),
        below_(make_integrator(down.system(), down.initial(), down.configuration(), options)),
        is_one_arrow_(options.composition.stages() == 1),
        before_(down_),
        kept_(down_),
        point_(down_.full(below_->point())),
        kept_point_(point_),
        point_before_(below_->point()) {}

  StepReport advance() override {
    if (!is_one_arrow_) {
      before_ = down_;
      point_before_ = below_->point();
    }
    const StepReport report = below_->advance();
    if (!report.converged()) return report;
    below_->for_each_inner_stage([&](const Step<Below>& step, double, double size) { down_.join(step, size); });
    down_.join(below_->point().step, below_->point().step_size);
    point_ = down_.full(below_->point());
    return report;
  }
  const TrajectoryPoint<Sys>& point() const override { return point_; }
  MethodTraits traits() const override { return below_->traits(); }
  /// Each is lifted from where the one before it ends.
  void for_each_inner_stage(const typename Integrator<Sys>::Visit& visit) const override {
    if (is_one_arrow_) return;
    Down down = before_;
    TrajectoryPoint<Below> end = point_before_;
    const auto& groupoid = down.system().groupoid;
    below_->for_each_inner_stage([&](const Step<Below>& step, double start, double size) {
      down.join(step, size);
      ++end.index;
      end.time = start + size;
      end.step_size = size;
      end.step = step;
      end.configuration = groupoid.project(groupoid.compose(end.configuration, step.arrow));
      end.state.object = groupoid.target(end.configuration);
      visit(down.full(end).step, start, size);
    });
  }
  /// Steps of one arrow can be made in part: the full motion knows of each arrow below.
  bool cuts() const override { return is_one_arrow_ && below_->cuts(); }
  void keep_node() override {
    below_->keep_node();
    kept_ = down_;
    kept_point_ = point_;
  }
  [[gnu::cold]] StepReport cut(double share, TrajectoryPoint<Sys>& to,
                               const typename Integrator<Sys>::Visit& = {}) override {
    if (share == 0) {
      to = kept_point_;
      return {SolveStatus::converged};
    }
    TrajectoryPoint<Below> inside;
    const StepReport report = below_->cut(share, inside);
    if (!report.converged()) return report;
    Down down = kept_;
    down.join(inside.step, inside.step_size);
    to = down.full(inside);
    return report;
  }
  long without_root() const override { return below_->without_root(); }
  void serialize(NumberArchive& archive) override {
    below_->serialize(archive);
    down_.serialize(archive);
    if (archive.reading()) point_ = down_.full(below_->point());
  }

  /// The reduced run, and how the full one is made of it.
  const TrajectoryPoint<Below>& point_below() const { return below_->point(); }
  const Down& down() const { return down_; }

 private:
  Down down_;
  std::unique_ptr<Integrator<Below>> below_;
  bool is_one_arrow_;
  Down before_;  ///< of composed steps: at the node before
  Down kept_;    ///< at the node from which steps are made in part
  TrajectoryPoint<Sys> point_, kept_point_;
  TrajectoryPoint<Below> point_before_;
};

}  // namespace lagroid
