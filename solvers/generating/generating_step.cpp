#include <lagroid/solvers/generating/generating_step.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace lagroid {

GeneratingStep::GeneratingStep(const SizedHamiltonian& hamiltonian, GeneratingType type)
    : hamiltonian_(hamiltonian), type_(type), n_(hamiltonian.dimension()), k_(hamiltonian.constraints()) {
  newton_.resize(3 * n_ + k_);
  for (Eigen::VectorXd* each : {&base_, &far_, &to_}) each->setZero(n_);
  reaction_.setZero(n_, k_);
  w_.resize(SecondOrder::count(2 * n_) + 2 * std::size_t(n_ * (1 + 2 * n_)));
  h_.resize(SecondOrder::count(2 * n_));
  c_.resize(std::size_t(k_) * SecondOrder::count(n_));
}

/// Unknowns are p~, sigma, then p1 (type II) or q1 (type III), then lambda; equations W_{p~} = 0, P = p1, the third
/// that of the start, then C(q1) = 0.
void GeneratingStep::write_equations(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double t, double h) {
  const bool two = type_ == GeneratingType::two;
  const auto inner = newton_.unknown.head(n_);
  const auto sigma = newton_.unknown.segment(n_, n_);
  const auto third = newton_.unknown.segment(2 * n_, n_);
  const SecondOrder constraint{c_.data(), n_}, w{w_.data(), 2 * n_};
  newton_.matrix.setZero();
  if (k_ > 0) hamiltonian_.constraint(q.data(), c_.data());
  for (int a = 0; a < k_; ++a)
    for (int i = 0; i < n_; ++i) reaction_(i, a) = constraint.after(a).slope(i);
  if (two) {
    base_ = q;
    far_ = third;
  } else {
    base_ = third;
    far_ = p;
    far_.noalias() += reaction_ * newton_.unknown.tail(k_);
  }
  const auto [from, along] = span(t, h);
  hamiltonian_.generating(from, base_.data(), inner.data(), sigma.data(), far_.data(), along, w_.data());
  const double* end_p = w_.data() + SecondOrder::count(2 * n_);
  const double* end_p_by = end_p + n_;
  const double* end_q = end_p_by + 2 * n_ * n_;
  const double* end_q_by = end_q + n_;
  const auto by = [&](const double* table, int i, int j) { return table[i * 2 * n_ + j]; };
  // Of a derivative of W: what the ends add to it, and the rest.
  const auto size_of_terms = [&](int column) {
    double rest = w.slope(column), size = 0;
    for (int j = 0; j < n_; ++j)
      for (const double each : {by(end_q_by, j, column) * far_(j), by(end_p_by, j, column) * sigma(j)}) {
        rest -= each;
        size += std::abs(each);
      }
    return size + std::abs(rest);
  };
  for (int i = 0; i < n_; ++i) {
    const int stationary = i, arrives = n_ + i, starts = 2 * n_ + i;
    newton_.residual(stationary) = w.slope(n_ + i);
    newton_.residual(arrives) = end_p[i] - far_(i);
    newton_.terms(arrives) = std::abs(end_p[i]) + std::abs(far_(i)) + std::abs(inner(i));
    newton_.terms(stationary) = size_of_terms(n_ + i) + std::abs(end_q[i] - base_(i));  // what the action is made of
    for (int j = 0; j < n_; ++j) {
      newton_.matrix(stationary, j) = w.second(n_ + i, n_ + j);
      newton_.matrix(stationary, n_ + j) = by(end_p_by, j, n_ + i);
      newton_.matrix(arrives, j) = by(end_p_by, i, n_ + j);
    }
    if (two) {
      newton_.residual(starts) = w.slope(i) - p(i);
      newton_.terms(starts) = size_of_terms(i) + std::abs(p(i)) + std::abs(end_p[i] - inner(i));
      newton_.matrix(arrives, 2 * n_ + i) = -1;
      for (int j = 0; j < n_; ++j) {
        newton_.matrix(stationary, 2 * n_ + j) = by(end_q_by, j, n_ + i);
        newton_.matrix(starts, j) = w.second(i, n_ + j);
        newton_.matrix(starts, n_ + j) = by(end_p_by, j, i);
        newton_.matrix(starts, 2 * n_ + j) = by(end_q_by, j, i);
      }
      for (int a = 0; a < k_; ++a) {
        newton_.residual(starts) -= reaction_(i, a) * newton_.unknown(3 * n_ + a);
        newton_.terms(starts) += std::abs(reaction_(i, a) * newton_.unknown(3 * n_ + a));
        newton_.matrix(starts, 3 * n_ + a) = -reaction_(i, a);
      }
      to_(i) = end_q[i] - sigma(i);
    } else {
      newton_.residual(starts) = end_q[i] - sigma(i) - q(i);
      newton_.terms(starts) = std::abs(end_q[i]) + std::abs(sigma(i)) + std::abs(q(i)) + std::abs(base_(i));
      newton_.matrix(starts, n_ + i) = -1;
      for (int j = 0; j < n_; ++j) {
        newton_.matrix(stationary, 2 * n_ + j) = w.second(j, n_ + i);
        newton_.matrix(arrives, 2 * n_ + j) = by(end_p_by, i, j);
        newton_.matrix(starts, j) = by(end_q_by, i, n_ + j);
        newton_.matrix(starts, 2 * n_ + j) = by(end_q_by, i, j);
      }
      for (int a = 0; a < k_; ++a) {
        newton_.matrix(arrives, 3 * n_ + a) = -reaction_(i, a);
        for (int j = 0; j < n_; ++j)
          newton_.matrix(stationary, 3 * n_ + a) += by(end_q_by, j, n_ + i) * reaction_(j, a);
      }
      to_(i) = third(i);
    }
  }
  // A component may be zero by symmetry: its rounding is that of the others.
  for (int block = 0; block < 3; ++block)
    newton_.terms.segment(block * n_, n_).setConstant(newton_.terms.segment(block * n_, n_).maxCoeff());
  // A unit of momenta that makes what they do to places as large as what places do to them.
  double forces = 0, moves = 0;
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j < n_; ++j) {
      forces = std::max(forces, std::abs(by(end_p_by, i, j)));
      moves = std::max(moves, std::abs(by(end_q_by, i, n_ + j)));
    }
  const double momentum = moves > 0 ? (forces > 0 ? std::sqrt(forces / moves) : 1 / moves) : 1;
  newton_.units.setOnes();
  newton_.units.head(n_).setConstant(momentum);
  if (two) newton_.units.segment(2 * n_, n_).setConstant(momentum);
  if (k_ > 0) newton_.units.tail(k_).setConstant(momentum / reaction_.cwiseAbs().maxCoeff());
  if (!std::isfinite(w.value())) newton_.residual(0) = w.value();  // slopes may be numbers where H is none
  if (k_ == 0) return;
  hamiltonian_.constraint(to_.data(), c_.data());
  for (int a = 0; a < k_; ++a) {
    const int row = 3 * n_ + a;
    const SecondOrder c = constraint.after(a);
    newton_.residual(row) = c.value();
    newton_.terms(row) = std::abs(c.value());
    for (int i = 0; i < n_; ++i) {
      const double slope_i = c.slope(i);
      newton_.terms(row) += std::abs(slope_i * to_(i));
      if (two) {
        for (int j = 0; j < n_; ++j) newton_.matrix(row, j) += slope_i * by(end_q_by, i, n_ + j);
        newton_.matrix(row, n_ + i) -= slope_i;
      } else {
        newton_.matrix(row, 2 * n_ + i) = slope_i;
      }
    }
  }
}

