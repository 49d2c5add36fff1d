// Where a controlled scene may end, and which of the conditions on that say something.
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/systems/multibody/control/controlled_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

namespace lagroid::multibody {

Eigen::MatrixXd ControlledScene::end_jacobian(const ControlledNode& node) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(conditions_.size(), 2 * n());
  std::vector<SecondNumber> values;
  for (int f = 0; f < factors(); ++f) {
    forces(node, f, -1);
    end_values(node, f, values);
    for (int row = 0; row < conditions_.size(); ++row)
      for (int i = 0; i < 3; ++i) {
        out(row, 3 * f + i) = values[std::size_t(row)].left(i);
        out(row, n() + 3 * f + i) = values[std::size_t(row)].right(i);
      }
  }
  return out;
}

/// Newton's method from where `end_` is, on the first conditions, by the shortest steps of the first numbers of a node.
/// Steps are short, for joints bend; where an end is still far off after many of them it is the way that is long, and
/// they lengthen.
double ControlledScene::approach_end(int conditions, int numbers) {
  constexpr int most = 200, short_steps = 100;
  if (conditions == 0) return 0;
  std::vector<double> values;
  Eigen::VectorXd by = Eigen::VectorXd::Zero(2 * n());
  for (int k = 0;; ++k) {
    end_values(end_, values);
    const Eigen::Map<const Eigen::VectorXd> left(values.data(), conditions);
    const double off = left.lpNorm<Eigen::Infinity>();
    if (off < 1e-13 || k == most || !std::isfinite(off)) return off;
    by.head(numbers) = -least_squares(end_jacobian(end_).topLeftCorner(conditions, numbers), left);
    const double longest = std::exp2(std::max(0, k - short_steps));
    displace(end_, by.data(), std::min(1.0, longest / by.head(n()).norm()), end_);
  }
}

/// Translations and turns about the origin, six numbers, along which no force, no control, no joint and no damper does
/// any work at a few nodes, are symmetries. Along those on which drag does none momenta are kept; along translations of
/// the others p + c x is, and where drag goes by mass, c = gamma m, the centre of mass is known, for p is: of
/// (p' - p) / h = -gamma (p' + p) / 2.
std::vector<HeldByMotion> ControlledScene::held_by_motion() {
  constexpr int nodes = 3;
  constexpr double vanishes = 1e-14;  // of squares
  using Square = Eigen::Matrix<double, 6, 6>;
  Square work = Square::Zero();
  Square of_drag = Square::Zero();
  const std::vector<char>& planar = motion_.model().factors.planar;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  ControlledNode node = start_;
  Eigen::VectorXd by(2 * n()), covector(n());
  for (int k = 0; k < nodes; ++k) {
    const NodeForces<double>& at = forces(node);
    const auto look = [&](const auto& component, Square& sum) {
      for (int i = 0; i < n(); ++i) covector(i) = component(i);
      Eigen::Matrix<double, 6, 1> along = Eigen::Matrix<double, 6, 1>::Zero();
      for (int f = 0; f < factors(); ++f) {
        const Vec c = covector.segment<3>(3 * f);
        if (f >= linear()) {
          along.tail<3>() += node.attitudes[std::size_t(f - linear())] * c;
        } else if (planar[std::size_t(f)]) {
          const Vec& x = node.places[std::size_t(f)];
          along.head<2>() += c.head<2>();
          along(5) += x(0) * c(1) - x(1) * c(0) + c(2);
        } else {
          along.head<3>() += c;
          along.tail<3>() += node.places[std::size_t(f)].cross(c);
        }
      }
      const double size = covector.squaredNorm();
      if (size > 0) sum += along * along.transpose() / size;
    };
    look([&](int i) { return at.own(i); }, work);
    for (int j = 0; j < actuators(); ++j) look([&](int i) { return at.of_control(j, i); }, work);
    for (int row = 0; row < joints(); ++row) look([&](int i) { return at.gradient(row, i); }, work);
    for (int f = 0; f < factors(); ++f)
      for (int j = 0; j < 3; ++j) look([&](int i) { return i / 3 == f ? drag(f)(i % 3, j) : 0.0; }, of_drag);
    if (is_damped()) {
      const DamperForces<double>& damping = dampers(node, node);
      for (int row = 0; row < damping.rows(); ++row)
        look([&](int i) { return damping.covector(End::source, row, i); }, work);
    }
    for (double& x : by) x = normal(generator);
    displace(start_, by.data(), 0.3, node);
    if (!project(node)) node = start_;  // symmetries are those of places where the joints hold
  }
  if (std::find(planar.begin(), planar.end(), char(1)) != planar.end())
    for (const int out_of_plane : {2, 3, 4}) work(out_of_plane, out_of_plane) += 1;

  std::copy_n(start_.momenta.data(), n(), momenta_.begin());
  const NodeForces<double>& at = forces(start_);
  std::vector<HeldByMotion> out;
  const auto hold = [&](HeldByMotion each) {
    each.value = conditions_.value(each, at, momenta_);
    out.push_back(each);
  };
  const auto kernel = [&](const Eigen::MatrixXd& square) -> Eigen::MatrixXd {
    const SymmetricEigenvectors found = symmetric_eigenvectors(square);  // values increase
    return found.vectors.leftCols((found.values.array() <= vanishes).count());
  };
  const Eigen::MatrixXd symmetries = kernel(work + of_drag);
  for (const auto& v : symmetries.colwise()) hold({Vec(v.head<3>()), Vec(v.tail<3>())});
  if (linear() == 0) return out;
  // Translations along the axes of the drag, those on which it does nothing among them.
  const Eigen::MatrixXd free = kernel(work.topLeftCorner<3, 3>());
  if (free.cols() == 0) return out;
  const Eigen::MatrixXd axes =
      free * symmetric_eigenvectors(free.transpose() * of_drag.topLeftCorner<3, 3>() * free).vectors;
  for (int axis = 0; axis < int(axes.cols()); ++axis) {
    const Vec along = axes.col(axis);
    if (along.dot(of_drag.topLeftCorner<3, 3>() * along) > vanishes)
      hold({along, Vec::Zero(), HeldByMotion::Kind::momentum_and_drag});
    const double momentum = conditions_.value({along, Vec::Zero()}, at, momenta_);
    if (task_.duration_is_free && std::abs(momentum) > 1e-12) continue;
    const std::optional<double> gamma = drag_by_mass(along);
    if (!gamma) continue;
    hold({along, Vec::Zero(), HeldByMotion::Kind::centre});
    const double slowed = *gamma * task_.duration / double(task_.stages) / 2;
    const double left = std::pow((1 - slowed) / (1 + slowed), double(task_.stages));
    out.back().value += momentum * (*gamma == 0 ? task_.duration : (1 - left) / *gamma);
  }
  return out;
}

