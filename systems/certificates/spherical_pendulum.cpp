#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::SphericalPendulum&,
    const std::function<lagroid::State<lagroid::SphericalPendulum::GroupoidType>()>&);
