#include <lagroid/solvers/generating/generating_step.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

using detail::in_triangle;

GeneratingStep::GeneratingStep(const SizedHamiltonian& hamiltonian, GeneratingType type)
    : hamiltonian_(hamiltonian), type_(type), n_(hamiltonian.dimension()), k_(hamiltonian.constraints()) {
  const int unknowns = 3 * n_ + k_;
  for (Eigen::VectorXd* each : {&unknown_, &residual_, &terms_, &update_}) each->setZero(unknowns);
  for (Eigen::VectorXd* each : {&base_, &far_, &to_}) each->setZero(n_);
  matrix_.setZero(unknowns, unknowns);
  for (Eigen::MatrixXd* each : {&reaction_, &gradient_}) each->setZero(n_, k_);
  factor_ = Eigen::PartialPivLU<Eigen::MatrixXd>(unknowns);
  const std::size_t n = std::size_t(n_), k = std::size_t(k_);
  w_.resize(1 + 2 * n + n * (2 * n + 1) + 2 * (n + 2 * n * n));
  h_.resize(1 + 2 * n + n * (2 * n + 1));
  c_.resize(k * (1 + n + n * (n + 1) / 2));
}

/// Unknowns are p~, sigma, then p1 (type II) or q1 (type III), then lambda; equations W_{p~} = 0, P = p1, the third
/// that of the start, then C(q1) = 0.
void GeneratingStep::write_equations(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double h) {
  const bool two = type_ == GeneratingType::two;
  const auto inner = unknown_.head(n_);
  const auto sigma = unknown_.segment(n_, n_);
  const auto third = unknown_.segment(2 * n_, n_);
  const std::size_t each_c = std::size_t(1 + n_ + n_ * (n_ + 1) / 2);
  const auto c = [&](int a, int j) { return c_[std::size_t(a) * each_c + std::size_t(j)]; };
  matrix_.setZero();
  if (k_ > 0) hamiltonian_.constraint(q.data(), c_.data());
  for (int a = 0; a < k_; ++a)
    for (int i = 0; i < n_; ++i) reaction_(i, a) = c(a, 1 + i);
  if (two) {
    base_ = q;
    far_ = third;
  } else {
    base_ = third;
    far_ = p;
    far_.noalias() += reaction_ * unknown_.tail(k_);
  }
  hamiltonian_.generating(base_.data(), inner.data(), sigma.data(), far_.data(), two ? h : -h, w_.data());
  const double* slope = w_.data() + 1;
  const double* second = slope + 2 * n_;
  const double* end_p = second + n_ * (2 * n_ + 1);
  const double* end_p_by = end_p + n_;
  const double* end_q = end_p_by + 2 * n_ * n_;
  const double* end_q_by = end_q + n_;
  const auto by = [&](const double* table, int i, int j) { return table[i * 2 * n_ + j]; };
  for (int i = 0; i < n_; ++i) {
    const int stationary = i, arrives = n_ + i, starts = 2 * n_ + i;
    residual_(stationary) = slope[n_ + i];
    residual_(arrives) = end_p[i] - far_(i);
    terms_(stationary) = std::abs(sigma(i));
    terms_(arrives) = std::abs(end_p[i]) + std::abs(far_(i));
    for (int j = 0; j < n_; ++j) {
      matrix_(stationary, j) = second[in_triangle(n_ + i, n_ + j, 2 * n_)];
      matrix_(stationary, n_ + j) = by(end_p_by, j, n_ + i);
      matrix_(arrives, j) = by(end_p_by, i, n_ + j);
      terms_(stationary) += std::abs(by(end_q_by, j, n_ + i) * far_(j)) + std::abs(by(end_p_by, j, n_ + i) * sigma(j));
    }
    if (two) {
      residual_(starts) = slope[i] - p(i);
      terms_(starts) = std::abs(slope[i]) + std::abs(p(i));
      matrix_(arrives, 2 * n_ + i) = -1;
      for (int j = 0; j < n_; ++j) {
        matrix_(stationary, 2 * n_ + j) = by(end_q_by, j, n_ + i);
        matrix_(starts, j) = second[in_triangle(i, n_ + j, 2 * n_)];
        matrix_(starts, n_ + j) = by(end_p_by, j, i);
        matrix_(starts, 2 * n_ + j) = by(end_q_by, j, i);
      }
      for (int a = 0; a < k_; ++a) {
        residual_(starts) -= reaction_(i, a) * unknown_(3 * n_ + a);
        terms_(starts) += std::abs(reaction_(i, a) * unknown_(3 * n_ + a));
        matrix_(starts, 3 * n_ + a) = -reaction_(i, a);
      }
      to_(i) = end_q[i] - sigma(i);
    } else {
      residual_(starts) = end_q[i] - sigma(i) - q(i);
      terms_(starts) = std::abs(end_q[i]) + std::abs(sigma(i)) + std::abs(q(i));
      matrix_(starts, n_ + i) = -1;
      for (int j = 0; j < n_; ++j) {
        matrix_(stationary, 2 * n_ + j) = second[in_triangle(j, n_ + i, 2 * n_)];
        matrix_(arrives, 2 * n_ + j) = by(end_p_by, i, j);
        matrix_(starts, j) = by(end_q_by, i, n_ + j);
        matrix_(starts, 2 * n_ + j) = by(end_q_by, i, j);
      }
      for (int a = 0; a < k_; ++a) {
        matrix_(arrives, 3 * n_ + a) = -reaction_(i, a);
        for (int j = 0; j < n_; ++j) matrix_(stationary, 3 * n_ + a) += by(end_q_by, j, n_ + i) * reaction_(j, a);
      }
      to_(i) = third(i);
    }
  }
  // A component may be zero by symmetry: its rounding is that of the others.
  for (int block = 0; block < 3; ++block)
    terms_.segment(block * n_, n_).setConstant(terms_.segment(block * n_, n_).maxCoeff());
  if (!std::isfinite(w_.front())) residual_(0) = w_.front();  // slopes may be numbers where H is none
  if (k_ == 0) return;
  hamiltonian_.constraint(to_.data(), c_.data());
  for (int a = 0; a < k_; ++a) {
    const int row = 3 * n_ + a;
    residual_(row) = c(a, 0);
    terms_(row) = std::abs(c(a, 0));
    for (int i = 0; i < n_; ++i) {
      const double slope_i = c(a, 1 + i);
      terms_(row) += std::abs(slope_i * to_(i));
      if (two) {
        for (int j = 0; j < n_; ++j) matrix_(row, j) += slope_i * by(end_q_by, i, n_ + j);
        matrix_(row, n_ + i) -= slope_i;
      } else {
        matrix_(row, 2 * n_ + i) = slope_i;
      }
    }
  }
}

