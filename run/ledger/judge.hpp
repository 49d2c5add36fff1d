#pragma once
/// From the nodes of a motion to the verdicts of its ledger.
///
///     Judge judge(motion.look());
///     while (motion.advance().converged()) judge.observe(motion.look());
///     judge.report(result.ledger);
///
/// Requires that all nodes have the same quantities. One that is promised no more at a node is watched, not judged.
/// Nothing throws.

#include <lagroid/run/ledger/ledger.hpp>
#include <lagroid/run/motion/observables.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace lagroid {

/// Holds a motion to its promises: its constraints and the quantities that it watches, node after node.
class Judge {
 public:
  /// Of the nodes to come, which have the same quantities as this one.
  explicit Judge(const Observables& node);

  void observe(const Observables& node);
  /// Something changed a quantity by so much on the way to the next node, where its terms had the size.
  void shift(std::size_t quantity, const double* by, double size) { watches_[quantity].shift(by, size); }
  /// Of the node seen last, how far the quantity is from its first value.
  double drift(std::size_t quantity) const { return watches_[quantity].drift(); }

  void report(Ledger& ledger) const;

  /// Visits what it has seen.
  template <class Archive> void serialize(Archive& archive) {
    for (std::size_t i = 0; i < watches_.size(); ++i) archive("quantity " + std::to_string(i), watches_[i]);
    archive("positions", positions_);
    archive("largest residual", largest_residual_);
    archive("residual size", residual_size_);
  }

 private:
  Constrained constrained_;
  std::vector<Watched> quantities_;
  std::vector<QuantityWatch> watches_;
  std::vector<std::vector<double>> values_;  // of each quantity
  PositionWatch positions_;
  double largest_residual_ = 0;
  double residual_size_ = 0;
};

}  // namespace lagroid