StepReport GeneratingStep::take(SizedState& z, double t, double h) {
  constexpr int most_iterations = 50;
  const bool two = type_ == GeneratingType::two;
  newton_.unknown.setZero();
  newton_.unknown.head(n_) = z.momentum;
  newton_.unknown.segment(2 * n_, n_) = two ? z.momentum : z.position;
  const StepReport report = newton_.solve([&] { write_equations(z.position, z.momentum, t, h); }, 0, most_iterations);
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
  SizedSlopes out{newton_.matrix, Eigen::MatrixXd::Zero(3 * n_, columns), Eigen::MatrixXd::Zero(2 * n_, 3 * n_),
                  Eigen::MatrixXd::Zero(2 * n_, columns)};
  const SecondOrder w{w_.data(), 2 * n_};
  const double* end_p_by = w_.data() + SecondOrder::count(2 * n_) + n_;
  const double* end_q_by = end_p_by + 2 * n_ * n_ + n_;
  std::vector<double> varied(std::size_t(parameters * 4 * n_));
  const auto [from, along] = span(t, h);
  hamiltonian_.by_parameters(from, base_.data(), newton_.unknown.data(), newton_.unknown.data() + n_, far_.data(),
                             along, varied.data());
  const auto by = [&](const double* table, int i, int j) { return table[i * 2 * n_ + j]; };
  for (int i = 0; i < n_; ++i) {
    const int stationary = i, arrives = n_ + i, starts = 2 * n_ + i, place = i, momentum = n_ + i;
    for (int a = 0; a < parameters; ++a) {
      const double* each = varied.data() + a * 4 * n_;
      const double w_q = each[i], end_p = each[2 * n_ + i], end_q = each[3 * n_ + i];
      out.equations_by_start(stationary, 2 * n_ + a) = each[n_ + i];
      out.equations_by_start(arrives, 2 * n_ + a) = end_p;
      out.equations_by_start(starts, 2 * n_ + a) = two ? w_q : end_q;
      (two ? out.end_by_start(place, 2 * n_ + a) : out.end_by_start(momentum, 2 * n_ + a)) = two ? end_q : w_q;
    }
    for (int j = 0; j < n_; ++j) {
      if (two) {
        out.equations_by_start(stationary, j) = w.second(j, n_ + i);
        out.equations_by_start(arrives, j) = by(end_p_by, i, j);
        out.equations_by_start(starts, j) = w.second(i, j);
        out.end_by_start(place, j) = by(end_q_by, i, j);
        out.end_by_unknowns(place, j) = by(end_q_by, i, n_ + j);
      } else {
        out.equations_by_start(stationary, n_ + j) = by(end_q_by, j, n_ + i);
        out.end_by_start(momentum, n_ + j) = by(end_q_by, j, i);
        out.end_by_unknowns(momentum, j) = w.second(i, n_ + j);
        out.end_by_unknowns(momentum, n_ + j) = by(end_p_by, j, i);
        out.end_by_unknowns(momentum, 2 * n_ + j) = w.second(i, j);
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

void GeneratingStep::find_velocity(const SizedState& z, double t, TangentState& out) const {
  constexpr int most_iterations = 60;
  const Eigen::VectorXd& q = z.position;
  const Eigen::VectorXd& p = z.momentum;
  detail::SizedNewton& newton = out.newton;
  newton.resize(k_);
  newton.unknown.setZero();
  out.momentum.resize(n_);
  out.velocity.resize(n_);
  if (k_ > 0) hamiltonian_.constraint(q.data(), c_.data());
  const SecondOrder constraint{c_.data(), n_}, energy{h_.data(), 2 * n_};
  const auto c = [&](int a, int i) { return constraint.after(a).slope(i); };
  const auto write_equations = [&] {
    for (int i = 0; i < n_; ++i) {
      out.momentum(i) = p(i);
      for (int a = 0; a < k_; ++a) out.momentum(i) += c(a, i) * newton.unknown(a);
    }
    hamiltonian_.hamiltonian(t, q.data(), out.momentum.data(), h_.data());
    for (int i = 0; i < n_; ++i) out.velocity(i) = energy.slope(n_ + i);
    newton.units.setOnes();
    for (int a = 0; a < k_; ++a) {
      double& residual = newton.residual(a) = 0;
      double& terms = newton.terms(a) = 0;
      for (int i = 0; i < n_; ++i) {
        residual += c(a, i) * out.velocity(i);
        terms += std::abs(c(a, i) * out.velocity(i));
      }
      for (int b = 0; b < k_; ++b) {
        double& entry = newton.matrix(a, b) = 0;
        for (int i = 0; i < n_; ++i)
          for (int j = 0; j < n_; ++j) entry += c(a, i) * energy.second(n_ + i, n_ + j) * c(b, j);
      }
    }
  };
  const bool solved = newton.solve(write_equations, 0, most_iterations).converged();
  out.energy = energy.value();
  out.energy_size = std::abs(out.energy);
  for (int i = 0; i < n_; ++i) out.energy_size += std::abs(out.velocity(i) * out.momentum(i));
  out.found = solved && std::isfinite(out.energy_size);
}

namespace {

std::vector<std::unique_ptr<SizedStep>> second_and_third(const SizedHamiltonian& hamiltonian) {
  std::vector<std::unique_ptr<SizedStep>> both;
  for (const GeneratingType type : {GeneratingType::two, GeneratingType::three})
    both.push_back(std::make_unique<GeneratingStep>(hamiltonian, type));
  return both;
}

}  // namespace

SymmetrisedGeneratingStep::SymmetrisedGeneratingStep(const SizedHamiltonian& hamiltonian)
    : ComposedSizedStep(second_and_third(hamiltonian), {0.5, 0.5}) {}

}  // namespace lagroid
