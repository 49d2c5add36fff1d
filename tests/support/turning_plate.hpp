#pragma once
// A ball that rolls on a turning plate, for tests of both principles.
#include <lagroid/systems/rolling/rolling_ball.hpp>

#include <complex>

using Plane = lagroid::RollingBall::GroupoidType;

inline lagroid::RollingBall ball_on_turning_plate() {
  lagroid::RollingBall ball;
  ball.plate_rate = 1.3;
  ball.radius = 0.8;
  ball.mass = 1.5;
  return ball;
}
inline lagroid::State<Plane> start_of(const lagroid::RollingBall& ball) {
  return ball.rolling({0.3, -0.2}, {0.4, 0.1}, 0.7);
}

inline std::complex<double> position_of(const lagroid::State<Plane>& s) {
  const auto& q = std::get<0>(s.object);
  return {q(0), q(1)};
}
