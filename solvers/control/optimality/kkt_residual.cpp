#include <lagroid/solvers/control/optimality/kkt_residual.hpp>
#include <lagroid/solvers/linear_algebra/row_sums.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lagroid {

namespace {

/// The larger; infinite where x is no number.
double larger(double most, double x) { return std::isnan(x) ? HUGE_VAL : std::max(most, x); }

/// Adds what is along a stage's variables. The displacements of its two nodes stand after one another.
void add_stage(const TranscriptionSizes& sizes, double factor, const double* along, long stage, std::size_t phase,
               TrajectoryDisplacement& out) {
  add_rows(out.nodes[stage], &factor, along, 1, 2 * sizes.node);
  add_rows(out.controls[stage], &factor, along + sizes.at_control(), 1, sizes.control);
  out.durations[phase] += factor * along[sizes.at_duration()];
}
/// Adds weighted rows of derivatives along a stage's variables.
void add_rows_of_stage(const TranscriptionSizes& sizes, const double* weights, const double* rows, int count,
                       long stage, std::size_t phase, TrajectoryDisplacement& out) {
  for (int i = 0; i < count; ++i) add_stage(sizes, weights[i], rows + i * sizes.variables(), stage, phase, out);
}
void add_bounds(const TranscriptionSizes& sizes, const TranscriptionPhase& phase, const double* weights, double* out) {
  const int general = sizes.general_inequality();
  for (std::size_t i = 0; i < phase.bounds.size(); ++i)
    out[phase.bounds[i].control] += weights[general + int(i)] * phase.bounds[i].sign;
}

void keep_fixed(const Transcription& transcription, TrajectoryDisplacement& out) {
  const TranscriptionSizes& sizes = transcription.sizes();
  long k = 0;
  for (std::size_t p = 0; p < sizes.phases.size(); ++p) {
    const TranscriptionPhase& phase = sizes.phases[p];
    if (!phase.duration_is_free) out.durations[p] = 0;
    for (std::size_t i = 0; i < phase.control_is_fixed.size(); ++i)
      if (phase.control_is_fixed[i])
        for (long stage = k; stage < phase.end; ++stage) out.controls[stage][i] = 0;
    k = phase.end;
  }
  for (int i = 0; i < sizes.node; ++i) {
    if (!transcription.free_start()[std::size_t(i)]) out.nodes[0][i] = 0;
    if (!transcription.free_end()[std::size_t(i)]) out.nodes[sizes.stages][i] = 0;
  }
}

}  // namespace

double KktResidual::largest() const { return std::max({stationarity, violation, complementarity, sign}); }

void lagrangian_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                         const StageRows& costates, const StageRows& weights, TrajectoryDisplacement& out) {
  const TranscriptionSizes& sizes = transcription.sizes();
  set_all(out, 0);
  long k = 0;
  for (std::size_t p = 0; p < sizes.phases.size(); ++p)
    for (; k < sizes.phases[p].end; ++k) {
      constexpr double one = 1;
      add_rows_of_stage(sizes, &one, derivatives.gradient[k], 1, k, p, out);
      add_rows_of_stage(sizes, costates[k], derivatives.equality[k], sizes.equalities_of(k), k, p, out);
      add_rows_of_stage(sizes, weights[k], derivatives.inequality[k], sizes.general_inequality(), k, p, out);
      add_bounds(sizes, sizes.phases[p], weights[k], out.controls[k]);
    }
  keep_fixed(transcription, out);
}

void add_inequality_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                             const StageRows& weights, TrajectoryDisplacement& out) {
  const TranscriptionSizes& sizes = transcription.sizes();
  long k = 0;
  for (std::size_t p = 0; p < sizes.phases.size(); ++p)
    for (; k < sizes.phases[p].end; ++k) {
      add_rows_of_stage(sizes, weights[k], derivatives.inequality[k], sizes.general_inequality(), k, p, out);
      add_bounds(sizes, sizes.phases[p], weights[k], out.controls[k]);
    }
  keep_fixed(transcription, out);
}

double largest_violation(const TranscriptionSizes& sizes, const StageValues& values) {
  double most = 0;
  for (long k = 0; k < sizes.stages; ++k) {
    for (int i = 0; i < sizes.equalities_of(k); ++i) most = larger(most, std::abs(values.equality[k][i]));
    for (int i = 0; i < sizes.inequality; ++i) most = larger(most, values.inequality[k][i]);
  }
  return most;
}

