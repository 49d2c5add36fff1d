#include <lagroid/solvers/galerkin/curve_step.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lagroid {

using detail::in_triangle;

namespace {

template <class Rule, class Visit> void visit_rule(const Visit& visit) {
  const Rule& rule = Rule::rule();
  for (std::size_t i = 0; i < std::size_t(Rule::points); ++i)
    visit(i, rule.node[i], rule.weight[i], rule.value[i], rule.derivative[i]);
}
template <CurveQuadrature Kind, class Visit> void visit_points(int degree, const Visit& visit) {
  switch (degree) {
    case 1:
      if constexpr (Kind != CurveQuadrature::lobatto_pair) return visit_rule<CurveRule<1, Kind>>(visit);
      break;
    case 2:
      return visit_rule<CurveRule<2, Kind>>(visit);
    case 3:
      return visit_rule<CurveRule<3, Kind>>(visit);
    case 4:
      return visit_rule<CurveRule<4, Kind>>(visit);
    case 5:
      return visit_rule<CurveRule<5, Kind>>(visit);
    default:
      break;
  }
  throw std::invalid_argument("there is no curve of this degree and quadrature");
}
template <class Visit> void visit_points(const CurveChoice& choice, const Visit& visit) {
  switch (choice.points) {
    case CurveQuadrature::gauss:
      return visit_points<CurveQuadrature::gauss>(choice.degree, visit);
    case CurveQuadrature::lobatto:
      return visit_points<CurveQuadrature::lobatto>(choice.degree, visit);
    case CurveQuadrature::lobatto_pair:
      return visit_points<CurveQuadrature::lobatto_pair>(choice.degree, visit);
  }
}

/// Where the curve's nodes are, after the first.
std::vector<double> lobatto_nodes(int degree) {
  std::vector<double> out;
  const auto take = [&](const auto& nodes) { out.assign(nodes.node.begin() + 1, nodes.node.end()); };
  if (degree == 1) take(LobattoNodes<1>());
  if (degree == 2) take(LobattoNodes<2>());
  if (degree == 3) take(LobattoNodes<3>());
  if (degree == 4) take(LobattoNodes<4>());
  if (degree == 5) take(LobattoNodes<5>());
  return out;
}

}  // namespace

CurveStep::CurveStep(const SizedLagrangian& lagrangian, const CurveChoice& choice)
    : lagrangian_(lagrangian),
      n_(lagrangian.sizes().dimension),
      k_(lagrangian.sizes().constraints),
      degree_(choice.degree) {
  const bool trapezoid = choice.points == CurveQuadrature::lobatto && choice.degree == 1;
  if (k_ > 0 && !trapezoid && choice.points != CurveQuadrature::lobatto_pair)
    throw std::invalid_argument("curves keep constraints at the points of the trapezoid or of Lobatto's pair alone");
  int unknowns = n_ * degree_;
  curve_nodes_ = lobatto_nodes(degree_);
  visit_points(choice, [&](std::size_t, double node, double weight, const auto& value, const auto& rate) {
    Point point{node, weight, {value.begin() + 1, value.end()}, {rate.begin() + 1, rate.end()}};
    if (k_ > 0 && node > 0 && node < 1) {
      point.multipliers = unknowns;
      unknowns += k_;
    }
    points_.push_back(std::move(point));
  });
  first_multiplier_ = unknowns;
  unknowns += k_;
  for (Eigen::VectorXd* each : {&unknown_, &residual_, &terms_, &update_}) each->setZero(unknowns);
  for (Eigen::VectorXd* each : {&end_momentum_, &impulse_, &x_, &v_, &place_slope_, &velocity_slope_})
    each->setZero(n_);
  matrix_.setZero(unknowns, unknowns);
  for (Eigen::MatrixXd* each : {&place_by_, &velocity_by_}) each->setZero(n_, n_);
  gradient_.setZero(n_, k_);
  factor_ = Eigen::PartialPivLU<Eigen::MatrixXd>(unknowns);
  l_.resize(lagrangian.lagrangian_numbers());
  c_.resize(lagrangian.constraint_numbers());
  f_.resize(lagrangian.force_numbers());
}

void CurveStep::add_to_node(int j, int column, double scale, const Eigen::MatrixXd& block) {
  // The last node's is the momentum at the end, which the equation at the start has with the other sign.
  const bool last = j + 1 == degree_;
  matrix_.block(last ? 0 : n_ * (j + 1), column, n_, block.cols()) += (last ? -scale : scale) * block;
}

void CurveStep::add_to_node(int j, double scale, const Eigen::VectorXd& part) {
  const bool last = j + 1 == degree_;
  const int row = last ? 0 : n_ * (j + 1);
  residual_.segment(row, n_) += (last ? -scale : scale) * part;
  terms_.segment(row, n_) += std::abs(scale) * part.cwiseAbs();
  if (last) end_momentum_ += scale * part;
}

