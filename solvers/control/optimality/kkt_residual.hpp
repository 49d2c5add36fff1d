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

}  // namespace lagroid
