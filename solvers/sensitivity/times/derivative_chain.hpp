#pragma once
/// Derivatives made of others: one after another, with rows of the directions replaced in between. So the parts of a
/// step that is cut are joined, forward and backward alike.
///
///     // The duration of a part, s = r x, before it, and the time at which it ends after it.
///     DerivativeChain step(2);  // rows below those of the motion: t and s
///     step.add(std::make_shared<ReplacedRows>(s, r));
///     step.add(part);
///     const Eigen::MatrixXd end = step.forward(start);
///
/// Requires rows that fit each other. Nothing throws but what a derivative throws.

#include <lagroid/solvers/sensitivity/linear_step.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace lagroid {

/// Of one step or a part of it, in their order.
using Derivatives = std::vector<std::shared_ptr<const StepDerivative>>;

/// Some rows become combinations of all: x_i' = sum_j M_ij x_j for those from `first` on, the others stay.
class ReplacedRows final : public StepDerivative {
 public:
  ReplacedRows(int first, Eigen::MatrixXd by) : first_(first), by_(std::move(by)) {}

  Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const override;
  Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const override;

 private:
  int first_;
  Eigen::MatrixXd by_;
};

/// All of them, with more rows below, which are zero at the beginning and dropped at the end.
class DerivativeChain final : public StepDerivative {
 public:
  explicit DerivativeChain(int more, Derivatives parts = {}) : more_(more), parts_(std::move(parts)) {}
  void add(std::shared_ptr<const StepDerivative> part) { parts_.push_back(std::move(part)); }

  Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const override;
  Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const override;

 private:
  int more_;
  Derivatives parts_;
};

/// Of derivatives one after another.
Eigen::MatrixXd forward(const Derivatives& parts, Eigen::MatrixXd directions);
Eigen::MatrixXd backward(const Derivatives& parts, Eigen::MatrixXd gradients);

}  // namespace lagroid
