#include <lagroid/solvers/control/optimality/repeated_constraints.hpp>

#include <Eigen/Core>

#include <cmath>
#include <utility>

namespace lagroid {

namespace {

constexpr double noticed = 1e-9;     // of a row's length, what is not in the span of the others
constexpr double same_value = 1e-6;  // of the values that are combined
constexpr double takes_part = 1e-6;  // of a row's length, what another adds to it

/// Which variables of a stage are free.
Eigen::VectorXd freedom(const Transcription& transcription, long stage) {
  const TranscriptionSizes& sizes = transcription.sizes();
  Eigen::VectorXd out = Eigen::VectorXd::Ones(sizes.variables());
  for (int i = 0; i < sizes.node; ++i) {
    if (stage == 0 && !transcription.free_start()[std::size_t(i)]) out(i) = 0;
    if (stage + 1 == sizes.stages && !transcription.free_end()[std::size_t(i)]) out(sizes.at_target() + i) = 0;
  }
  for (int i = 0; i < sizes.control; ++i)
    if (sizes.control_is_fixed(stage, i)) out(sizes.at_control() + i) = 0;
  if (!sizes.phases[std::size_t(sizes.phase_of(stage))].duration_is_free) out(sizes.at_duration()) = 0;
  return out;
}

/// Rows one after another: an orthonormal basis of those that say something, and these in it.
class Span {
 public:
  explicit Span(int rows, int variables) : basis_(variables, rows), kept_(Eigen::MatrixXd::Zero(rows, rows)) {}

  /// Whether it is no combination of the rows before; then it is kept.
  bool take(const Eigen::VectorXd& row) {
    rest_ = row;
    parts_ = Eigen::VectorXd::Zero(count_);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd parts = basis_.leftCols(count_).transpose() * rest_;
      rest_ -= basis_.leftCols(count_) * parts;
      parts_ += parts;
    }
    const double length = rest_.norm();
    if (!(length > noticed * row.norm())) return false;
    kept_.col(count_).head(count_) = parts_;
    kept_(count_, count_) = length;
    basis_.col(count_++) = rest_ / length;
    return true;
  }
  /// The combination of those kept that the last row is.
  Eigen::VectorXd combination() const {
    return kept_.topLeftCorner(count_, count_).triangularView<Eigen::Upper>().solve(parts_);
  }
  double length(int kept) const { return kept_.col(kept).head(count_).norm(); }

 private:
  Eigen::MatrixXd basis_, kept_;
  Eigen::VectorXd rest_, parts_;
  Eigen::Index count_ = 0;
};

}  // namespace

std::vector<RepeatedConstraint> repeated_constraints(const Transcription& transcription, const StageValues& values,
                                                     const StageDerivatives& derivatives, double tolerance) {
  const TranscriptionSizes& sizes = transcription.sizes();
  std::vector<RepeatedConstraint> out;
  const auto add = [&](RepeatedConstraint each) {
    for (RepeatedConstraint& other : out)
      if (other.row == each.row && other.of == each.of && other.stage + other.stages == each.stage) {
        ++other.stages;
        return;
      }
    out.push_back(std::move(each));
  };
  for (long k = 0; k < sizes.stages; ++k) {
    const Eigen::VectorXd free = freedom(transcription, k);
    const int rows = sizes.equalities_of(k);
    Span span(rows, sizes.variables());
    std::vector<int> kept;
    for (int r = 0; r < rows; ++r) {
      const Eigen::Map<const Eigen::VectorXd> all(derivatives.equality[k] + r * sizes.variables(), sizes.variables());
      const Eigen::VectorXd row = all.cwiseProduct(free);
      if (span.take(row)) {
        kept.push_back(r);
        continue;
      }
      const Eigen::VectorXd by = span.combination();
      RepeatedConstraint each{.stage = k, .row = r};
      double off = values.equality[k][r];
      double size = std::abs(off);
      for (std::size_t j = 0; j < kept.size(); ++j) {
        const double part = by(long(j)) * values.equality[k][kept[j]];
        off -= part;
        size += std::abs(part);
        if (std::abs(by(long(j))) * span.length(int(j)) > takes_part * row.norm()) each.of.push_back(kept[j]);
      }
      if (std::abs(off) <= same_value * size + tolerance) add(std::move(each));
    }
  }
  return out;
}

}  // namespace lagroid
