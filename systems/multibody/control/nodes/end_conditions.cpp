#include <lagroid/systems/multibody/control/nodes/end_conditions.hpp>

#include <Eigen/LU>

#include <utility>

namespace lagroid::multibody {

EndConditions::EndConditions(SceneEnd end, int joints, std::vector<double> weights, std::vector<Mat> drag,
                             std::vector<char> planar)
    : end_(std::move(end)),
      joints_(joints),
      weights_(std::move(weights)),
      drag_(std::move(drag)),
      planar_(std::move(planar)),
      matrix_(joints, joints) {}

template <class S>
S EndConditions::value(const HeldByMotion& held, const NodeForces<S>& node, const std::vector<S>& momenta) const {
  const Vec& a = held.translation;
  const Vec& b = held.turn;
  S sum = S(0);
  for (int f = 0; f < node.linear(); ++f) {
    const Vector<S, 3>& x = node.place(f);
    const S* p = momenta.data() + 3 * f;
    if (held.kind != HeldByMotion::Kind::momentum) {
      const Mat& drag = drag_[std::size_t(f)];
      for (int i = 0; i < (planar_[std::size_t(f)] ? 2 : 3); ++i) {
        if (held.kind == HeldByMotion::Kind::centre) {
          sum += x(i) * (a(i) / weights_[std::size_t(3 * f + i)]);
          continue;
        }
        sum += p[i] * a(i);
        for (int j = 0; j < 3; ++j) sum += x(j) * (a(i) * drag(i, j));
      }
    } else if (planar_[std::size_t(f)]) {
      sum += p[0] * (a(0) - x(1) * b(2)) + p[1] * (a(1) + x(0) * b(2)) + p[2] * b(2);
    } else {
      sum += p[0] * (a(0) + x(2) * b(1) - x(1) * b(2)) + p[1] * (a(1) + x(0) * b(2) - x(2) * b(0)) +
             p[2] * (a(2) + x(1) * b(0) - x(0) * b(1));
    }
  }
  if (held.kind != HeldByMotion::Kind::momentum) return sum;
  for (int r = 0; r < node.rotations(); ++r) {
    const Matrix<S, 3, 3>& attitude = node.attitude(r);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += attitude(i, j) * momenta[std::size_t(3 * (node.linear() + r) + j)] * b(i);
  }
  return sum;
}

template <class S>
void EndConditions::velocities(const NodeForces<S>& node, const std::vector<S>& momenta, std::vector<S>& out) {
  const int n = node.size();
  out = momenta;
  const auto weigh = [&] {
    for (int i = 0; i < n; ++i) out[std::size_t(i)] *= S(weights_[std::size_t(i)]);
  };
  weigh();
  if (joints_ == 0) return;
  for (int a = 0; a < joints_; ++a)
    for (int b = 0; b < joints_; ++b) {
      double sum = 0;
      for (int i = 0; i < n; ++i)
        sum += value_of(node.gradient(a, i)) * weights_[std::size_t(i)] * value_of(node.gradient(b, i));
      matrix_(a, b) = sum;
    }
  inverse_ = matrix_.inverse();
  // The inverse is one of plain numbers: each pass takes away what is left of one more order of derivatives, and of
  // round-off.
  constexpr int orders = 3;
  std::vector<S> left(std::size_t(joints_), S(0));
  for (int pass = 0; pass < orders + 1; ++pass) {
    for (int a = 0; a < joints_; ++a) {
      left[std::size_t(a)] = S(0);
      for (int i = 0; i < n; ++i) left[std::size_t(a)] += node.gradient(a, i) * out[std::size_t(i)];
    }
    for (int a = 0; a < joints_; ++a) {
      S nu = S(0);
      for (int b = 0; b < joints_; ++b) nu += left[std::size_t(b)] * inverse_(a, b);
      for (int i = 0; i < n; ++i) out[std::size_t(i)] -= node.gradient(a, i) * nu * weights_[std::size_t(i)];
    }
  }
}

template <class S>
void EndConditions::values(const NodeForces<S>& node, const std::vector<S>& momenta, std::vector<S>& out) {
  out.clear();
  for (int row = 0; row < joints_; ++row) out.push_back(node.joint(row));
  for (const SceneEnd::Place& each : end_.places) out.push_back(node(each.site)(each.axis) - each.value);
  for (const SceneEnd::Turn& each : end_.turns) {
    const Mat given = SO3::from_quaternion(each.value);
    const Matrix<S, 3, 3> off = given.transpose().template cast<S>() * node(each.attitude);
    const Vector<S, 3> turn = SO3::log(off);
    for (int i = 0; i < 3; ++i) out.push_back(turn(i));
  }
  std::vector<S> velocity;
  if (!end_.velocities.empty() || !end_.turnings.empty()) velocities(node, momenta, velocity);
  for (const SceneEnd::Velocity& each : end_.velocities)
    out.push_back(velocity[std::size_t(3 * node.place_of(each.linear) + each.axis)] - each.value);
  for (const SceneEnd::Turning& each : end_.turnings)
    out.push_back(velocity[std::size_t(3 * (node.linear() + node.place_of(each.attitude)) + each.axis)] - each.value);
  for (const HeldByMotion& each : held_) out.push_back(value(each, node, momenta) - each.value);
}

template double EndConditions::value(const HeldByMotion&, const NodeForces<double>&, const std::vector<double>&) const;
template void EndConditions::values(const NodeForces<double>&, const std::vector<double>&, std::vector<double>&);
template void EndConditions::values(const NodeForces<SecondNumber>&, const std::vector<SecondNumber>&,
                                    std::vector<SecondNumber>&);
template void EndConditions::velocities(const NodeForces<double>&, const std::vector<double>&, std::vector<double>&);
template void EndConditions::velocities(const NodeForces<SecondNumber>&, const std::vector<SecondNumber>&,
                                        std::vector<SecondNumber>&);

}  // namespace lagroid::multibody
