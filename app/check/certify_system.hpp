#pragma once
/// The laws of a system, tested along the run of its scene: at states of the run, with momenta changed by up to a tenth
/// of the largest.
///
///     const Certificate found = certify(module.task(scene, context), {.samples = 100});
///
/// Returns a Certificate; where the run itself fails, one of the laws of the groupoid alone, at objects that the run
/// came to, whose `failure` is the reason: a groupoid that is none has no steps.

#include "../scenes/system_module.hpp"
#include "check_options.hpp"

#include <lagroid/core/reduction/reconstruction.hpp>
#include <lagroid/core/testing/property.hpp>
#include <lagroid/run/ledger/certificate.hpp>
#include <lagroid/solvers/generating/constrained_momentum.hpp>
#include <lagroid/systems/certificates.hpp>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace checking {

/// Points of a run, evenly spread and never more than a few thousand.
template <class Sys> class Thinned {
 public:
  void add(const TrajectoryPoint<Sys>& point) {
    if (point.index % stride_ != 0) return;
    points_.push_back(point);
    if (points_.size() < 4096) return;
    for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
    points_.resize(points_.size() / 2);
    stride_ *= 2;
  }
  const std::vector<TrajectoryPoint<Sys>>& points() const { return points_; }

 private:
  std::vector<TrajectoryPoint<Sys>> points_;
  long stride_ = 1;
};

/// A state of the run, its momentum moved by a tenth of the largest.
template <DiscreteSystem Sys>
State<typename Sys::GroupoidType> draw_state(const Sys& system, const std::vector<TrajectoryPoint<Sys>>& points,
                                             double largest) {
  auto state = points[*rc::gen::inRange<std::size_t>(0, points.size())].state;
  const double size = 0.1 * largest;
  for (double& x : state.momentum) x += size * laws::draw_uniform();
  state.momentum = tangent_momentum(system, state);
  return state;
}

}  // namespace checking

namespace checking {

/// Whether the system descends along each reduction that it declares, where the run starts; and the laws of the system
/// that the scene is reduced to.
template <DiscreteSystem Sys>
void examine_reductions(const PreparedScene<Sys>& prepared, const TrajectoryPoint<Sys>& start,
                        const std::function<State<typename Sys::GroupoidType>()>& draw, Certificate& certificate) {
  const auto arrows = arrows_about(prepared.system.groupoid, start.state.object);
  for_each_reduction<Sys>([&]<class Declared>(const Declared& declared) {
    ReductionFinding found;
    found.name = declared.name;
    found.groupoid = Declared::Codomain::name();
    found.is_claimed = prepared.reduced_by == declared.name;
    try {
      const Reconstruction<Sys, Declared> down(declared, prepared.system, start.state, start.configuration);
      const DescentReport report = examine_reduction(down, arrows);
      for (const DescentFinding& each : report.findings) found.defect = std::max(found.defect, each.defect);
      found.why_not = report.sentence();
      if (found.is_claimed)
        for (laws::LawReport& suite : laws::reduced_certificate<Sys>(prepared.system, declared.name, draw))
          certificate.suites.push_back(std::move(suite));
    } catch (const NotFree& nothing_to_reduce_to) {
      found.why_not = nothing_to_reduce_to.what();
    }
    certificate.reductions.push_back(std::move(found));
  });
}

}  // namespace checking

template <DiscreteSystem Sys>
Certificate certify(const PreparedScene<Sys>& prepared, const CheckCommandOptions& options) {
  checking::Thinned<Sys> run;
  const RunResult result = prepared.run([&](const TrajectoryPoint<Sys>& point) { run.add(point); });
  auto points = run.points();
  std::vector<Step<Sys>> steps;
  double largest = 0;
  for (const auto& point : points) {
    if (point.index > 0) steps.push_back(point.step);
    largest = std::max(largest, point.state.momentum.norm());
  }
  // From the last one there need not be another step: the end of a boundary value.
  if (points.size() > 1) points.pop_back();

  Certificate certificate;
  certificate.system = result.system;
  certificate.groupoid = Sys::GroupoidType::name();
  certificate.states = points.size();
  certificate.samples = options.samples;
  certificate.seed = options.seed;
  if (!result.converged()) {
    certificate.failure = result.message;
    certificate.failure_status = result.status;
    const auto state = [&] { return points[*rc::gen::inRange<std::size_t>(0, points.size())].state; };
    if (!points.empty()) certificate.suites = laws::groupoid_certificate<Sys>(prepared.system, state);
    return certificate;
  }
  certificate.suites =
      laws::certificate<Sys>(prepared.system, [&] { return checking::draw_state(prepared.system, points, largest); });
  if constexpr (HasReductions<Sys>)
    checking::examine_reductions<Sys>(
        prepared, run.points().front(), [&] { return checking::draw_state(prepared.system, points, largest); },
        certificate);
  if constexpr (requires { prepared.system.symmetries(); }) {
    for (const auto& symmetry : prepared.system.symmetries()) {
      const auto found = examine<Sys>(prepared.system, symmetry, steps);
      certificate.symmetries.push_back(
          {symmetry.name, std::string(to_string(found.kind)), found.defect, found.kind != SymmetryKind::none});
    }
  }
  return certificate;
}

/// Of the system of the library that the module is of.
Certificate certify_system(const SystemModule& module, const Section& scene, const CheckCommandOptions& options);

}  // namespace lagroid::app
