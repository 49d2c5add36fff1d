#include <lagroid/solvers/galerkin/curve_step.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid {

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
  newton_.resize(unknowns);
  for (Eigen::VectorXd* each : {&end_momentum_, &impulse_, &x_, &v_, &place_slope_, &velocity_slope_})
    each->setZero(n_);
  for (Eigen::MatrixXd* each : {&place_by_, &velocity_by_}) each->setZero(n_, n_);
  gradient_.setZero(n_, k_);
  l_.resize(lagrangian.lagrangian_numbers());
  c_.resize(lagrangian.constraint_numbers());
  f_.resize(lagrangian.force_numbers());
}

int CurveStep::row_of_node(int j) const { return j + 1 == degree_ ? 0 : n_ * (j + 1); }

void CurveStep::add_to_node(int j, int column, double scale, const Eigen::MatrixXd& block) {
  // The last node's is the momentum at the end, which the equation at the start has with the other sign.
  const bool last = j + 1 == degree_;
  newton_.matrix.block(row_of_node(j), column, n_, block.cols()) += (last ? -scale : scale) * block;
}

void CurveStep::add_to_node(int j, double scale, const Eigen::VectorXd& part) {
  const bool last = j + 1 == degree_;
  const int row = row_of_node(j);
  newton_.residual.segment(row, n_) += (last ? -scale : scale) * part;
  newton_.terms.segment(row, n_) += std::abs(scale) * part.cwiseAbs();
  if (last) end_momentum_ += scale * part;
}

void CurveStep::go_to(const Point& point, const Eigen::VectorXd& q, double t, double h) {
  x_ = q;
  v_.setZero();
  for (int j = 0; j < degree_; ++j) {
    x_ += point.value[std::size_t(j)] * newton_.unknown.segment(n_ * j, n_);
    v_ += (point.rate[std::size_t(j)] / h) * newton_.unknown.segment(n_ * j, n_);
  }
  const double at = t + point.node * h;
  lagrangian_.lagrangian(at, x_.data(), v_.data(), l_.data());
  if (lagrangian_.sizes().forced) lagrangian_.force(at, x_.data(), v_.data(), f_.data());
  if (point.multipliers >= 0) lagrangian_.constraint(x_.data(), c_.data());
}

double CurveStep::place_slope_by(const Point& point, int i, int j, bool velocity) const {
  double out = SecondOrder{l_.data(), 2 * n_}.second(i, velocity ? n_ + j : j);
  if (!f_.empty()) out += f_[std::size_t(i * (1 + 2 * n_) + 1 + (velocity ? n_ + j : j))];
  if (point.multipliers >= 0 && !velocity)
    for (int a = 0; a < k_; ++a)
      out += newton_.unknown(point.multipliers + a) * SecondOrder{c_.data(), n_}.after(a).second(i, j);
  return out;
}
double CurveStep::velocity_slope_by(int i, int j, bool velocity) const {
  return SecondOrder{l_.data(), 2 * n_}.second(n_ + i, velocity ? n_ + j : j);
}

