#pragma once
/// The paths of a controlled scene about one as a vector space, for solvers that know no other (TrajectoryChart):
/// places and momenta by what is added to them, attitudes by tau(v), controls and the duration as in any chart.
///
///     SceneChart chart(scene, scene_guess(scene, 0));
///     const IpoptSolution found = solve_by_ipopt(chart, options);
///
/// Nodes are displaced straight, without regard to the joints: coordinates along which these are linear reach as far as
/// a joint bends, and a chart is to hold the whole way to a solution. The stages' equations are the same.
///
/// Requires what SceneTranscription does. The scene must outlive the chart, and serves no other transcription
/// meanwhile. Nothing throws, except `solve_scene_by_ipopt` in a build without IPOPT: MissingLibrary.

#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/systems/multibody/control/scene_search.hpp>

namespace lagroid::multibody {

class SceneChart final : public TrajectoryChart {
 public:
  SceneChart(ControlledScene& scene, ScenePath origin);

  const ScenePath& path() const { return here_.path(); }
  const Transcription& transcription() const override { return here_; }
  void stand_at(const TrajectoryDisplacement& x) override;
  void retraction(long node, const double* v, Retraction out) const override;
  Range control_range(long stage, int control) const override;
  int inequalities_before_bounds() const override { return here_.before_bounds(); }

 private:
  ControlledScene& scene_;
  ScenePath origin_;
  SceneTranscription here_;
};

/// `solve_scene` by IPOPT, from the same start to the same tolerance (ipopt_control.hpp): a check by another's hand.
SceneSolution solve_scene_by_ipopt(ControlledScene& scene, ScenePath start, const ControlOptions& options = {});

}  // namespace lagroid::multibody
