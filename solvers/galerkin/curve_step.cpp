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
  // Lobatto's points of the curve's degree are its nodes, the last of them its end.
  visit_points<CurveQuadrature::lobatto>(degree_,
                                         [&](std::size_t i, double node, double, const auto&, const auto& rate) {
                                           if (i > 0) curve_nodes_.push_back(node);
                                           rate_at_end_.assign(rate.begin() + 1, rate.end());
                                         });
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
  for (Eigen::VectorXd* each : {&unknown_, &residual_, &terms_, &update_, &units_}) each->setZero(unknowns);
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

void CurveStep::go_to(const Point& point, const Eigen::VectorXd& q, double t, double h) {
  x_ = q;
  v_.setZero();
  for (int j = 0; j < degree_; ++j) {
    x_ += point.value[std::size_t(j)] * unknown_.segment(n_ * j, n_);
    v_ += (point.rate[std::size_t(j)] / h) * unknown_.segment(n_ * j, n_);
  }
  const double at = t + point.node * h;
  lagrangian_.lagrangian(at, x_.data(), v_.data(), l_.data());
  if (lagrangian_.sizes().forced) lagrangian_.force(at, x_.data(), v_.data(), f_.data());
  if (point.multipliers >= 0) lagrangian_.constraint(x_.data(), c_.data());
}

double CurveStep::place_slope_by(const Point& point, int i, int j, bool velocity) const {
  const double* second = l_.data() + 1 + 2 * n_;
  double out = second[in_triangle(i, velocity ? n_ + j : j, 2 * n_)];
  if (!f_.empty()) out += f_[std::size_t(i * (1 + 2 * n_) + 1 + (velocity ? n_ + j : j))];
  if (point.multipliers >= 0 && !velocity) {
    const std::size_t each_c = std::size_t(1 + n_ + n_ * (n_ + 1) / 2);
    for (int a = 0; a < k_; ++a)
      out +=
          unknown_(point.multipliers + a) * c_[std::size_t(a) * each_c + std::size_t(1 + n_) + in_triangle(i, j, n_)];
  }
  return out;
}
double CurveStep::velocity_slope_by(int i, int j, bool velocity) const {
  const double* second = l_.data() + 1 + 2 * n_;
  return second[velocity ? in_triangle(n_ + i, n_ + j, 2 * n_) : in_triangle(j, n_ + i, 2 * n_)];
}

void CurveStep::add_point(const Point& point, const Eigen::VectorXd& q, double t, double h) {
  go_to(point, q, t, h);
  const double b = point.weight * h;
  if (!std::isfinite(l_.front())) residual_(0) = l_.front();  // slopes may be numbers where l is none
  const double* slope = l_.data() + 1;
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
        place_by_(i, j) = place_slope_by(point, i, j, false) * by_x + place_slope_by(point, i, j, true) * by_v;
        velocity_by_(i, j) = velocity_slope_by(i, j, false) * by_x + velocity_slope_by(i, j, true) * by_v;
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
  units_.setOnes();
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
  units_.tail(units_.size() - n_ * degree_).setConstant(detail::unit_of_multipliers(matrix_, n_ * degree_));
}

StepReport CurveStep::take(SizedState& z, double t, double h) {
  StepReport report;
  const Eigen::VectorXd& q = z.position;
  find_velocity(z, t, tangent_);
  if (!tangent_.found) {
    const bool finite = q.allFinite() && z.momentum.allFinite() && std::isfinite(l_.front());
    report.status = finite ? SolveStatus::singular : SolveStatus::not_finite;
    return report;
  }
  unknown_.setZero();
  for (int j = 0; j < degree_; ++j)
    unknown_.segment(n_ * j, n_) = (curve_nodes_[std::size_t(j)] * h) * tangent_.velocity;
  report = detail::newton_of_any_size([&] { write_equations(q, z.momentum, t, h); }, unknown_, residual_, terms_,
                                      matrix_, update_, units_, factor_);
  if (!report.converged()) return report;
  end_.position = q + unknown_.segment(n_ * (degree_ - 1), n_);
  end_.momentum = end_momentum_ + residual_.head(n_);  // p0 and the impulse, which a symmetry does not change
  // The velocity goes on along the curve.
  end_.velocity.setZero(n_);
  for (int j = 0; j < degree_; ++j) end_.velocity += (rate_at_end_[std::size_t(j)] / h) * unknown_.segment(n_ * j, n_);
  std::swap(z, end_);
  return report;
}