void CurveStep::add_point(const Point& point, const Eigen::VectorXd& q, double t, double h) {
  x_ = q;
  v_.setZero();
  for (int j = 0; j < degree_; ++j) {
    x_ += point.value[std::size_t(j)] * unknown_.segment(n_ * j, n_);
    v_ += (point.rate[std::size_t(j)] / h) * unknown_.segment(n_ * j, n_);
  }
  const double at = t + point.node * h;
  const double b = point.weight * h;
  lagrangian_.lagrangian(at, x_.data(), v_.data(), l_.data());
  if (!std::isfinite(l_.front())) residual_(0) = l_.front();  // slopes may be numbers where l is none
  const double* slope = l_.data() + 1;
  const double* second = slope + 2 * n_;
  if (lagrangian_.sizes().forced) lagrangian_.force(at, x_.data(), v_.data(), f_.data());
  if (point.multipliers >= 0) lagrangian_.constraint(x_.data(), c_.data());
  const std::size_t each_c = std::size_t(1 + n_ + n_ * (n_ + 1) / 2);
  const auto f = [&](int i, int j) { return f_.empty() ? 0 : f_[std::size_t(i * (1 + 2 * n_) + j)]; };
  const auto c = [&](int a, int j) { return c_[std::size_t(a) * each_c + std::size_t(j)]; };
  for (int i = 0; i < n_; ++i) {
    place_slope_(i) = slope[i] + f(i, 0);
    velocity_slope_(i) = slope[n_ + i];
    for (int a = 0; a < k_ && point.multipliers >= 0; ++a) {
      gradient_(i, a) = c(a, 1 + i);
      place_slope_(i) += gradient_(i, a) * unknown_(point.multipliers + a);
    }
  }
  impulse_ += b * place_slope_;
  residual_.head(n_) += b * place_slope_;
  terms_.head(n_) += std::abs(b) * place_slope_.cwiseAbs();
  for (int j = 0; j < degree_; ++j) {
    add_to_node(j, b * point.value[std::size_t(j)], place_slope_);
    add_to_node(j, point.weight * point.rate[std::size_t(j)], velocity_slope_);
  }
  for (int m = 0; m < degree_; ++m) {
    const double by_x = point.value[std::size_t(m)];
    const double by_v = point.rate[std::size_t(m)] / h;
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j) {
        double qq = second[in_triangle(i, j, 2 * n_)] + f(i, 1 + j);
        for (int a = 0; a < k_ && point.multipliers >= 0; ++a)
          qq += unknown_(point.multipliers + a) * c(a, 1 + n_ + int(in_triangle(i, j, n_)));
        place_by_(i, j) = qq * by_x + (second[in_triangle(i, n_ + j, 2 * n_)] + f(i, 1 + n_ + j)) * by_v;
        velocity_by_(i, j) =
            second[in_triangle(j, n_ + i, 2 * n_)] * by_x + second[in_triangle(n_ + i, n_ + j, 2 * n_)] * by_v;
      }
    matrix_.block(0, n_ * m, n_, n_) += b * place_by_;
    for (int j = 0; j < degree_; ++j) {
      add_to_node(j, n_ * m, b * point.value[std::size_t(j)], place_by_);
      add_to_node(j, n_ * m, point.weight * point.rate[std::size_t(j)], velocity_by_);
    }
  }
  if (point.multipliers < 0) return;
  matrix_.block(0, point.multipliers, n_, k_) += b * gradient_;
  for (int j = 0; j < degree_; ++j) add_to_node(j, point.multipliers, b * point.value[std::size_t(j)], gradient_);
  for (int a = 0; a < k_; ++a) {
    const int row = point.multipliers + a;
    residual_(row) = c(a, 0);
    terms_(row) = std::abs(c(a, 0));
    for (int i = 0; i < n_; ++i) {
      terms_(row) += std::abs(c(a, 1 + i) * x_(i));
      for (int m = 0; m < degree_; ++m) matrix_(row, n_ * m + i) = c(a, 1 + i) * point.value[std::size_t(m)];
    }
  }
}

void CurveStep::write_equations(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double t, double h) {
  for (Eigen::VectorXd* each : {&residual_, &terms_, &end_momentum_, &impulse_}) each->setZero();
  matrix_.setZero();
  residual_.head(n_) = p;
  terms_.head(n_) = p.cwiseAbs();
  for (const Point& point : points_) add_point(point, q, t, h);
  if (k_ == 0) return;
  const std::size_t each_c = std::size_t(1 + n_ + n_ * (n_ + 1) / 2);
  const auto c = [&](int a, int j) { return c_[std::size_t(a) * each_c + std::size_t(j)]; };
  lagrangian_.constraint(q.data(), c_.data());
  for (int a = 0; a < k_; ++a)
    for (int i = 0; i < n_; ++i) {
      matrix_(i, first_multiplier_ + a) = c(a, 1 + i);
      residual_(i) += c(a, 1 + i) * unknown_(first_multiplier_ + a);
      terms_(i) += std::abs(c(a, 1 + i) * unknown_(first_multiplier_ + a));
    }
  x_ = q + unknown_.segment(n_ * (degree_ - 1), n_);
  lagrangian_.constraint(x_.data(), c_.data());
  for (int a = 0; a < k_; ++a) {
    residual_(first_multiplier_ + a) = c(a, 0);
    terms_(first_multiplier_ + a) = std::abs(c(a, 0));
    for (int i = 0; i < n_; ++i) {
      matrix_(first_multiplier_ + a, n_ * (degree_ - 1) + i) = c(a, 1 + i);
      terms_(first_multiplier_ + a) += std::abs(c(a, 1 + i) * x_(i));
    }
  }
}

