#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/rigid_body.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::RigidBody&, const std::function<lagroid::State<lagroid::RigidBody::GroupoidType>()>&);
