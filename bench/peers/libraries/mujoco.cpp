// MuJoCo, as its documentation (Computation: Numerical integration) describes: RK4 for smooth conservative motion,
// Euler the default, "implicit" for fast spinning bodies. Contacts and damping are off; there is nothing to collide.
#include "libraries.hpp"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

namespace peers {

namespace {

using Model = std::shared_ptr<mjModel>;
using Data = std::shared_ptr<mjData>;

Model load(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "model.xml", int(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[1000] = "";
  Model loaded(mj_loadXML("model.xml", files.get(), error, sizeof error), mj_deleteModel);
  mj_deleteVFS(files.get());
  if (!loaded) throw std::runtime_error(fmt::format("MuJoCo: {}", error));
  return loaded;
}

std::string with_options(const char* integrator, double step, double gravity, const std::string& bodies) {
  return fmt::format(
      "<mujoco><option timestep='{:.17g}' gravity='0 0 {:.17g}' integrator='{}' iterations='1'>"
      "<flag contact='disable'/></option><worldbody>{}</worldbody></mujoco>",
      step, -gravity, integrator, bodies);
}

/// MuJoCo starts a diverging run anew, and goes on: that is seen in the errors, and need not be printed.
void disregard(const char*) {}

/// `set` gives the data their first velocities, `coordinates` reads them.
template <class P, class Set, class Coordinates>
Method stepped(const P& problem, const char* integrator, double order, double gravity, const std::string& bodies,
               const Set& set, const Coordinates& coordinates) {
  return engine_steps(problem, "MuJoCo", integrator, order, 0.5 * problem.unit(), [=](double h) {
    const Model model = load(with_options(integrator, h, gravity, bodies));
    const Data data(mj_makeData(model.get()), mj_deleteData);
    mju_user_warning = disregard;
    set(*data);
    mj_forward(model.get(), data.get());
    return std::pair([=] { mj_step(model.get(), data.get()); }, [=] { return coordinates(*model, *data); });
  });
}

/// The name, and the order that the errors show.
struct Integrator {
  const char* name;
  double order;
};
constexpr Integrator integrators[] = {{"RK4", 2}, {"Euler", 1}, {"implicit", 1}};

}  // namespace

Methods mujoco_methods(const RigidBodyProblem& problem) {
  const auto set = [=](mjData& data) {
    for (int i = 0; i < 3; ++i) data.qvel[3 + i] = problem.momentum[std::size_t(i)] / (i + 1);
  };
  // qpos: place and quaternion; qvel: velocity in space and angular velocity in the body.
  const auto coordinates = [](const mjModel&, const mjData& data) {
    return attitude_and_momentum<double>(
        {data.qpos[3], data.qpos[4], data.qpos[5], data.qpos[6], data.qvel[3], 2 * data.qvel[4], 3 * data.qvel[5]});
  };
  Methods out;
  for (const Integrator& integrator : integrators)
    out.push_back(stepped(problem, integrator.name, integrator.order, 0,
                          "<body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 2 3'/></body>", set,
                          coordinates));
  return out;
}

/// Bodies in one another, each with a ball joint at its upper end and a small ball at its lower one: a body without
/// extent is none to MuJoCo. This extent changes the motion by parts in 10^8.
Methods mujoco_methods(const ChainProblem& problem) {
  std::string bodies;
  const auto places = problem.places();
  std::array<double, 3> parent{};
  std::array<double, 3> joint{};
  for (std::size_t i = 0; i < ChainProblem::links; ++i) {
    const std::array<double, 3> place{places[3 * i], places[3 * i + 1], places[3 * i + 2]};
    bodies += fmt::format(
        "<body pos='{:.17g} {:.17g} {:.17g}'><joint type='ball'/><inertial pos='{:.17g} {:.17g} {:.17g}' "
        "mass='{:.17g}' diaginertia='1e-12 1e-12 1e-12'/>",
        joint[0] - parent[0], joint[1] - parent[1], joint[2] - parent[2], place[0] - joint[0], place[1] - joint[1],
        place[2] - joint[2], 1.0 / ChainProblem::links);
    parent = joint;
    joint = place;
  }
  for (int i = 0; i < ChainProblem::links; ++i) bodies += "</body>";
  // Places and velocities belong to the start of a step until they are computed anew.
  const auto coordinates = [](const mjModel& model, mjData& data) {
    mj_fwdPosition(&model, &data);
    mj_fwdVelocity(&model, &data);
    std::array<double, ChainProblem::compared> out;
    for (std::size_t i = 0; i < ChainProblem::links; ++i) {
      mjtNum velocity[6];
      mj_objectVelocity(&model, &data, mjOBJ_BODY, int(i) + 1, velocity, 0);
      for (std::size_t k = 0; k < 3; ++k) {
        out[3 * i + k] = data.xipos[3 * (i + 1) + k];
        out[3 * (ChainProblem::links + i) + k] = velocity[3 + k];
      }
    }
    return out;
  };
  Methods out;
  for (const Integrator& integrator : integrators)
    out.push_back(stepped(
        problem, integrator.name, integrator.order, ChainProblem::gravity, bodies, [](mjData&) {}, coordinates));
  return out;
}

std::string mujoco_version() { return std::string("MuJoCo ") + mj_versionString(); }

}  // namespace peers
