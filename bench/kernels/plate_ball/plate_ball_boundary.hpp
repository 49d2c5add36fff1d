#pragma once
/// The boundary-value problem of the plate-ball system in the trace form, by hand.

#include "plate_ball.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace kernels {

/// N + 1 nodes, of which the first and the last are given, and a multiplier for each of the N steps between them.
struct PlateBallPath {
  std::vector<Eigen::Vector2d> position;
  std::vector<Eigen::Matrix3d> attitude;
  std::vector<Eigen::Vector3d> multipliers;
};

/// Newton's method on the discrete constrained Euler-Lagrange equations phi(g_k) = 0, F+(g_k) = F-(g_{k+1}), with
/// g_k = (q_{k-1}, q_k, A_{k-1}^T A_k), in 8 N - 5 unknowns z_k = (l_k, v_k): the changes of the multipliers and the
/// displacements q_k + v, A_k cay(v) of the nodes, v_N = 0.
///
/// All is h times the action, so that nothing scales with N: f = |q_k - q_{k-1}|^2 / 2 + <l, phi>, l = h lambda. With
/// w = vee(g) and nu = (r l1, -r l2, -l3) the rotation enters f as nu.w, and its derivatives at A_{k-1} (v) and A_k (w)
/// are
///
///     -(tr(g) I - g^T) nu / 2,   (tr(g) I - g) nu / 2,    mixed  nu w^T + hat(g^T nu) / 2,
///     second  sym(hat(nu) g^T) / 2 - (nu.w) I,            -sym(hat(nu) g) / 2 - (nu.w) I.
///
/// The matrix is block tridiagonal: S_k = D_k - C_k P C_k^T with P the (v, v) block of S_{k-1}^{-1} and C_k (8 x 5) the
/// coupling to v_{k-1}. Each S_k is inverted by Gaussian elimination with row pivoting: eight right-hand sides fill a
/// vector register as the six that are needed would. O(N), storage reused.
class PlateBallBoundary {
 public:
  /// Starts from a path; its ends stay where they are.
  PlateBallBoundary(const PlateBallParameters& parameters, PlateBallPath path)
      : parameters_(parameters), path_(std::move(path)), blocks_(path_.multipliers.size()) {
    for (auto& l : path_.multipliers) l *= parameters_.h;
  }

  /// Newton iterations until |F| <= tolerance; how many, or -1 if `max_iterations` are not enough.
  int solve(double tolerance, int max_iterations = 50) {
    for (int iteration = 0; iteration <= max_iterations; ++iteration) {
      if (reduce() <= tolerance) return iteration;
      update();
    }
    return -1;
  }

  /// One Newton iteration.
  void iterate() {
    reduce();
    update();
  }

  /// Evaluates the equations and their matrix and eliminates forwards. Returns |F|: the largest component, with phi
  /// divided and F+ - F- multiplied by sqrt(h).
  double reduce() {
    const std::size_t count = blocks_.size();
    double largest = 0;
    Terms ahead = terms(0);
    for (std::size_t k = 0; k < count; ++k) {
      const Terms here = ahead;
      const bool last = k + 1 == count;
      Block& block = blocks_[k];
      Square matrix = Square::Zero();
      block.coupling.setZero();
      block.coupling.topRightCorner<3, 5>() = here.constraint_source;
      block.right.head<3>() = -here.constraint;
      if (last) {  // whose node does not move
        matrix.bottomRightCorner<5, 5>().setIdentity();
        block.right.tail<5>().setZero();
      } else {
        ahead = terms(k + 1);
        matrix.topRightCorner<3, 5>() = here.constraint_target;
        matrix.bottomLeftCorner<5, 3>() = here.constraint_target.transpose();
        matrix(3, 3) = 2;
        matrix(4, 4) = 2;
        matrix.bottomRightCorner<3, 3>() = here.target_hessian + ahead.source_hessian;
        block.coupling.bottomRightCorner<5, 5>() = here.mixed.transpose();
        block.right.tail<5>() = -here.target_gradient - ahead.source_gradient;
      }
      largest = std::max(largest, block.right.cwiseAbs().maxCoeff());
      if (k > 0) {
        const Block& before = blocks_[k - 1];
        const Columns columns = block.coupling.rightCols<5>().transpose();
        const Columns moved = before.inverse.bottomRightCorner<5, 5>().lazyProduct(columns);
        matrix -= moved.transpose().lazyProduct(columns);
        const Column solved = before.inverse.transpose() * before.right;
        block.right -= columns.transpose() * solved.tail<5>();
      }
      invert(matrix, block.inverse);
    }
    return largest / std::sqrt(parameters_.h);
  }

