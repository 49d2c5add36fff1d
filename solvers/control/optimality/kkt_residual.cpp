#include <lagroid/solvers/control/optimality/kkt_residual.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid {

namespace {

/// The larger; infinite where x is no number.
double larger(double most, double x) { return std::isnan(x) ? HUGE_VAL : std::max(most, x); }

}  // namespace

double KktResidual::largest() const { return std::max({stationarity, violation, complementarity, sign}); }

void lagrangian_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                         const StageRows& costates, const StageRows& weights, TrajectoryDisplacement& out) {
  const TranscriptionSizes& sizes = transcription.sizes();
  const int n = sizes.node;
  const int d = sizes.variables();
  set_all(out.nodes, 0);
  std::fill(out.durations.begin(), out.durations.end(), 0.0);
  std::size_t phase = 0;
  for (long k = 0; k < sizes.stages; ++k) {
    if (k == sizes.phases[phase].end) ++phase;
    const int equalities = sizes.equalities_of(k);
    const auto component = [&](int q) {
      double sum = derivatives.gradient[k][q];
      for (int i = 0; i < equalities; ++i) sum += costates[k][i] * derivatives.equality[k][i * d + q];
      for (int i = 0; i < sizes.inequality; ++i) sum += weights[k][i] * derivatives.inequality[k][i * d + q];
      return sum;
    };
    for (int i = 0; i < n; ++i) {
      out.nodes[k][i] += component(i);
      out.nodes[k + 1][i] += component(n + i);
    }
    for (int i = 0; i < sizes.control; ++i) out.controls[k][i] = component(sizes.at_control() + i);
    const std::vector<bool>& fixed = sizes.phases[phase].control_is_fixed;
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i]) out.controls[k][i] = 0;
    out.durations[phase] += component(sizes.at_duration());
  }
  for (int i = 0; i < n; ++i) {
    if (!transcription.free_start()[std::size_t(i)]) out.nodes[0][i] = 0;
    if (!transcription.free_end()[std::size_t(i)]) out.nodes[sizes.stages][i] = 0;
  }
  for (std::size_t p = 0; p < sizes.phases.size(); ++p)
    if (!sizes.phases[p].duration_is_free) out.durations[p] = 0;
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

}  // namespace lagroid
