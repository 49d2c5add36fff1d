// What acts at the nodes of a controlled scene and on its arrows, over numbers with derivatives, too.
#include <lagroid/systems/multibody/control/arrow_momenta.hpp>
#include <lagroid/systems/multibody/control/controlled_scene.hpp>

#include <algorithm>

namespace lagroid::multibody {

namespace {

void put(const ControlledNode& node, Configuration& at) {
  std::copy(node.places.begin(), node.places.end(), at.x.begin());
  std::copy(node.attitudes.begin(), node.attitudes.end(), at.attitude.begin());
}

/// Varied along displacements of one factor to the left, and of one to the right.
void put(const ControlledNode& node, Retraction rotation, int left, int right, BasicConfiguration<SecondNumber>& at) {
  const int linear = int(node.places.size());
  for (int f = 0; f < linear + int(node.attitudes.size()); ++f) {
    Vector<SecondNumber, 3> v = Vector<SecondNumber, 3>::Constant(SecondNumber(0));
    for (int i = 0; i < 3; ++i) {
      if (f == left) v(i).set_left(i, 1);
      if (f == right) v(i).set_right(i, 1);
    }
    if (f < linear) {
      at.x[std::size_t(f)] = node.places[std::size_t(f)].cast<SecondNumber>() + v;
      continue;
    }
    const auto r = std::size_t(f - linear);
    const bool varies = f == left || f == right;
    const Matrix<SecondNumber, 3, 3> a = node.attitudes[r].cast<SecondNumber>();
    at.attitude[r] = varies ? Matrix<SecondNumber, 3, 3>(a * turn_of(rotation, v)) : a;
  }
}

}  // namespace

const NodeForces<double>& ControlledScene::forces(const ControlledNode& node) {
  put(node, plain_->configuration());
  plain_->evaluate();
  return *plain_;
}

const NodeForces<SecondNumber>& ControlledScene::forces(const ControlledNode& node, int left, int right) {
  put(node, rotation(), left, right, varied_->configuration());
  varied_->evaluate();
  return *varied_;
}

const DamperForces<double>& ControlledScene::dampers(const ControlledNode& from, const ControlledNode& to) {
  put(from, plain_dampers_->configuration(End::source));
  put(to, plain_dampers_->configuration(End::target));
  plain_dampers_->evaluate();
  return *plain_dampers_;
}

const DamperForces<SecondNumber>& ControlledScene::dampers(const ControlledNode& from, const ControlledNode& to,
                                                           FactorEnd left, FactorEnd right) {
  for (const End end : {End::source, End::target})
    put(end == End::source ? from : to, rotation(), left.end == end ? left.factor : -1,
        right.end == end ? right.factor : -1, varied_dampers_->configuration(end));
  varied_dampers_->evaluate();
  return *varied_dampers_;
}

void ControlledScene::end_values(const ControlledNode& node, std::vector<double>& out) {
  std::copy_n(node.momenta.data(), n(), momenta_.begin());
  conditions_.values(forces(node), momenta_, out);
}

void ControlledScene::vary_momenta(const ControlledNode& node, int right) {
  for (int i = 0; i < n(); ++i) {
    varied_momenta_[std::size_t(i)] = SecondNumber(node.momenta(i));
    if (i / 3 == right) varied_momenta_[std::size_t(i)].set_right(i % 3, 1);
  }
}

void ControlledScene::end_values(const ControlledNode& node, int momenta_right, std::vector<SecondNumber>& out) {
  vary_momenta(node, momenta_right);
  conditions_.values(*varied_, varied_momenta_, out);
}

std::vector<double> ControlledScene::velocities(const ControlledNode& node) {
  std::vector<double> out;
  std::copy_n(node.momenta.data(), n(), momenta_.begin());
  conditions_.velocities(forces(node), momenta_, out);
  limits_.add_points(*plain_, out);
  return out;
}

void ControlledScene::velocities(const ControlledNode& node, int momenta_right, std::vector<SecondNumber>& out) {
  vary_momenta(node, momenta_right);
  conditions_.velocities(*varied_, varied_momenta_, out);
  limits_.add_points(*varied_, out);
}

}  // namespace lagroid::multibody
