#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/plate_ball.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::PlateBall&, const std::function<lagroid::State<lagroid::PlateBall::GroupoidType>()>&);
