// Bullet in double precision. The free body is a btRigidBody with the implicit gyroscopic torque, the default; the
// chain a btMultiBody with spherical joints, Bullet's reduced coordinates, with and without its RK4. Damping and
// sleeping are off.
#include "libraries.hpp"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <utility>

namespace peers {

namespace {

struct World {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btSphereShape sphere{0.1};
  btDefaultMotionState motion;
  std::unique_ptr<btRigidBody> body;
  std::unique_ptr<btMultiBody> chain;

  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    if (body) world.removeRigidBody(body.get());
    if (chain) world.removeMultiBody(chain.get());
  }
};

template <class P, class Build, class Coordinates>
Method stepped(const P& problem, std::string name, double order, const Build& build, const Coordinates& coordinates) {
  return engine_steps(problem, "Bullet", std::move(name), order, 0.25 * problem.unit(), [=](double h) {
    const auto world = std::make_shared<World>();
    build(*world);
    return std::pair([=] { world->world.stepSimulation(h, /*maxSubSteps=*/0); }, [=] { return coordinates(*world); });
  });
}

}  // namespace

Methods bullet_methods(const RigidBodyProblem& problem) {
  const auto build = [=](World& world) {
    world.world.setGravity({0, 0, 0});
    btRigidBody::btRigidBodyConstructionInfo info(1, &world.motion, &world.sphere, {1, 2, 3});
    world.body = std::make_unique<btRigidBody>(info);
    world.body->setDamping(0, 0);
    world.body->setActivationState(DISABLE_DEACTIVATION);
    const auto& m = problem.momentum;
    world.body->setAngularVelocity({m[0], m[1] / 2, m[2] / 3});
    world.world.addRigidBody(world.body.get());
  };
  const auto coordinates = [](const World& world) {
    const btQuaternion q = world.body->getWorldTransform().getRotation();
    const btVector3 spin = world.body->getAngularVelocity() * world.body->getWorldTransform().getBasis();
    return attitude_and_momentum<double>({q.w(), q.x(), q.y(), q.z(), spin.x(), 2 * spin.y(), 3 * spin.z()});
  };
  return {stepped(problem, "btRigidBody", 1, build, coordinates)};
}

Methods bullet_methods(const ChainProblem& problem) {
  Methods out;
  for (const bool rk4 : {false, true}) {
    const auto build = [=](World& world) {
      world.world.setGravity({0, 0, -ChainProblem::gravity});
      constexpr double extent = 1e-12;  // kg m^2; none of it would make the joints' inertia singular
      world.chain = std::make_unique<btMultiBody>(int(ChainProblem::links), btScalar(0), btVector3(0, 0, 0),
                                                  /*fixedBase=*/true, /*canSleep=*/false);
      const auto y = problem.start();
      for (int i = 0; i < ChainProblem::links; ++i) {
        const auto at = std::size_t(3 * i);
        const btVector3 rod(y[at], y[at + 1], y[at + 2]);
        // The parent's centre is the joint.
        world.chain->setupSpherical(i, 1.0 / ChainProblem::links, btVector3(extent, extent, extent), i - 1,
                                    btQuaternion(0, 0, 0, 1), btVector3(0, 0, 0), rod, true);
      }
      world.chain->finalizeMultiDof();
      world.chain->setLinearDamping(0);
      world.chain->setAngularDamping(0);
      world.chain->setUseGyroTerm(true);
      world.chain->setHasSelfCollision(false);
      world.chain->setMaxCoordinateVelocity(1e10);
      world.chain->useRK4Integration(rk4);
      world.world.addMultiBody(world.chain.get());
    };
    const auto coordinates = [](World& world) {
      btAlignedObjectArray<btQuaternion> turns;
      btAlignedObjectArray<btVector3> places;
      world.chain->forwardKinematics(turns, places);
      btAlignedObjectArray<btVector3> spins;
      btAlignedObjectArray<btVector3> velocities;
      spins.resize(ChainProblem::links + 1);
      velocities.resize(ChainProblem::links + 1);
      world.chain->compTreeLinkVelocities(&spins[0], &velocities[0]);
      std::array<double, ChainProblem::compared> state;
      for (int i = 0; i < ChainProblem::links; ++i) {
        const btTransform frame = world.chain->getLink(i).m_cachedWorldTransform;
        const btVector3 velocity = frame.getBasis() * velocities[i + 1];
        for (int k = 0; k < 3; ++k) {
          state[std::size_t(3 * i + k)] = frame.getOrigin()[k];
          state[std::size_t(3 * (ChainProblem::links + i) + k)] = velocity[k];
        }
      }
      return state;
    };
    out.push_back(stepped(problem, rk4 ? "btMultiBody, RK4" : "btMultiBody", rk4 ? 4 : 1, build, coordinates));
  }
  return out;
}

std::string bullet_version() {
  return "Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." + std::to_string(BT_BULLET_VERSION % 100);
}

}  // namespace peers
