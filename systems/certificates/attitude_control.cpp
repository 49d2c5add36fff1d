#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/attitude_control.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::AttitudeControl&, const std::function<lagroid::State<lagroid::AttitudeControl::GroupoidType>()>&);
