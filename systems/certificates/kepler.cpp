#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/kepler.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::Kepler&, const std::function<lagroid::State<lagroid::Kepler::GroupoidType>()>&);
