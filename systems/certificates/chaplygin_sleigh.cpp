#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/chaplygin_sleigh.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::ChaplyginSleigh&, const std::function<lagroid::State<lagroid::ChaplyginSleigh::GroupoidType>()>&);
