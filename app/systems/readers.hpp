#pragma once
/// From scenes to tasks. Every key of a scene is read and checked, and unknown ones are refused, before anything is
/// computed.

#include "../reading/scene_reader.hpp"
#include "../reading/task.hpp"

#include <lagroid/systems/attitude_control.hpp>
#include <lagroid/systems/chaplygin_sleigh.hpp>
#include <lagroid/systems/damped_pendulum.hpp>
#include <lagroid/systems/driven_body.hpp>
#include <lagroid/systems/driven_pendulum.hpp>
#include <lagroid/systems/heavy_top.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulum.hpp>
#include <lagroid/systems/plate_ball.hpp>
#include <lagroid/systems/rigid_body.hpp>
#include <lagroid/systems/rolling_ball.hpp>
#include <lagroid/systems/rolling_disk.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>
#include <lagroid/systems/unicycle.hpp>

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace lagroid::app {

/// Refuses parameters whose product overflows, or is too small to keep its digits.
inline void require_digits(const Section& parameters, std::string_view key, std::string_view product, double value) {
  if (!std::isnormal(value))
    parameters.fail(key, fmt::format("makes {} = {:g}, too {} to keep its digits; choose other units", product, value,
                                     value < 1 ? "small" : "large"));
}

Task<PlateBall> read_plate_ball(const Section& scene, const RunContext& context);
Task<Unicycle> read_unicycle(const Section& scene, const RunContext& context);
Task<AttitudeControl> read_attitude_control(const Section& scene, const RunContext& context);
Task<RigidBody> read_rigid_body(const Section& scene, const RunContext& context);
Task<HeavyTop> read_heavy_top(const Section& scene, const RunContext& context);
Task<Pendulum> read_pendulum(const Section& scene, const RunContext& context);
Task<Kepler> read_kepler(const Section& scene, const RunContext& context);
Task<SphericalPendulum> read_spherical_pendulum(const Section& scene, const RunContext& context);
Task<RollingBall> read_rolling_ball(const Section& scene, const RunContext& context);
Task<RollingDisk> read_rolling_disk(const Section& scene, const RunContext& context);
Task<ChaplyginSleigh> read_chaplygin_sleigh(const Section& scene, const RunContext& context);
Task<DampedPendulum> read_damped_pendulum(const Section& scene, const RunContext& context);
Task<DrivenPendulum> read_driven_pendulum(const Section& scene, const RunContext& context);
Task<DrivenBody> read_driven_body(const Section& scene, const RunContext& context);

}  // namespace lagroid::app
