#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/heavy_top.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::HeavyTop&, const std::function<lagroid::State<lagroid::HeavyTop::GroupoidType>()>&);