StepReport GeneratingStep::take(Eigen::VectorXd& q, Eigen::VectorXd& p, double /*t*/, double h) {
  const bool two = type_ == GeneratingType::two;
  unknown_.setZero();
  unknown_.head(n_) = p;
  unknown_.segment(2 * n_, n_) = two ? p : q;
  const StepReport report = detail::newton_of_any_size([&] { write_equations(q, p, h); }, unknown_, residual_, terms_,
                                                       matrix_, update_, factor_);
  if (report.converged()) {
    q = to_;
    if (two) {
      p = far_;
    } else {
      std::copy_n(w_.begin() + 1, n_, p.data());
    }
  }
  return report;
}

StepReport SymmetrisedGeneratingStep::take(Eigen::VectorXd& q, Eigen::VectorXd& p, double t, double h) {
  q_ = q;
  p_ = p;
  StepReport report = first_.take(q_, p_, t, h / 2);
  if (!report.converged()) return report;
  const int iterations = report.iterations;
  report = second_.take(q_, p_, t + h / 2, h / 2);
  report.iterations += iterations;
  if (report.converged()) {
    q = q_;
    p = p_;
  }
  return report;
}

void GeneratingStep::find_velocity(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double /*t*/,
                                   TangentState& out) const {
  constexpr int most_iterations = 60;
  out.found = false;
  out.momentum = p;
  out.velocity.setZero(n_);
  out.nu.setZero(k_);
  out.matrix.resize(k_, k_);
  out.residual.resize(k_);
  out.update.resize(k_);
  if (out.factor.rows() != k_) out.factor = Eigen::PartialPivLU<Eigen::MatrixXd>(k_);
  if (k_ > 0) hamiltonian_.constraint(q.data(), c_.data());
  const std::size_t each_c = std::size_t(1 + n_ + n_ * (n_ + 1) / 2);
  const auto c = [&](int a, int i) { return c_[std::size_t(a) * each_c + std::size_t(1 + i)]; };
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    hamiltonian_.hamiltonian(q.data(), out.momentum.data(), h_.data());
    const double* slope = h_.data() + 1 + n_;
    const double* second = h_.data() + 1 + 2 * n_;
    for (int i = 0; i < n_; ++i) out.velocity(i) = slope[i];
    double ratio = 0;
    for (int a = 0; a < k_; ++a) {
      double sum = 0, terms = 0;
      for (int i = 0; i < n_; ++i) {
        sum += c(a, i) * slope[i];
        terms += std::abs(c(a, i) * slope[i]);
      }
      out.residual(a) = sum;
      if (!std::isfinite(sum)) return;
      if (sum != 0) ratio = std::max(ratio, std::abs(sum) / (4 * std::numeric_limits<double>::epsilon() * terms));
      for (int b = 0; b < k_; ++b) {
        out.matrix(a, b) = 0;
        for (int i = 0; i < n_; ++i)
          for (int j = 0; j < n_; ++j)
            out.matrix(a, b) += c(a, i) * second[in_triangle(n_ + i, n_ + j, 2 * n_)] * c(b, j);
      }
    }
    if (ratio <= 1 || (ratio <= 100 && ratio >= last / 2)) {
      out.energy = h_.front();
      out.energy_size = std::abs(h_.front());
      for (int i = 0; i < n_; ++i) out.energy_size += std::abs(slope[i] * out.momentum(i));
      out.found = std::isfinite(out.energy_size);
      return;
    }
    last = ratio;
    if (!detail::solve_equilibrated(out.factor, out.matrix, out.residual, out.update)) return;
    out.nu -= out.update;
    for (int i = 0; i < n_; ++i) {
      out.momentum(i) = p(i);
      for (int a = 0; a < k_; ++a) out.momentum(i) += c(a, i) * out.nu(a);
    }
  }
}

}  // namespace lagroid
