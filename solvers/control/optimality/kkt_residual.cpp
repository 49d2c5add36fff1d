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
  out.duration = 0;
  for (long k = 0; k < sizes.stages; ++k) {
    const auto component = [&](int q) {
      double sum = derivatives.gradient[k][q];
      for (int i = 0; i < sizes.equalities_of(k); ++i) sum += costates[k][i] * derivatives.equality[k][i * d + q];
      for (int i = 0; i < sizes.inequality; ++i) sum += weights[k][i] * derivatives.inequality[k][i * d + q];
      return sum;
    };
    for (int i = 0; i < n; ++i) {
      out.nodes[k][i] += component(i);
      out.nodes[k + 1][i] += component(n + i);
    }
    for (int i = 0; i < sizes.control; ++i) out.controls[k][i] = component(sizes.at_control() + i);
    out.duration += component(sizes.at_duration());
  }
  for (int i = 0; i < n; ++i) {
    if (!transcription.free_start()[std::size_t(i)]) out.nodes[0][i] = 0;
    if (!transcription.free_end()[std::size_t(i)]) out.nodes[sizes.stages][i] = 0;
  }
  if (!transcription.duration_is_free()) out.duration = 0;
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