  /// Substitutes back and moves the nodes and multipliers.
  void update() {
    Column z = Column::Zero();
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      Column right = blocks_[k].right;
      if (k + 1 < blocks_.size()) right -= blocks_[k + 1].coupling.transpose() * z;
      z = blocks_[k].inverse.transpose() * right;
      path_.multipliers[k] += z.head<3>();
      if (k + 1 == blocks_.size()) continue;
      path_.position[k + 1] += z.segment<2>(3);
      path_.attitude[k + 1] *= cayley(z.tail<3>());
    }
  }

  /// sum_k |q_k - q_{k-1}|^2 / (2 h).
  double cost() const {
    double sum = 0;
    for (std::size_t k = 0; k < blocks_.size(); ++k) sum += (path_.position[k + 1] - path_.position[k]).squaredNorm();
    return 0.5 * sum / parameters_.h;
  }

  const std::vector<Eigen::Vector2d>& positions() const { return path_.position; }
  const std::vector<Eigen::Matrix3d>& attitudes() const { return path_.attitude; }
  Eigen::Vector3d multipliers(std::size_t step) const { return path_.multipliers[step] / parameters_.h; }

 private:
  using Square = Eigen::Matrix<double, 8, 8, Eigen::RowMajor>;
  using Columns = Eigen::Matrix<double, 5, 8, Eigen::RowMajor>;
  using Column = Eigen::Matrix<double, 8, 1>;

  /// What the elimination leaves of a block. The inverse is symmetric, and used by rows throughout.
  struct Block {
    Square coupling;  // C_k, in the columns of v
    Square inverse;   // S_k^{-1}
    Column right;     // b_k - C_k (S_{k-1}^{-1} b_{k-1})_v
  };

  /// h times the action of one step, with its derivatives.
  struct Terms {
    Eigen::Vector3d constraint;
    Eigen::Matrix<double, 3, 5> constraint_source;
    Eigen::Matrix<double, 3, 5> constraint_target;
    Eigen::Matrix<double, 5, 1> source_gradient;
    Eigen::Matrix<double, 5, 1> target_gradient;
    Eigen::Matrix<double, 5, 5> mixed;
    Eigen::Matrix3d source_hessian;  // of the rotation; that of the contact point is the identity
    Eigen::Matrix3d target_hessian;
  };

  Terms terms(std::size_t k) const {
    const auto& [h, radius, plate_rate, spin] = parameters_;
    const double b = 0.5 * h * plate_rate;
    const Eigen::Vector2d d = path_.position[k + 1] - path_.position[k];
    const Eigen::Vector2d sum = path_.position[k + 1] + path_.position[k];
    const Eigen::Matrix3d g = path_.attitude[k].transpose() * path_.attitude[k + 1];
    const Eigen::Vector3d& l = path_.multipliers[k];
    const Eigen::Vector3d nu(radius * l(0), -radius * l(1), -l(2));
    const Eigen::Vector3d w(0.5 * (g(2, 1) - g(1, 2)), 0.5 * (g(0, 2) - g(2, 0)), 0.5 * (g(1, 0) - g(0, 1)));
    const Eigen::Vector3d ahead = 0.5 * (g * nu);
    const Eigen::Vector3d back = 0.5 * (g.transpose() * nu);
    const double half_trace = 0.5 * g.trace();
    const double along = nu.dot(w);
    const Eigen::Vector3d sign(radius, -radius, -1);

    Terms t;
    t.constraint << d(1) + radius * w(0) - b * sum(0), d(0) - radius * w(1) + b * sum(1), h * spin - w(2);
    t.constraint_source.leftCols<2>() << -b, -1, -1, b, 0, 0;
    t.constraint_target.leftCols<2>() << -b, 1, 1, b, 0, 0;
    t.constraint_source.rightCols<3>() = 0.5 * sign.asDiagonal() * g;
    t.constraint_target.rightCols<3>() = -0.5 * sign.asDiagonal() * g.transpose();
    for (int i = 0; i < 3; ++i) {
      t.constraint_source(i, 2 + i) -= sign(i) * half_trace;
      t.constraint_target(i, 2 + i) += sign(i) * half_trace;
    }
    const Eigen::Vector2d common(b * l(0), -b * l(1));
    const Eigen::Vector2d opposite(d(0) + l(1), d(1) + l(0));
    t.source_gradient << -common - opposite, back - half_trace * nu;
    t.target_gradient << opposite - common, half_trace * nu - ahead;
    t.mixed.setZero();
    t.mixed(0, 0) = -1;
    t.mixed(1, 1) = -1;
    t.mixed.bottomRightCorner<3, 3>() << nu(0) * w(0), nu(0) * w(1) - back(2), nu(0) * w(2) + back(1),  //
        nu(1) * w(0) + back(2), nu(1) * w(1), nu(1) * w(2) - back(0),                                   //
        nu(2) * w(0) - back(1), nu(2) * w(1) + back(0), nu(2) * w(2);
    t.source_hessian = quarter_symmetric(nu, g.transpose());
    t.target_hessian = -quarter_symmetric(nu, g);
    t.source_hessian.diagonal().array() -= along;
    t.target_hessian.diagonal().array() -= along;
    return t;
  }

  /// (hat(nu) g + (hat(nu) g)^T) / 4.
  static Eigen::Matrix3d quarter_symmetric(const Eigen::Vector3d& nu, const Eigen::Matrix3d& g) {
    const Eigen::Vector3d n = 0.25 * nu;
    const auto entry = [&](int i, int j) {  // of hat(nu) g / 4
      const int a = (i + 1) % 3;
      const int c = (i + 2) % 3;
      return n(a) * g(c, j) - n(c) * g(a, j);
    };
    Eigen::Matrix3d s;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) s(i, j) = s(j, i) = entry(i, j) + entry(j, i);
    return s;
  }

  /// inverse = s^{-1}, by Gaussian elimination with row pivoting; s is overwritten.
  static void invert(Square& s, Square& inverse) {
    inverse.setIdentity();
    Column reciprocal;
    for (int p = 0; p < 8; ++p) {
      int pivot = p;
      for (int i = p + 1; i < 8; ++i)
        if (std::abs(s(i, p)) > std::abs(s(pivot, p))) pivot = i;
      if (pivot != p) {
        s.row(p).swap(s.row(pivot));
        inverse.row(p).swap(inverse.row(pivot));
      }
      reciprocal(p) = 1 / s(p, p);
      for (int i = p + 1; i < 8; ++i) {
        const double factor = s(i, p) * reciprocal(p);
        s.row(i) -= factor * s.row(p);
        inverse.row(i) -= factor * inverse.row(p);
      }
    }
    for (int p = 7; p >= 0; --p) {
      inverse.row(p) *= reciprocal(p);
      for (int i = 0; i < p; ++i) inverse.row(i) -= s(i, p) * inverse.row(p);
    }
  }

  static Eigen::Matrix3d cayley(const Eigen::Vector3d& x) {
    const double scale = 1 / (1 + 0.25 * x.squaredNorm());
    Eigen::Matrix3d hat;
    hat << 0, -x(2), x(1), x(2), 0, -x(0), -x(1), x(0), 0;
    return (2 * scale - 1) * Eigen::Matrix3d::Identity() + scale * hat + (0.5 * scale) * x * x.transpose();
  }

  PlateBallParameters parameters_;
  PlateBallPath path_;
  std::vector<Block> blocks_;
};

}  // namespace kernels