StepReport CurveStep::take(Eigen::VectorXd& q, Eigen::VectorXd& p, double t, double h) {
  StepReport report;
  find_velocity(q, p, t, start_);
  if (!start_.found) {
    const bool finite = q.allFinite() && p.allFinite() && std::isfinite(l_.front());
    report.status = finite ? SolveStatus::singular : SolveStatus::not_finite;
    return report;
  }
  unknown_.setZero();
  for (int j = 0; j < degree_; ++j) unknown_.segment(n_ * j, n_) = (curve_nodes_[std::size_t(j)] * h) * start_.velocity;
  report = detail::newton_of_any_size([&] { write_equations(q, p, t, h); }, unknown_, residual_, terms_, matrix_,
                                      update_, factor_);
  if (report.converged()) {
    q += unknown_.segment(n_ * (degree_ - 1), n_);
    p = end_momentum_ + residual_.head(n_);  // p0 and the impulse, which a symmetry does not change
  }
  return report;
}

void CurveStep::find_velocity(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double t, TangentState& out) const {
  constexpr int most_iterations = 60;
  const int size = n_ + k_;
  if (!out.found || out.velocity.size() != n_) out.velocity.setZero(n_);
  out.found = false;
  out.momentum.resize(n_);
  out.nu.setZero(k_);
  out.matrix.resize(size, size);
  out.residual.resize(size);
  out.update.resize(size);
  if (out.factor.rows() != size) out.factor = Eigen::PartialPivLU<Eigen::MatrixXd>(size);
  if (k_ > 0) lagrangian_.constraint(q.data(), c_.data());
  const std::size_t each_c = std::size_t(1 + n_ + n_ * (n_ + 1) / 2);
  const auto c = [&](int a, int i) { return c_[std::size_t(a) * each_c + std::size_t(1 + i)]; };
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    lagrangian_.lagrangian(t, q.data(), out.velocity.data(), l_.data());
    const double* slope = l_.data() + 1 + n_;
    const double* second = l_.data() + 1 + 2 * n_;
    double ratio = 0;
    const auto measure = [&](int row, double terms) {
      constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
      const double at = std::abs(out.residual(row));
      ratio = std::max(ratio, at == 0 ? 0 : std::isfinite(at) ? at / (rounding * terms) : INFINITY);
    };
    out.matrix.setZero();
    for (int i = 0; i < n_; ++i) {
      out.momentum(i) = slope[i];
      out.residual(i) = slope[i] - p(i);
      double terms = std::abs(slope[i]) + std::abs(p(i));
      for (int a = 0; a < k_; ++a) {
        out.residual(i) -= c(a, i) * out.nu(a);
        terms += std::abs(c(a, i) * out.nu(a));
        out.matrix(i, n_ + a) = -c(a, i);
        out.matrix(n_ + a, i) = c(a, i);
      }
      for (int j = 0; j < n_; ++j) {
        out.matrix(i, j) = second[in_triangle(n_ + i, n_ + j, 2 * n_)];
        terms += std::abs(out.matrix(i, j) * out.velocity(j));
      }
      measure(i, terms);
    }
    for (int a = 0; a < k_; ++a) {
      double sum = 0, terms = 0;
      for (int i = 0; i < n_; ++i) {
        sum += c(a, i) * out.velocity(i);
        terms += std::abs(c(a, i) * out.velocity(i));
      }
      out.residual(n_ + a) = sum;
      measure(n_ + a, terms);
    }
    if (!std::isfinite(ratio)) return;
    // The equations are asked whether they determine v, even where the guess is a solution.
    if (iteration > 0 && (ratio <= 1 || (ratio <= 100 && ratio >= last / 2))) {
      const double kinetic = out.momentum.dot(out.velocity);
      out.energy = kinetic - l_.front();
      out.energy_size = out.momentum.cwiseProduct(out.velocity).cwiseAbs().sum() + std::abs(l_.front());
      out.found = true;
      return;
    }
    last = ratio;
    if (!detail::solve_equilibrated(out.factor, out.matrix, out.residual, out.update)) return;
    out.velocity -= out.update.head(n_);
    out.nu -= out.update.tail(k_);
  }
}

}  // namespace lagroid
