#include <lagroid/systems/pendulum.hpp>

template lagroid::GradientsOf<lagroid::Pendulum> lagroid::automatic_gradients(const Pendulum&, const ArrowOf<Pair<1>>&,
                                                                              const Pendulum::Multipliers&);
template lagroid::TwoSidedOf<lagroid::Pendulum> lagroid::automatic_two_sided(const Pendulum&, const ArrowOf<Pair<1>>&,
                                                                             const Pendulum::Multipliers&);
template lagroid::SecondDerivativesOf<lagroid::Pendulum> lagroid::second_derivatives(const Pendulum&,
                                                                                     const ArrowOf<Pair<1>>&,
                                                                                     const Pendulum::Multipliers&);
