#include <lagroid/solvers/generating/generating_step.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

using detail::in_triangle;

GeneratingStep::GeneratingStep(const SizedHamiltonian& hamiltonian, GeneratingType type)
    : hamiltonian_(hamiltonian), type_(type), n_(hamiltonian.dimension()), k_(hamiltonian.constraints()) {
  const int unknowns = 3 * n_ + k_;
  for (Eigen::VectorXd* each : {&unknown_, &residual_, &terms_, &update_, &units_}) each->setZero(unknowns);
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
  // Of a derivative of W: what the ends add to it, and the rest.
  const auto size_of_terms = [&](int column) {
    double rest = slope[column], size = 0;
    for (int j = 0; j < n_; ++j)
      for (const double each : {by(end_q_by, j, column) * far_(j), by(end_p_by, j, column) * sigma(j)}) {
        rest -= each;
        size += std::abs(each);
      }
    return size + std::abs(rest);
  };
  for (int i = 0; i < n_; ++i) {
    const int stationary = i, arrives = n_ + i, starts = 2 * n_ + i;
    residual_(stationary) = slope[n_ + i];
    residual_(arrives) = end_p[i] - far_(i);
    terms_(arrives) = std::abs(end_p[i]) + std::abs(far_(i)) + std::abs(inner(i));
    terms_(stationary) = size_of_terms(n_ + i) + std::abs(end_q[i] - base_(i));  // what the action is made of
    for (int j = 0; j < n_; ++j) {
      matrix_(stationary, j) = second[in_triangle(n_ + i, n_ + j, 2 * n_)];
      matrix_(stationary, n_ + j) = by(end_p_by, j, n_ + i);
      matrix_(arrives, j) = by(end_p_by, i, n_ + j);
    }
    if (two) {
      residual_(starts) = slope[i] - p(i);
      terms_(starts) = size_of_terms(i) + std::abs(p(i)) + std::abs(end_p[i] - inner(i));
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
  // A unit of momenta that makes what they do to places as large as what places do to them.
  double forces = 0, moves = 0;
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j < n_; ++j) {
      forces = std::max(forces, std::abs(by(end_p_by, i, j)));
      moves = std::max(moves, std::abs(by(end_q_by, i, n_ + j)));
    }
  const double momentum = moves > 0 ? (forces > 0 ? std::sqrt(forces / moves) : 1 / moves) : 1;
  units_.setOnes();
  units_.head(n_).setConstant(momentum);
  if (two) units_.segment(2 * n_, n_).setConstant(momentum);
  if (k_ > 0) units_.tail(k_).setConstant(momentum / reaction_.cwiseAbs().maxCoeff());
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

StepReport GeneratingStep::take(SizedState& z, double /*t*/, double h) {
  const bool two = type_ == GeneratingType::two;
  unknown_.setZero();
  unknown_.head(n_) = z.momentum;
  unknown_.segment(2 * n_, n_) = two ? z.momentum : z.position;
  const StepReport report = detail::newton_of_any_size([&] { write_equations(z.position, z.momentum, h); }, unknown_,
                                                       residual_, terms_, matrix_, update_, units_, factor_);
  if (report.converged()) {
    z.position = to_;
    if (two) {
      z.momentum = far_;
    } else {
      std::copy_n(w_.begin() + 1, n_, z.momentum.data());
    }
  }
  return report;
}

bool GeneratingStep::linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) {
  if (!take(z, t, h).converged()) return false;
  const bool two = type_ == GeneratingType::two;
  const int parameters = hamiltonian_.parameters(), columns = 2 * n_ + parameters;
  SizedSlopes out{matrix_, Eigen::MatrixXd::Zero(3 * n_, columns), Eigen::MatrixXd::Zero(2 * n_, 3 * n_),
                  Eigen::MatrixXd::Zero(2 * n_, columns)};
  const double* second = w_.data() + 1 + 2 * n_;
  const double* end_p_by = second + n_ * (2 * n_ + 1) + n_;
  const double* end_q_by = end_p_by + 2 * n_ * n_ + n_;
  std::vector<double> varied(std::size_t(parameters * 4 * n_));
  hamiltonian_.by_parameters(base_.data(), unknown_.data(), unknown_.data() + n_, far_.data(), two ? h : -h,
                             varied.data());
  const auto by = [&](const double* table, int i, int j) { return table[i * 2 * n_ + j]; };
  for (int i = 0; i < n_; ++i) {
    const int stationary = i, arrives = n_ + i, starts = 2 * n_ + i, place = i, momentum = n_ + i;
    for (int a = 0; a < parameters; ++a) {
      const double* w = varied.data() + a * 4 * n_;
      const double end_p = w[2 * n_ + i], end_q = w[3 * n_ + i];
      out.equations_by_start(stationary, 2 * n_ + a) = w[n_ + i];
      out.equations_by_start(arrives, 2 * n_ + a) = end_p;
      out.equations_by_start(starts, 2 * n_ + a) = two ? w[i] : end_q;
      (two ? out.end_by_start(place, 2 * n_ + a) : out.end_by_start(momentum, 2 * n_ + a)) = two ? end_q : w[i];
    }
    for (int j = 0; j < n_; ++j) {
      if (two) {
        out.equations_by_start(stationary, j) = second[in_triangle(j, n_ + i, 2 * n_)];
        out.equations_by_start(arrives, j) = by(end_p_by, i, j);
        out.equations_by_start(starts, j) = second[in_triangle(i, j, 2 * n_)];
        out.end_by_start(place, j) = by(end_q_by, i, j);
        out.end_by_unknowns(place, j) = by(end_q_by, i, n_ + j);
      } else {
        out.equations_by_start(stationary, n_ + j) = by(end_q_by, j, n_ + i);
        out.end_by_start(momentum, n_ + j) = by(end_q_by, j, i);
        out.end_by_unknowns(momentum, j) = second[in_triangle(i, n_ + j, 2 * n_)];
        out.end_by_unknowns(momentum, n_ + j) = by(end_p_by, j, i);
        out.end_by_unknowns(momentum, 2 * n_ + j) = second[in_triangle(i, j, 2 * n_)];
      }
    }
    if (two) {
      out.equations_by_start(starts, momentum) = -1;
      out.end_by_unknowns(place, n_ + i) = -1;
      out.end_by_unknowns(momentum, 2 * n_ + i) = 1;
    } else {
      out.equations_by_start(arrives, momentum) = -1;
      out.equations_by_start(starts, place) = -1;
      out.end_by_unknowns(place, 2 * n_ + i) = 1;
    }
  }
  stages.push_back(std::move(out));
  return true;
}

StepReport SymmetrisedGeneratingStep::take(SizedState& z, double t, double h) {
  trial_ = z;
  StepReport report = first_.take(trial_, t, h / 2);
  if (!report.converged()) return report;
  const int iterations = report.iterations;
  report = second_.take(trial_, t + h / 2, h / 2);
  report.iterations += iterations;
  if (report.converged()) std::swap(z, trial_);
  return report;
}

void GeneratingStep::find_velocity(const SizedState& z, double /*t*/, TangentState& out) const {
  constexpr int most_iterations = 60;
  const Eigen::VectorXd& q = z.position;
  const Eigen::VectorXd& p = z.momentum;
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
    out.units.setOnes(k_);
    if (!detail::solve_in_units(out.factor, out.matrix, out.residual, out.update, out.units)) return;
    out.nu -= out.update;
    for (int i = 0; i < n_; ++i) {
      out.momentum(i) = p(i);
      for (int a = 0; a < k_; ++a) out.momentum(i) += c(a, i) * out.nu(a);
    }
  }
}

}  // namespace lagroid
