#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/pendulum.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::Pendulum&, const std::function<lagroid::State<lagroid::Pendulum::GroupoidType>()>&);
