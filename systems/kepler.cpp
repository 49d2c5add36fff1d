#include <lagroid/systems/kepler.hpp>

template lagroid::GradientsOf<lagroid::Kepler> lagroid::automatic_gradients(const Kepler&, const ArrowOf<Pair<2>>&,
                                                                            const Kepler::Multipliers&);
template lagroid::TwoSidedOf<lagroid::Kepler> lagroid::automatic_two_sided(const Kepler&, const ArrowOf<Pair<2>>&,
                                                                           const Kepler::Multipliers&);
template lagroid::SecondDerivativesOf<lagroid::Kepler> lagroid::second_derivatives(const Kepler&,
                                                                                   const ArrowOf<Pair<2>>&,
                                                                                   const Kepler::Multipliers&);