void CurveStep::add_point(const Point& point, const Eigen::VectorXd& q, double t, double h) {
  go_to(point, q, t, h);
  const double b = point.weight * h;
  if (!std::isfinite(l_.front())) newton_.residual(0) = l_.front();  // slopes may be numbers where l is none
  const SecondOrder l{l_.data(), 2 * n_}, constraint{c_.data(), n_};
  const auto force = [&](int i) { return f_.empty() ? 0 : f_[std::size_t(i * (1 + 2 * n_))]; };
  for (int i = 0; i < n_; ++i) {
    place_slope_(i) = l.slope(i) + force(i);
    velocity_slope_(i) = l.slope(n_ + i);
    for (int a = 0; a < k_ && point.multipliers >= 0; ++a) {
      gradient_(i, a) = constraint.after(a).slope(i);
      place_slope_(i) += gradient_(i, a) * newton_.unknown(point.multipliers + a);
    }
  }
  impulse_ += b * place_slope_;
  newton_.residual.head(n_) += b * place_slope_;
  newton_.terms.head(n_) += std::abs(b) * place_slope_.cwiseAbs();
  for (int j = 0; j < degree_; ++j) {
    add_to_node(j, b * point.value[std::size_t(j)], place_slope_);
    const double rate = point.weight * point.rate[std::size_t(j)];
    add_to_node(j, rate, velocity_slope_);
    // The parts of a momentum may cancel, all of them where it is zero: its rounding is theirs.
    for (int i = 0; i < n_; ++i)
      for (int m = 0; m < n_; ++m)
        newton_.terms(row_of_node(j) + i) += std::abs(rate * velocity_slope_by(i, m, true) * v_(m));
  }
  for (int m = 0; m < degree_; ++m) {
    const double by_x = point.value[std::size_t(m)];
    const double by_v = point.rate[std::size_t(m)] / h;
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j) {
        place_by_(i, j) = place_slope_by(point, i, j, false) * by_x + place_slope_by(point, i, j, true) * by_v;
        velocity_by_(i, j) = velocity_slope_by(i, j, false) * by_x + velocity_slope_by(i, j, true) * by_v;
      }
    newton_.matrix.block(0, n_ * m, n_, n_) += b * place_by_;
    for (int j = 0; j < degree_; ++j) {
      add_to_node(j, n_ * m, b * point.value[std::size_t(j)], place_by_);
      add_to_node(j, n_ * m, point.weight * point.rate[std::size_t(j)], velocity_by_);
    }
  }
  if (point.multipliers < 0) return;
  newton_.matrix.block(0, point.multipliers, n_, k_) += b * gradient_;
  for (int j = 0; j < degree_; ++j) add_to_node(j, point.multipliers, b * point.value[std::size_t(j)], gradient_);
  for (int a = 0; a < k_; ++a) {
    const int row = point.multipliers + a;
    const SecondOrder c = constraint.after(a);
    newton_.residual(row) = c.value();
    newton_.terms(row) = std::abs(c.value());
    for (int i = 0; i < n_; ++i) {
      newton_.terms(row) += std::abs(c.slope(i) * x_(i));
      for (int m = 0; m < degree_; ++m) newton_.matrix(row, n_ * m + i) = c.slope(i) * point.value[std::size_t(m)];
    }
  }
}

void CurveStep::write_equations(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double t, double h) {
  for (Eigen::VectorXd* each : {&newton_.residual, &newton_.terms, &end_momentum_, &impulse_}) each->setZero();
  newton_.matrix.setZero();
  newton_.residual.head(n_) = p;
  newton_.terms.head(n_) = p.cwiseAbs();
  for (const Point& point : points_) add_point(point, q, t, h);
  newton_.units.setOnes();
  if (k_ == 0) return;
  const SecondOrder constraint{c_.data(), n_};
  lagrangian_.constraint(q.data(), c_.data());
  for (int a = 0; a < k_; ++a)
    for (int i = 0; i < n_; ++i) {
      const double slope = constraint.after(a).slope(i), reaction = slope * newton_.unknown(first_multiplier_ + a);
      newton_.matrix(i, first_multiplier_ + a) = slope;
      newton_.residual(i) += reaction;
      newton_.terms(i) += std::abs(reaction);
    }
  x_ = q + newton_.unknown.segment(n_ * (degree_ - 1), n_);
  lagrangian_.constraint(x_.data(), c_.data());
  for (int a = 0; a < k_; ++a) {
    const int row = first_multiplier_ + a;
    const SecondOrder c = constraint.after(a);
    newton_.residual(row) = c.value();
    newton_.terms(row) = std::abs(c.value());
    for (int i = 0; i < n_; ++i) {
      newton_.matrix(row, n_ * (degree_ - 1) + i) = c.slope(i);
      newton_.terms(row) += std::abs(c.slope(i) * x_(i));
    }
  }
  newton_.units.tail(newton_.units.size() - n_ * degree_).setConstant(newton_.unit_of_multipliers(n_ * degree_));
}

