#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/unicycle.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::Unicycle&, const std::function<lagroid::State<lagroid::Unicycle::GroupoidType>()>&);