/// gamma of a drag gamma m along a translation; none where it goes by no mass.
std::optional<double> ControlledScene::drag_by_mass(const Vec& along) const {
  std::optional<double> gamma;
  for (int f = 0; f < linear(); ++f) {
    Vec a = along;
    if (motion_.model().factors.planar[std::size_t(f)]) a(2) = 0;
    const Vec pulled = drag(f).transpose() * a;
    const Vec weighed = inertia(f).cwiseProduct(a);
    const double here = pulled.dot(weighed) / weighed.squaredNorm();
    constexpr double rounding = 1e-12;
    if ((pulled - here * weighed).norm() > rounding * weighed.norm() ||
        (gamma && std::abs(here - *gamma) > rounding * (1 + std::abs(here))))
      return std::nullopt;
    gamma = here;
  }
  return gamma;
}

/// A node that satisfies the end, and what the motion holds: places first, then velocities too. Then those conditions
/// are left out that follow from others there, or from what is held.
void ControlledScene::find_end() {
  constexpr double reached = 1e-9, noticed = 1e-7;
  end_ = start_;
  if (const double off = approach_end(conditions_.before_velocities(), n()); !(off < reached))
    throw std::invalid_argument(
        fmt::format("the joints do not reach the end that is given, from the start: they are off by {:.2g}", off));
  if (const double off = approach_end(conditions_.before_held(), 2 * n()); !(off < reached))
    throw std::invalid_argument(
        fmt::format("the joints do not allow the velocities that are given of the end: they are off by {:.2g}", off));
  if (const double off = approach_end(conditions_.size(), 2 * n()); !(off < reached))
    throw std::invalid_argument(
        fmt::format("nothing outside changes the momentum or moves the centre of mass otherwise than at the start, and "
                    "the end asks for it: it is off by {:.2g}",
                    off));
  const Eigen::MatrixXd jacobian = end_jacobian(end_);
  // A row that vanishes beside others of its kind is one of round-off.
  const int on_places = conditions_.before_velocities(), given = conditions_.before_held();
  const auto largest = [&](int first, int last) {
    return last > first ? jacobian.middleRows(first, last - first).rowwise().norm().maxCoeff() : 0.0;
  };
  const double of_places = largest(0, on_places), of_velocities = largest(on_places, given);
  Eigen::MatrixXd basis(2 * n(), 0);
  const auto is_new = [&](int row, double size) {
    Eigen::VectorXd rest = jacobian.row(row).transpose();
    for (int pass = 0; pass < 2; ++pass) rest -= basis * (basis.transpose() * rest);
    if (rest.norm() <= noticed * size) return false;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = rest.normalized();
    return true;
  };
  const auto keep = [&](int first, int last, double size) {
    for (int row = first; row < last; ++row)
      if (is_new(row, size)) end_rows_.push_back(row);
  };
  keep(0, joints(), of_places);
  for (int row = given; row < conditions_.size(); ++row) is_new(row, jacobian.row(row).norm());
  keep(joints(), on_places, of_places);
  keep(on_places, given, of_velocities);
}

}  // namespace lagroid::multibody
