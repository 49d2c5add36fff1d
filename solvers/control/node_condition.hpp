#pragma once
/// What a node of a trajectory is to satisfy: psi(p) = 0, of the arrow p that leads to the node from the first object
/// of the boundary. A waypoint, a gate, a circle on which the motion ends; on a group, a pose or one component of it.
///
///     // A pose in the plane, two metres from where the motion began.
///     task.end_condition = node_condition<SE2, 1>([]<class S>(const Matrix<S, 3, 3>& p) {
///       return Vector<S, 1>(p(0, 2) * p(0, 2) + p(1, 2) * p(1, 2) - 4.0);
///     });
///
/// A transcription has it in rows of the stage that ends at the node, or, one number, in its cost (PlacedCondition).
///
/// Requires psi with independent derivatives along the displacements that are free at its node, a const template on the
/// scalar. Its derivatives, second ones included, are automatic. Nothing throws.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/solvers/control/transcription.hpp>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace lagroid {

template <class G> class NodeCondition {
 public:
  static constexpr int n = G::dimension;

  virtual ~NodeCondition() = default;
  virtual int size() const = 0;
  /// psi.
  virtual void values(const G& groupoid, const ArrowOf<G>& node, double* out) const = 0;
  /// Of psi(node tau(v)) by v: the first derivatives, n to a row, and added to `hessian`, n x n, those of <lambda,
  /// psi>.
  virtual void derivatives(const G& groupoid, const ArrowOf<G>& node, const double* lambda, double* rows,
                           double* hessian) const = 0;

 protected:
  using J = SecondJet<double, n>;
  /// node tau(v) as a function of v.
  static ArrowOf<G, J> near(const G& groupoid, const ArrowOf<G>& node) {
    const Vector<J, n> still = Vector<J, n>::Constant(J(0.0));
    Vector<J, n> v;
    for (int i = 0; i < n; ++i) v(i) = J::variable(0.0, i);
    return groupoid.translate(still, groupoid.template cast<J>(node), v);
  }
  static void place(const J& psi, int row, double lambda, double* rows, double* hessian) {
    for (int i = 0; i < n; ++i) {
      rows[row * n + i] = psi.gradient(i);
      for (int j = 0; j < n; ++j) hessian[i * n + j] += lambda * psi.hessian(i, j);
    }
  }
};

/// Of a function of the arrow that returns M numbers.
template <class G, int M, class Psi> class NodeConditionOf final : public NodeCondition<G> {
 public:
  using Base = NodeCondition<G>;
  explicit NodeConditionOf(Psi psi) : psi_(std::move(psi)) {}
  int size() const override { return M; }
  void values(const G&, const ArrowOf<G>& node, double* out) const override {
    const Vector<double, M> psi = psi_(node);
    for (int i = 0; i < M; ++i) out[i] = psi(i);
  }
  void derivatives(const G& groupoid, const ArrowOf<G>& node, const double* lambda, double* rows,
                   double* hessian) const override {
    const Vector<typename Base::J, M> psi = psi_(Base::near(groupoid, node));
    for (int i = 0; i < M; ++i) Base::place(psi(i), i, lambda[i], rows, hessian);
  }

 private:
  Psi psi_;
};

template <class G, int M, class Psi> std::shared_ptr<const NodeCondition<G>> node_condition(Psi psi) {
  return std::make_shared<const NodeConditionOf<G, M, Psi>>(std::move(psi));
}

/// psi of a node among the functions of the stage that ends there, of the first node among those of stage 0: in rows of
/// its equalities, or, a single number, in its cost.
template <class G> class PlacedCondition {
 public:
  static constexpr int n = G::dimension;
  static constexpr int cost = -1;  ///< in place of a row

  PlacedCondition(std::shared_ptr<const NodeCondition<G>> psi, long node, int row)
      : psi_(std::move(psi)), node_(node), stage_(std::max(node - 1, 0L)), row_(row) {}
  long node() const { return node_; }

  void put_values(const G& groupoid, const ArrowOf<G>& at, StageValues& out) const {
    if (row_ != cost) return psi_->values(groupoid, at, out.equality[stage_] + row_);
    double value = 0;
    psi_->values(groupoid, at, &value);
    out.cost[stage_][0] += value;
  }
  /// Along the node alone.
  void put_derivatives(const G& groupoid, const ArrowOf<G>& at, const StageRows& lambda, StageDerivatives& out) const {
    static constexpr double once = 1;
    const int size = psi_->size(), begin = node_ == 0 ? 0 : n;
    const int length = out.gradient.length();
    rows_.resize(std::size_t(size * n));
    hessian_.assign(std::size_t(n * n), 0.0);
    psi_->derivatives(groupoid, at, row_ == cost ? &once : lambda[stage_] + row_, rows_.data(), hessian_.data());
    if (row_ == cost) {
      for (int q = 0; q < n; ++q) out.gradient[stage_][begin + q] += rows_[std::size_t(q)];
    } else {
      double* equality = out.equality[stage_] + row_ * length;
      std::fill(equality, equality + size * length, 0.0);
      for (int r = 0; r < size; ++r) std::copy_n(rows_.data() + r * n, n, equality + r * length + begin);
    }
    for (int r = 0; r < n; ++r)
      for (int q = 0; q < n; ++q)
        out.hessian[stage_][(begin + r) * length + begin + q] += hessian_[std::size_t(r * n + q)];
  }

 private:
  std::shared_ptr<const NodeCondition<G>> psi_;
  long node_, stage_;
  int row_;
  mutable std::vector<double> rows_, hessian_;
};

}  // namespace lagroid
