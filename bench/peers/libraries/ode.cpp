// ODE, the Open Dynamics Engine, by dWorldStep, which its manual calls the more accurate of its steps. A free body
// turns with finite rotations and its gyroscopic torque; the masses of the chain, which have no extent, are tied by
// distance joints ("DBall"). Error reduction and softness of joints are the defaults.
#include "libraries.hpp"

#include <ode/ode.h>

#include <memory>
#include <stdexcept>
#include <utility>

namespace peers {

namespace {

struct World {
  World() : id((dInitODE2(0), dWorldCreate())) {}
  ~World() { dWorldDestroy(id); }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  dWorldID id;
  std::vector<dBodyID> bodies;
};

template <class P, class Build, class Coordinates>
Method stepped(const P& problem, const Build& build, const Coordinates& coordinates) {
  return engine_steps(problem, "ODE", "dWorldStep", 1, 0.25 * problem.unit(), [=](double h) {
    const auto world = std::make_shared<World>();
    build(*world);
    const auto step = [=] {
      if (dWorldStep(world->id, h) == 0) throw std::runtime_error("dWorldStep failed");
    };
    return std::pair(step, [=] { return coordinates(*world); });
  });
}

}  // namespace

Methods ode_methods(const RigidBodyProblem& problem) {
  const auto build = [=](World& world) {
    const dBodyID body = dBodyCreate(world.id);
    dMass mass;
    dMassSetParameters(&mass, 1, 0, 0, 0, 1, 2, 3, 0, 0, 0);
    dBodySetMass(body, &mass);
    dBodySetFiniteRotationMode(body, 1);
    const auto& m = problem.momentum;
    dBodySetAngularVel(body, m[0], m[1] / 2, m[2] / 3);
    world.bodies.push_back(body);
  };
  const auto coordinates = [](const World& world) {
    const dReal* q = dBodyGetQuaternion(world.bodies[0]);
    const dReal* w = dBodyGetAngularVel(world.bodies[0]);
    dVector3 spin;
    dBodyVectorFromWorld(world.bodies[0], w[0], w[1], w[2], spin);
    return attitude_and_momentum<double>({q[0], q[1], q[2], q[3], spin[0], 2 * spin[1], 3 * spin[2]});
  };
  return {stepped(problem, build, coordinates)};
}

Methods ode_methods(const ChainProblem& problem) {
  const auto build = [=](World& world) {
    dWorldSetGravity(world.id, 0, 0, -ChainProblem::gravity);
    const auto places = problem.places();
    dBodyID last = nullptr;
    for (std::size_t i = 0; i < places.size(); i += 3) {
      const dBodyID body = dBodyCreate(world.id);
      dMass mass;
      dMassSetParameters(&mass, 1.0 / ChainProblem::links, 0, 0, 0, 1e-3, 1e-3, 1e-3, 0, 0, 0);
      dBodySetMass(body, &mass);
      dBodySetPosition(body, places[i], places[i + 1], places[i + 2]);
      const dJointID rod = dJointCreateDBall(world.id, nullptr);
      dJointAttach(rod, body, last);
      dJointSetDBallAnchor1(rod, places[i], places[i + 1], places[i + 2]);
      if (i == 0) {
        dJointSetDBallAnchor2(rod, 0, 0, 0);
      } else {
        dJointSetDBallAnchor2(rod, places[i - 3], places[i - 2], places[i - 1]);
      }
      world.bodies.push_back(body);
      last = body;
    }
  };
  const auto coordinates = [](const World& world) {
    std::array<double, ChainProblem::compared> out;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
      const dReal* x = dBodyGetPosition(world.bodies[i]);
      const dReal* v = dBodyGetLinearVel(world.bodies[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        out[3 * i + k] = x[k];
        out[3 * (ChainProblem::links + i) + k] = v[k];
      }
    }
    return out;
  };
  return {stepped(problem, build, coordinates)};
}

std::string ode_version() { return std::string("ODE ") + LAGROID_ODE_VERSION; }

}  // namespace peers
