#pragma once
/// Where the states of a model are: how many numbers they have, how many of these are free, and the way back to there.
///
///     const learning::StateSpace spheres = learning::cotangent_spheres(2);  // (T*S^2)^2: 12 numbers, 8 of them free
///     const learning::StateSpace plane = learning::phase_space(1);          // R^2, z = (q, p)
///
/// Nothing throws.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <functional>
#include <string>

namespace lagroid::learning {

/// States z: on (T*S^2)^k q_1, p_1, q_2, p_2, ..., of three numbers each; elsewhere (q, p), first all of q.
struct StateSpace {
  Eigen::Index size = 0;       ///< numbers of a state
  Eigen::Index dimension = 0;  ///< of them free: 4k on (T*S^2)^k, 2 (n - m) on T*Q, Q of m constraints in R^n
  int bodies = 0;              ///< k on (T*S^2)^k; zero elsewhere
  /// Brings a state onto the space; empty where every state is on it.
  std::function<void(Eigen::Ref<Eigen::VectorXd>)> project = nullptr;
};

/// z brought onto (T*S^2)^k.
inline void put_on_spheres(Eigen::Ref<Eigen::VectorXd> z) {
  for (Eigen::Index i = 0; i < z.size(); i += 6) {
    z.segment<3>(i).normalize();
    const Eigen::Vector3d q = z.segment<3>(i);
    z.segment<3>(i + 3) -= q * q.dot(z.segment<3>(i + 3));
  }
}

/// (T*S^2)^k.
inline StateSpace cotangent_spheres(int bodies) { return {6 * bodies, 4 * bodies, bodies, put_on_spheres}; }
/// R^2n, z = (q, p).
inline StateSpace phase_space(int coordinates) { return {2 * coordinates, 2 * coordinates}; }

/// "(T*S^2)^k", "R^2n", or "T*Q in R^2n".
inline std::string to_string(const StateSpace& space) {
  if (space.bodies > 0) return "(T*S^2)^" + std::to_string(space.bodies);
  return (space.dimension < space.size ? "T*Q in R^" : "R^") + std::to_string(space.size);
}

}  // namespace lagroid::learning
