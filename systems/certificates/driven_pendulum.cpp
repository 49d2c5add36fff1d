#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/driven_pendulum.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::DrivenPendulum&, const std::function<lagroid::State<lagroid::DrivenPendulum::GroupoidType>()>&);
