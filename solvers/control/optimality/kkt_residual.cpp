#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/solvers/control/optimality/kkt_residual.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lagroid {

namespace {

/// The larger; infinite where x is no number.
double larger(double most, double x) { return std::isnan(x) ? HUGE_VAL : std::max(most, x); }

/// A row of derivatives over the variables of a stage, and what it is multiplied by.
struct WeightedRow {
  double weight;
  const double* row;
};

/// out += sum_i weight_i row_i, of so many variables from the first one on.
template <class RowAt> void add_rows(const RowAt& row_at, int rows, int first, int variables, double* out) {
  const auto add_few = [&]<int Count>(int q) {
    auto sum = Pack<double, Count>::load(out + q);
    for (int i = 0; i < rows; ++i) {
      const WeightedRow each = row_at(i);
      sum = sum + each.weight * Pack<double, Count>::load(each.row + first + q);
    }
    sum.store(out + q);
  };
  int q = 0;
  for (; q + 4 <= variables; q += 4) add_few.template operator()<4>(q);
  for (; q < variables; ++q) add_few.template operator()<1>(q);
}
/// The same of a whole stage. The displacements of its two nodes stand after one another.
template <class RowAt>
void add_rows_of_stage(const TranscriptionSizes& sizes, const RowAt& row_at, int rows, long stage, std::size_t phase,
                       TrajectoryDisplacement& out) {
  add_rows(row_at, rows, sizes.at_source, 2 * sizes.node, out.nodes[stage]);
  add_rows(row_at, rows, sizes.at_control(), sizes.control, out.controls[stage]);
  add_rows(row_at, rows, sizes.at_duration(), 1, &out.durations[phase]);
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
  const int d = sizes.variables();
  set_all(out.nodes, 0);
  set_all(out.controls, 0);
  std::fill(out.durations.begin(), out.durations.end(), 0.0);
  long k = 0;
  for (std::size_t p = 0; p < sizes.phases.size(); ++p)
    for (; k < sizes.phases[p].end; ++k) {
      const int equalities = sizes.equalities_of(k);
      const auto row_at = [&](int i) -> WeightedRow {
        if (i == 0) return {1, derivatives.gradient[k]};
        --i;
        if (i < equalities) return {costates[k][i], derivatives.equality[k] + i * d};
        i -= equalities;
        return {weights[k][i], derivatives.inequality[k] + i * d};
      };
      add_rows_of_stage(sizes, row_at, 1 + equalities + sizes.general_inequality(), k, p, out);
      add_bounds(sizes, sizes.phases[p], weights[k], out.controls[k]);
    }
  keep_fixed(transcription, out);
}

void add_inequality_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                             const StageRows& weights, TrajectoryDisplacement& out) {
  const TranscriptionSizes& sizes = transcription.sizes();
  const int d = sizes.variables();
  long k = 0;
  for (std::size_t p = 0; p < sizes.phases.size(); ++p)
    for (; k < sizes.phases[p].end; ++k) {
      const auto row_at = [&](int i) -> WeightedRow { return {weights[k][i], derivatives.inequality[k] + i * d}; };
      add_rows_of_stage(sizes, row_at, sizes.general_inequality(), k, p, out);
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

void kkt_rounding(const Transcription& transcription, const StageDerivatives& derivatives, const StageRows& costates,
                  const StageRows& multipliers, KktRounding& out) {
  const TranscriptionSizes& sizes = transcription.sizes();
  const int n = sizes.node;
  const int c = sizes.control;
  transcription.sizes_of_displaced(out.at);
  set_all(out.gradient.nodes, 0);
  set_all(out.gradient.controls, 0);
  std::fill(out.gradient.durations.begin(), out.gradient.durations.end(), 0.0);
  long k = 0;
  for (std::size_t p = 0; p < sizes.phases.size(); ++p)
    for (; k < sizes.phases[p].end; ++k) {
      const double* at_nodes = out.at.nodes[k];
      const double* at_controls = out.at.controls[k];
      double* nodes = out.gradient.nodes[k];
      double* controls = out.gradient.controls[k];
      double& duration = out.gradient.durations[p];
      // Adds |weight row| to the sizes of the gradient's terms. Returns what a function with that row is known to.
      const auto take = [&](double weight, const double* row) {
        const double unit = KktRounding::ulps * std::abs(weight);
        double sum = 0;
        const auto add = [&](double slope, double size, double& term) {
          sum += std::abs(slope) * size;
          term += unit * std::abs(slope);
        };
        for (int q = 0; q < 2 * n; ++q) add(row[q], at_nodes[q], nodes[q]);
        for (int q = 0; q < c; ++q) add(row[2 * n + q], at_controls[q], controls[q]);
        add(row[2 * n + c], out.at.durations[p], duration);
        return KktRounding::ulps * sum;
      };
      take(1, derivatives.gradient[k]);
      for (int i = 0; i < sizes.equalities_of(k); ++i)
        out.equality[k][i] = take(costates[k][i], derivatives.equality[k] + i * sizes.variables());
      const int general = sizes.general_inequality();
      for (int i = 0; i < general; ++i)
        out.inequality[k][i] = take(multipliers[k][i], derivatives.inequality[k] + i * sizes.variables());
      for (std::size_t i = 0; i < sizes.phases[p].bounds.size(); ++i) {
        const ControlBound& bound = sizes.phases[p].bounds[i];
        const double unit = KktRounding::ulps * std::abs(bound.sign);
        out.inequality[k][general + int(i)] = unit * at_controls[bound.control];
        controls[bound.control] += unit * multipliers[k][general + int(i)];
      }
    }
  keep_fixed(transcription, out.gradient);
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
