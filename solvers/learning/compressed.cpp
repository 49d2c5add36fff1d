#include <lagroid/solvers/learning/compressed.hpp>

#include <Eigen/QR>

#include <algorithm>

namespace lagroid::learning {

Compressed::Compressed(Eigen::Index parameters)
    // The triangle's own rows are turned again with every block: long blocks make that rare.
    : stack_(8 * (parameters + 1) + 256, parameters + 1), triangle_(parameters + 1, parameters + 1) {}

void Compressed::clear() { used_ = 0; }

void Compressed::add(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  for (Eigen::Index done = 0; done < rows.rows();) {
    if (used_ == stack_.rows()) fold();
    const Eigen::Index now = std::min(rows.rows() - done, stack_.rows() - used_);
    stack_.middleRows(used_, now) = rows.middleRows(done, now);
    used_ += now;
    done += now;
  }
}

void Compressed::fold() {
  const Eigen::Index n = stack_.cols();
  // In a matrix of its own, which is factored in place.
  Eigen::HouseholderQR<Eigen::MatrixXd> qr(stack_.topRows(used_));
  const Eigen::Index rows = std::min(used_, n);
  stack_.topRows(rows) = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  used_ = rows;
}

const Eigen::MatrixXd& Compressed::triangle() {
  fold();
  triangle_.setZero();
  triangle_.topRows(used_) = stack_.topRows(used_);
  return triangle_;
}

}  // namespace lagroid::learning
