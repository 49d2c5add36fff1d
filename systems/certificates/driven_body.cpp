#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/driven_body.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::DrivenBody&, const std::function<lagroid::State<lagroid::DrivenBody::GroupoidType>()>&);
