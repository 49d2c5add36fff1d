#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/rolling_ball.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::RollingBall&, const std::function<lagroid::State<lagroid::RollingBall::GroupoidType>()>&);
