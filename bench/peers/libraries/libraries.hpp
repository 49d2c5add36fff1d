#pragma once
/// The methods of other software, one file for each library. CMake says which are installed; the others offer none.

#include "../problems/chain.hpp"
#include "../problems/kepler.hpp"
#include "../problems/pendulum.hpp"
#include "../problems/problem.hpp"
#include "../problems/rigid_body.hpp"
#include "../problems/spherical_pendulum.hpp"
#include "../problems/top.hpp"

namespace peers {

using Methods = std::vector<Method>;

/// Boost.odeint and SUNDIALS integrate the right-hand side of any problem.
template <class P> Methods odeint_methods(const P& problem);
template <class P> Methods sundials_methods(const P& problem);

/// Engines for bodies and joints have their own equations.
Methods mujoco_methods(const RigidBodyProblem& problem);
Methods mujoco_methods(const ChainProblem& problem);
Methods bullet_methods(const RigidBodyProblem& problem);
Methods bullet_methods(const ChainProblem& problem);
Methods ode_methods(const RigidBodyProblem& problem);
Methods ode_methods(const ChainProblem& problem);

std::string odeint_version();
std::string sundials_version();
std::string mujoco_version();
std::string bullet_version();
std::string ode_version();

inline void add(Methods& methods, Methods more) {
  for (Method& method : more) methods.push_back(std::move(method));
}

/// All that are installed and know the problem.
template <class P> Methods peer_methods(const P& problem) {
  Methods out;
#ifdef LAGROID_PEER_ODEINT
  add(out, odeint_methods(problem));
#endif
#ifdef LAGROID_PEER_SUNDIALS
  add(out, sundials_methods(problem));
#endif
#ifdef LAGROID_PEER_MUJOCO
  if constexpr (requires { mujoco_methods(problem); }) add(out, mujoco_methods(problem));
#endif
#ifdef LAGROID_PEER_BULLET
  if constexpr (requires { bullet_methods(problem); }) add(out, bullet_methods(problem));
#endif
#ifdef LAGROID_PEER_ODE
  if constexpr (requires { ode_methods(problem); }) add(out, ode_methods(problem));
#endif
  return out;
}

}  // namespace peers
