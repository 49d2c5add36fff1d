#include <lagroid/solvers/sensitivity/times/derivative_chain.hpp>

namespace lagroid {

Eigen::MatrixXd ReplacedRows::forward(const Eigen::MatrixXd& directions) const {
  Eigen::MatrixXd out = directions;
  out.middleRows(first_, by_.rows()) = by_ * directions;
  return out;
}

Eigen::MatrixXd ReplacedRows::backward(const Eigen::MatrixXd& gradients) const {
  Eigen::MatrixXd out = gradients;
  out.middleRows(first_, by_.rows()).setZero();
  out += by_.transpose() * gradients.middleRows(first_, by_.rows());
  return out;
}

Eigen::MatrixXd forward(const Derivatives& parts, Eigen::MatrixXd directions) {
  for (const auto& part : parts) directions = part->forward(directions);
  return directions;
}

Eigen::MatrixXd backward(const Derivatives& parts, Eigen::MatrixXd gradients) {
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) gradients = (*part)->backward(gradients);
  return gradients;
}

namespace {

Eigen::MatrixXd with_rows(const Eigen::MatrixXd& x, int more) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(x.rows() + more, x.cols());
  out.topRows(x.rows()) = x;
  return out;
}

}  // namespace

Eigen::MatrixXd DerivativeChain::forward(const Eigen::MatrixXd& directions) const {
  return lagroid::forward(parts_, with_rows(directions, more_)).topRows(directions.rows());
}

Eigen::MatrixXd DerivativeChain::backward(const Eigen::MatrixXd& gradients) const {
  return lagroid::backward(parts_, with_rows(gradients, more_)).topRows(gradients.rows());
}

}  // namespace lagroid
