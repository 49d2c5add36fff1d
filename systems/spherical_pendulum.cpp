#include <lagroid/systems/spherical_pendulum.hpp>

template lagroid::TwoSidedOf<lagroid::SphericalPendulum> lagroid::automatic_two_sided(
    const SphericalPendulum&, const ArrowOf<Pair<3>>&, const SphericalPendulum::Multipliers&);