bool CurveStep::linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) {
  const Eigen::VectorXd from = z.position;
  if (!take(z, t, h).converged()) return false;
  const int unknowns = int(unknown_.size()), parameters = lagrangian_.sizes().parameters;
  const int columns = 2 * n_ + parameters, force_numbers = lagrangian_.sizes().forced ? n_ : 0;
  SizedSlopes out{matrix_, Eigen::MatrixXd::Zero(unknowns, columns), Eigen::MatrixXd::Zero(2 * n_, unknowns),
                  Eigen::MatrixXd::Zero(2 * n_, columns)};
  // q1 = q0 + y_s, p1 = p0 + the impulse, which the equation at the start has with the momentum at the end.
  out.end_by_start.topLeftCorner(n_, n_).setIdentity();
  out.end_by_start.block(n_, n_, n_, n_).setIdentity();
  out.end_by_unknowns.block(0, n_ * (degree_ - 1), n_, n_).setIdentity();
  out.equations_by_start.block(0, n_, n_, n_).setIdentity();
  std::vector<double> varied(lagrangian_.parameter_numbers());
  Eigen::MatrixXd place(n_, columns), velocity(n_, columns);
  for (const Point& point : points_) {
    go_to(point, from, t, h);
    lagrangian_.by_parameters(t + point.node * h, x_.data(), v_.data(), varied.data());
    const double b = point.weight * h;
    place.setZero();
    velocity.setZero();
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) {
        place(i, j) = place_slope_by(point, i, j, false);
        velocity(i, j) = velocity_slope_by(i, j, false);
      }
      for (int a = 0; a < parameters; ++a) {
        const double* each = varied.data() + a * (1 + 2 * n_ + force_numbers);
        place(i, 2 * n_ + a) = each[1 + i] + (force_numbers > 0 ? each[1 + 2 * n_ + i] : 0);
        velocity(i, 2 * n_ + a) = each[1 + n_ + i];
      }
    }
    out.end_by_start.bottomRows(n_) += b * place;
    out.equations_by_start.topRows(n_) += b * place;
    for (int j = 0; j < degree_; ++j) {
      const bool last = j + 1 == degree_;
      out.equations_by_start.middleRows(last ? 0 : n_ * (j + 1), n_) +=
          (last ? -1 : 1) *
          (b * point.value[std::size_t(j)] * place + point.weight * point.rate[std::size_t(j)] * velocity);
      for (int i = 0; i < n_; ++i)
        for (int k = 0; k < n_; ++k)
          out.end_by_unknowns(n_ + i, n_ * j + k) +=
              b * (place_slope_by(point, i, k, false) * point.value[std::size_t(j)] +
                   place_slope_by(point, i, k, true) * point.rate[std::size_t(j)] / h);
    }
  }
  stages.push_back(std::move(out));
  return true;
}

void CurveStep::find_velocity(const SizedState& z, double t, TangentState& out) const {
  constexpr int most_iterations = 60;
  const int size = n_ + k_;
  const Eigen::VectorXd& q = z.position;
  const Eigen::VectorXd& p = z.momentum;
  if (z.velocity.size() == n_) {
    out.velocity = z.velocity;
  } else {
    out.velocity.setZero(n_);
  }
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
    out.units.setOnes(size);
    if (k_ > 0) out.units.tail(k_).setConstant(detail::unit_of_multipliers(out.matrix, n_));
    if (!detail::solve_in_units(out.factor, out.matrix, out.residual, out.update, out.units)) return;
    out.velocity -= out.update.head(n_);
    out.nu -= out.update.tail(k_);
  }
}

}  // namespace lagroid
