#pragma once
/// Places, attitudes, momenta and energies of all that moves in a scene, one after another: over numbers with
/// derivatives at a node, and of a motion.

#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/multibody/sensitivity/varied_scene.hpp>

#include <vector>

namespace lagroid::multibody {

inline VariedNumbers all_that_moves(const ObservedScene& node) {
  std::vector<VariedNumber> out;
  const auto append = [&](const auto& each) { out.insert(out.end(), each.data(), each.data() + each.size()); };
  for (std::size_t f = 0; f < node.momentum.size(); ++f) append(node.at.x[f]), append(node.momentum[f]);
  for (std::size_t r = 0; r < node.spin.size(); ++r) append(node.at.attitude[r]), append(node.spin[r]);
  out.push_back(node.kinetic);
  out.push_back(node.potential);
  return Eigen::Map<const VariedNumbers>(out.data(), Eigen::Index(out.size()));
}

inline Eigen::VectorXd all_that_moves(const Multibody& motion) {
  std::vector<double> out;
  const auto append = [&](const auto& each) { out.insert(out.end(), each.data(), each.data() + each.size()); };
  const Multibody::Momenta m = motion.momenta();
  for (std::size_t f = 0; f < m.linear.size(); ++f) append(motion.configuration().x[f]), append(m.linear[f]);
  for (std::size_t r = 0; r < m.spin.size(); ++r) append(motion.configuration().attitude[r]), append(m.spin[r]);
  out.push_back(motion.kinetic_energy(m));
  out.push_back(motion.potential_energy());
  return Eigen::Map<const Eigen::VectorXd>(out.data(), Eigen::Index(out.size()));
}

}  // namespace lagroid::multibody