StepReport CurveStep::take(SizedState& z, double t, double h) {
  constexpr int most_iterations = 50;
  StepReport report;
  const Eigen::VectorXd& q = z.position;
  find_velocity(z, t, tangent_);
  if (!tangent_.found) {
    const bool finite = q.allFinite() && z.momentum.allFinite() && std::isfinite(l_.front());
    report.status = finite ? SolveStatus::singular : SolveStatus::not_finite;
    return report;
  }
  newton_.unknown.setZero();
  for (int j = 0; j < degree_; ++j)
    newton_.unknown.segment(n_ * j, n_) = (curve_nodes_[std::size_t(j)] * h) * tangent_.velocity;
  report = newton_.solve([&] { write_equations(q, z.momentum, t, h); }, 0, most_iterations);
  if (!report.converged()) return report;
  end_.position = q + newton_.unknown.segment(n_ * (degree_ - 1), n_);
  end_.momentum = end_momentum_ + newton_.residual.head(n_);  // p0 and the impulse, which a symmetry does not change
  // The velocity goes on along the curve.
  end_.velocity.setZero(n_);
  for (int j = 0; j < degree_; ++j)
    end_.velocity += (rate_at_end_[std::size_t(j)] / h) * newton_.unknown.segment(n_ * j, n_);
  std::swap(z, end_);
  return report;
}

bool CurveStep::linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) {
  const Eigen::VectorXd from = z.position;
  if (!take(z, t, h).converged()) return false;
  const int unknowns = int(newton_.unknown.size()), parameters = lagrangian_.sizes().parameters;
  const int columns = 2 * n_ + parameters, force_numbers = lagrangian_.sizes().forced ? n_ : 0;
  SizedSlopes out{newton_.matrix, Eigen::MatrixXd::Zero(unknowns, columns), Eigen::MatrixXd::Zero(2 * n_, unknowns),
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
  const Eigen::VectorXd& q = z.position;
  const Eigen::VectorXd& p = z.momentum;
  detail::SizedNewton& newton = out.newton;
  newton.resize(n_ + k_);
  newton.unknown.setZero();
  auto v = newton.unknown.head(n_);
  auto nu = newton.unknown.tail(k_);
  if (z.velocity.size() == n_) v = z.velocity;
  out.momentum.resize(n_);
  if (k_ > 0) lagrangian_.constraint(q.data(), c_.data());
  const SecondOrder constraint{c_.data(), n_}, l{l_.data(), 2 * n_};
  const auto c = [&](int a, int i) { return constraint.after(a).slope(i); };
  const auto write_equations = [&] {
    lagrangian_.lagrangian(t, q.data(), v.data(), l_.data());
    newton.matrix.setZero();
    for (int i = 0; i < n_; ++i) {
      double& residual = newton.residual(i);
      double& terms = newton.terms(i);
      out.momentum(i) = l.slope(n_ + i);
      residual = l.slope(n_ + i) - p(i);
      terms = std::abs(l.slope(n_ + i)) + std::abs(p(i));
      for (int a = 0; a < k_; ++a) {
        residual -= c(a, i) * nu(a);
        terms += std::abs(c(a, i) * nu(a));
        newton.matrix(i, n_ + a) = -c(a, i);
        newton.matrix(n_ + a, i) = c(a, i);
      }
      for (int j = 0; j < n_; ++j) {
        newton.matrix(i, j) = l.second(n_ + i, n_ + j);
        terms += std::abs(newton.matrix(i, j) * v(j));
      }
    }
    for (int a = 0; a < k_; ++a) {
      double& residual = newton.residual(n_ + a) = 0;
      double& terms = newton.terms(n_ + a) = 0;
      for (int i = 0; i < n_; ++i) {
        residual += c(a, i) * v(i);
        terms += std::abs(c(a, i) * v(i));
      }
    }
    newton.units.setOnes();
    if (k_ > 0) newton.units.tail(k_).setConstant(newton.unit_of_multipliers(n_));
  };
  out.found = newton.solve(write_equations, 1, most_iterations).converged();
  out.velocity = v;
  out.energy = out.momentum.dot(out.velocity) - l.value();
  out.energy_size = out.momentum.cwiseProduct(out.velocity).cwiseAbs().sum() + std::abs(l.value());
}

}  // namespace lagroid
