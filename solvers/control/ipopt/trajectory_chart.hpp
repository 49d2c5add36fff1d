#pragma once
/// The trajectories about one as a vector space, for solvers that know no other: x = (v_0 ... v_N, du_0 ... du_{N-1},
/// t) stands for
///
///     g_k -> tau(v_k)^{-1} g_k tau(v_{k+1}),    u_k -> u_k + du_k,    h -> h exp(t),
///
/// t of each phase, of the trajectory where the chart has its origin. A Transcription has its derivatives along
/// displacements of the trajectory where it stands; those by x follow through the retraction,
///
///     tau(v)^{-1} tau(v + e) = tau(a(e)),    a = D e + e^T Q e / 2 + ...,    df/dv = df/da D.
///
///     TrajectoryChartOf<SwingUp> chart(task, straight_trajectory(task, 100));
///     chart.stand_at(x);
///     chart.transcription().values(at);
///
/// Requires displacements within reach of the retraction (for a rotation, less than half a turn by tau's measure).
/// Nothing throws; values that are not finite are the caller's to notice.

#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/solvers/control/transcription_of.hpp>

#include <utility>
#include <vector>

namespace lagroid {

class TrajectoryChart {
 public:
  /// D (n x n) and Q (n times n x n), row by row.
  struct Retraction {
    double* first;
    double* second;
  };
  struct Range {
    double least;
    double most;
  };

  virtual ~TrajectoryChart() = default;
  /// Of the trajectory at x, where it stands.
  virtual const Transcription& transcription() const = 0;
  virtual void stand_at(const TrajectoryDisplacement& x) = 0;
  /// How node k's displacement from where it stands, at x_k = v, depends on x_k.
  virtual void retraction(long node, const double* v, Retraction out) const = 0;
  /// The bounds of a control as bounds of du.
  virtual Range control_range(long stage, int control) const = 0;
  /// How many rows of gamma there are before those of the bounds: of each control the upper, then the lower.
  virtual int inequalities_before_bounds() const = 0;
};

template <class Sys> class TrajectoryChartOf final : public TrajectoryChart {
 public:
  using G = typename Sys::GroupoidType;

  TrajectoryChartOf(const ControlTask<Sys>& task, ControlTrajectory<Sys> origin)
      : task_(task),
        phases_(phases_of(task, long(origin.arrows.size()))),
        here_(task, std::move(origin)),
        origin_(here_.trajectory()) {}

  const ControlTrajectory<Sys>& trajectory() const { return here_.trajectory(); }
  const Transcription& transcription() const override { return here_; }

  void stand_at(const TrajectoryDisplacement& x) override {
    here_.stand_at(origin_, task_.boundary);
    here_.try_displacement(x, 1);
    here_.accept();
  }

  void retraction(long node, const double* v, Retraction out) const override {
    using J = SecondJet<double, n>;
    const G& groupoid = task_.system.groupoid;
    const auto q =
        node == 0 ? groupoid.source(origin_.arrows.front()) : groupoid.target(origin_.arrows[std::size_t(node - 1)]);
    Vector<double, n> at;
    Vector<J, n> near;
    for (int i = 0; i < n; ++i) {
      at(i) = v[i];
      near(i) = J::variable(v[i], i);
    }
    const ArrowOf<G, J> back = groupoid.template cast<J>(groupoid.inverse(groupoid.tau(q, at)));
    const ArrowOf<G, J> forth = groupoid.tau(groupoid.template cast_object<J>(q), near);
    const Vector<J, n> a = groupoid.tau_inverse(ArrowOf<G, J>(groupoid.multiply(back, forth)));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        out.first[i * n + j] = a(i).gradient(j);
        for (int l = 0; l < n; ++l) out.second[(i * n + j) * n + l] = a(i).hessian(j, l);
      }
  }

  Range control_range(long stage, int control) const override {
    const double u = origin_.controls[std::size_t(stage)](control);
    const ControlPhase<Sys>& phase = phases_[std::size_t(here_.sizes().phase_of(stage))];
    return {phase.lower(control) - u, phase.upper(control) - u};
  }
  int inequalities_before_bounds() const override { return here_.before_bounds(); }

 private:
  static constexpr int n = Sys::dimension;

  ControlTask<Sys> task_;
  std::vector<ControlPhase<Sys>> phases_;
  TranscriptionOf<Sys> here_;
  ControlTrajectory<Sys> origin_;
};

}  // namespace lagroid
