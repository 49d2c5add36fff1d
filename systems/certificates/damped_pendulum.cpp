#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/damped_pendulum.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::DampedPendulum&, const std::function<lagroid::State<lagroid::DampedPendulum::GroupoidType>()>&);