KktResidual kkt_residual(const Transcription& transcription, const StageValues& values,
                         const StageDerivatives& derivatives, const StageRows& costates, const StageRows& multipliers,
                         TrajectoryDisplacement& gradient) {
  lagrangian_gradient(transcription, derivatives, costates, multipliers, gradient);
  KktResidual out;
  out.stationarity = largest_entry(gradient);
  out.violation = largest_violation(transcription.sizes(), values);
  for (std::size_t i = 0; i < multipliers.numbers().size(); ++i) {
    const double z = multipliers.numbers()[i];
    out.complementarity = larger(out.complementarity, std::abs(z * values.inequality.numbers()[i]));
    out.sign = larger(out.sign, -z);
  }
  return out;
}

void lagrangian_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                         const StageRows& costates, const StageRows& multipliers, TrajectoryDisplacement& gradient,
                         KktRounding& rounding) {
  const TranscriptionSizes& sizes = transcription.sizes();
  const int n = sizes.node;
  const int c = sizes.control;
  const int d = sizes.variables();
  const int general = sizes.general_inequality();
  transcription.sizes_of_displaced(rounding.at);
  set_all(gradient, 0);
  set_all(rounding.gradient, 0);
  double* size = rounding.size.data();
  double* slopes = rounding.slopes.data();
  double* sizes_of_weights = rounding.sizes_of_weights.data();
  double* sum = rounding.sum.data();
  double* sum_of_sizes = rounding.sum_of_sizes.data();
  long k = 0;
  for (std::size_t p = 0; p < sizes.phases.size(); ++p)
    for (; k < sizes.phases[p].end; ++k) {
      copy_row(rounding.at.nodes[k], 2 * n, size);
      copy_row(rounding.at.controls[k], c, size + 2 * n);
      size[2 * n + c] = rounding.at.durations[p];
      std::fill(sum, sum + d, 0.0);
      std::fill(sum_of_sizes, sum_of_sizes + d, 0.0);
      // Adds weighted rows, and their sizes. Writes what functions with these rows are known to.
      const auto take = [&](const double* weights, const double* rows, int count, double* known_to) {
        for (int q = 0; q < count * d; ++q) slopes[q] = std::abs(rows[q]);
        for (int i = 0; i < count; ++i) {
          sizes_of_weights[i] = std::abs(weights[i]);
          known_to[i] = KktRounding::ulps * row_product(slopes + i * d, size, d);
        }
        add_rows(sum, weights, rows, count, d);
        add_rows(sum_of_sizes, sizes_of_weights, slopes, count, d);
      };
      constexpr double one = 1;
      double of_cost = 0;
      take(&one, derivatives.gradient[k], 1, &of_cost);
      take(costates[k], derivatives.equality[k], sizes.equalities_of(k), rounding.equality[k]);
      take(multipliers[k], derivatives.inequality[k], general, rounding.inequality[k]);
      for (std::size_t i = 0; i < sizes.phases[p].bounds.size(); ++i) {
        const ControlBound& bound = sizes.phases[p].bounds[i];
        const int at = general + int(i);
        rounding.inequality[k][at] = KktRounding::ulps * std::abs(bound.sign) * size[2 * n + bound.control];
        sum[2 * n + bound.control] += multipliers[k][at] * bound.sign;
        sum_of_sizes[2 * n + bound.control] += multipliers[k][at] * std::abs(bound.sign);
      }
      add_stage(sizes, 1, sum, k, p, gradient);
      add_stage(sizes, KktRounding::ulps, sum_of_sizes, k, p, rounding.gradient);
    }
  keep_fixed(transcription, gradient);
  keep_fixed(transcription, rounding.gradient);
}

double largest_violation(const TranscriptionSizes& sizes, const StageValues& values, const KktRounding& rounding) {
  double most = 0;
  for (long k = 0; k < sizes.stages; ++k) {
    for (int i = 0; i < sizes.equalities_of(k); ++i)
      most = larger(most, above(rounding.equality[k][i], values.equality[k][i]));
    for (int i = 0; i < sizes.inequality; ++i) most = larger(most, values.inequality[k][i] - rounding.inequality[k][i]);
  }
  return most;
}

double largest_entry(const TrajectoryDisplacement& gradient, const KktRounding& rounding) {
  double most = 0;
  const auto take = [&](const std::vector<double>& all, const std::vector<double>& known_to) {
    for (std::size_t i = 0; i < all.size(); ++i) most = larger(most, above(known_to[i], all[i]));
  };
  take(gradient.nodes.numbers(), rounding.gradient.nodes.numbers());
  take(gradient.controls.numbers(), rounding.gradient.controls.numbers());
  take(gradient.durations, rounding.gradient.durations);
  return most;
}

}  // namespace lagroid
