#pragma once
/// How far a trajectory with its multipliers is from optimal, in the numbers of the problem itself, unscaled:
///
///     |d(l + <lambda, phi> + <z, gamma>)|,    |phi| and gamma's positive part,    |z gamma|,    z's negative part.
///
///     transcription.values(values);
///     transcription.derivatives(lambda, z, derivatives);
///     const KktResidual left = kkt_residual(transcription, values, derivatives, lambda, z, work);
///
/// Requires values and derivatives of the trajectory where it stands. Each is the largest over all stages; infinite
/// where an entry is no number. No allocation. Nothing throws.

#include <lagroid/solvers/control/transcription.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace lagroid {

struct KktResidual {
  double stationarity = 0;     ///< of the Lagrangian's gradient along displacements
  double violation = 0;        ///< of |phi| and of gamma's positive part
  double complementarity = 0;  ///< of |z gamma|
  double sign = 0;             ///< of -z

  double largest() const;
};

/// d(l + <costates, phi> + <weights, gamma>) along displacements; zero along what is fixed.
void lagrangian_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                         const StageRows& costates, const StageRows& weights, TrajectoryDisplacement& out);

/// Adds d<weights, gamma>, likewise.
void add_inequality_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                             const StageRows& weights, TrajectoryDisplacement& out);

/// The largest of |phi| and of gamma's positive part.
double largest_violation(const TranscriptionSizes& sizes, const StageValues& values);

/// `gradient` is where the Lagrangian's gradient is left.
KktResidual kkt_residual(const Transcription& transcription, const StageValues& values,
                         const StageDerivatives& derivatives, const StageRows& costates, const StageRows& multipliers,
                         TrajectoryDisplacement& gradient);

/// What rounding may leave of each part of the residual, ten ulps of the sizes of what is added up in it: a constraint
/// f(x) is known to eps sum_j |df/dx_j| |x_j|, a component of the gradient to eps times the sizes of its terms.
struct KktRounding {
  KktRounding() = default;
  explicit KktRounding(const TranscriptionSizes& sizes)
      : equality(sizes.stages, sizes.equality),
        inequality(sizes.stages, sizes.inequality),
        gradient(sizes),
        at(sizes),
        size(std::size_t(sizes.variables())),
        sum(size),
        sum_of_sizes(size),
        sizes_of_weights(std::size_t(1 + sizes.equality + sizes.inequality)),
        slopes(sizes_of_weights.size() * size.size()) {}
  StageRows equality;
  StageRows inequality;
  TrajectoryDisplacement gradient;  ///< zero along what is fixed
  TrajectoryDisplacement at;        ///< |x_j|, of what is displaced
  // Of a stage: workspace.
  std::vector<double> size, sum, sum_of_sizes;  // along its variables
  std::vector<double> sizes_of_weights, slopes;

  static constexpr double ulps = 10 * std::numeric_limits<double>::epsilon();
  /// The largest sum of magnitudes that a component of the gradient is made of.
  double largest_term() const { return largest_entry(gradient) / ulps; }
};

/// The Lagrangian's gradient and what rounding may leave, in one pass.
void lagrangian_gradient(const Transcription& transcription, const StageDerivatives& derivatives,
                         const StageRows& costates, const StageRows& multipliers, TrajectoryDisplacement& gradient,
                         KktRounding& rounding);

/// What of |x| is more than rounding leaves; no number where x is none.
inline double above(double rounding, double x) { return std::abs(x) <= rounding ? 0 : std::abs(x) - rounding; }

/// The largest of |phi| and of gamma's positive part, of what is more than rounding leaves.
double largest_violation(const TranscriptionSizes& sizes, const StageValues& values, const KktRounding& rounding);

/// The same of the gradient's components.
double largest_entry(const TrajectoryDisplacement& gradient, const KktRounding& rounding);

}  // namespace lagroid
