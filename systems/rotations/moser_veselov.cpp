#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace lagroid {

LAGROID_STEPS(template, MoserVeselov);

namespace {

constexpr int highest_order = 10;

/// sum_k c_k t^k, as far as the highest order asks.
template <class S> using PowerSeries = std::array<S, highest_order>;

/// The coefficient of t^k in f g.
template <class S> S product_at(std::size_t k, const PowerSeries<S>& f, const PowerSeries<S>& g) {
  S sum = 0;
  for (std::size_t i = 0; i <= k; ++i) sum += f[i] * g[k - i];
  return sum;
}
template <class S> PowerSeries<S> product(const PowerSeries<S>& f, const PowerSeries<S>& g) {
  PowerSeries<S> out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = product_at(k, f, g);
  return out;
}
/// Requires g_0 = 1.
template <class S> PowerSeries<S> quotient(const PowerSeries<S>& f, const PowerSeries<S>& g) {
  PowerSeries<S> out{};
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = f[k] - product_at(k, out, g);
  return out;
}
template <class S> PowerSeries<S> sum(const PowerSeries<S>& f, const S& c, const PowerSeries<S>& g) {
  PowerSeries<S> out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = f[k] + c * g[k];
  return out;
}

/// The series of 1 / I~_1 and 1 / I~_3 in t^2, t half the step in units in which it is `unit`, for the trajectory
/// through M = (m1, 0, m3), given the squares of these.
///
/// Around that point time reversal is a symmetry, M(-t) = (M1, -M2, M3)(t), so that the quaternion of the arrow from -t
/// to t has no second component: of the equations h hat(M) = g D - D g^T at M(-t) the first and the third read h M1 = 2
/// g0 g1 I~_1 and h M3 = 2 g0 g3 I~_3. Put the exact motion in: M = (m1 u1, m1 m3 u2, m3 u3) and, from 0 to t, the
/// quaternion (q, m1 p1, m1 m3 p2, m3 p3); their differential equations contain m1 and m3 by their squares only, and no
/// quotient is left that a steady rotation, m1 or m3 = 0, could spoil.
template <class S>
std::array<PowerSeries<S>, 2> inverse_moments(const Vector<S, 3>& inverse_inertia, const S& m1_squared,
                                              const S& m3_squared, double unit) {
  const Vector<S, 3> w = unit * inverse_inertia;
  PowerSeries<S> u1{1}, u2{}, u3{1}, q{1}, p1{}, p2{}, p3{};
  for (std::size_t k = 0; k + 1 < q.size(); ++k) {
    const auto at = [k](const PowerSeries<S>& f, const PowerSeries<S>& g) { return product_at(k, f, g); };
    const auto integral = [k](const S& x) { return S(x / double(k + 1)); };
    const S m13 = m1_squared * m3_squared;
    u1[k + 1] = integral(m3_squared * (w(2) - w(1)) * at(u2, u3));
    u2[k + 1] = integral((w(0) - w(2)) * at(u3, u1));
    u3[k + 1] = integral(m1_squared * (w(1) - w(0)) * at(u1, u2));
    q[k + 1] =
        integral(-0.5 * (m1_squared * w(0) * at(p1, u1) + m13 * w(1) * at(p2, u2) + m3_squared * w(2) * at(p3, u3)));
    p1[k + 1] = integral(0.5 * (w(0) * at(q, u1) + m3_squared * (w(2) * at(p2, u3) - w(1) * at(p3, u2))));
    p2[k + 1] = integral(0.5 * (w(1) * at(q, u2) + w(0) * at(p3, u1) - w(2) * at(p1, u3)));
    p3[k + 1] = integral(0.5 * (w(2) * at(q, u3) + m1_squared * (w(1) * at(p1, u2) - w(0) * at(p2, u1))));
  }
  // (q, m1 p1, -m1 m3 p2, m3 p3) (q, m1 p1, m1 m3 p2, m3 p3)
  PowerSeries<S> g0 = product(q, q);
  g0 = sum<S>(g0, -m1_squared, product(p1, p1));
  g0 = sum<S>(g0, m1_squared * m3_squared, product(p2, p2));
  g0 = sum<S>(g0, -m3_squared, product(p3, p3));
  const PowerSeries<S> g1 = sum<S>(product(q, p1), -m3_squared, product(p2, p3));
  const PowerSeries<S> g3 = sum<S>(product(q, p3), m1_squared, product(p1, p2));
  const auto inverse = [&](const PowerSeries<S>& g, const PowerSeries<S>& u) {
    PowerSeries<S> out = quotient(product(g0, g), u);
    std::rotate(out.begin(), out.begin() + 1, out.end());
    for (S& c : out) c *= 2 / unit;
    return out;
  };
  return {inverse(g1, u1), inverse(g3, u3)};
}

/// The 1 / I~.
template <class S>
Vector<S, 3> modified_inverses(const Vector<S, 3>& inertia, const Vector<S, 3>& momentum, double h, int order) {
  std::array<int, 3> axis{0, 1, 2};
  std::sort(axis.begin(), axis.end(), [&](int i, int j) { return inertia(i) < inertia(j); });
  const auto [a, b, c] = axis;
  const Vector<S, 3> inverse = inertia.cwiseInverse();
  // The point without a component along the middle axis of the same |M| and energy: there is one on every trajectory.
  const S spread = inverse(a) - inverse(c);
  const S weight = spread > S(0) ? S((inverse(b) - inverse(c)) / spread) : S(0);
  const S squared = momentum(b) * momentum(b);
  const auto [first, third] =
      inverse_moments<S>({inverse(a), inverse(b), inverse(c)}, momentum(a) * momentum(a) + weight * squared,
                         momentum(c) * momentum(c) + (1 - weight) * squared, 0.5 * h);
  Vector<S, 3> out = Vector<S, 3>::Zero();
  for (int k = 0; k <= order - 2; k += 2) {
    out(a) += first[std::size_t(k)];
    out(c) += third[std::size_t(k)];
  }
  out(b) = out(c) + weight * (out(a) - out(c));
  return out;
}

/// sum_{i<j} d_i d_j.
double pairs_of(const Vector<double, 3>& d) { return d(0) * d(1) + d(1) * d(2) + d(2) * d(0); }

}  // namespace

Vector<double, 3> preprocess(const Vector<double, 3>& inertia, const Vector<double, 3>& momentum, double h, int order) {
  if (order < 2 || order > highest_order || order % 2 != 0)
    throw std::invalid_argument(fmt::format("discrete Moser-Veselov of order {}: must be 2, 4, 6, 8 or 10", order));
  if (!inertia.allFinite() || !momentum.allFinite() || !(inertia.minCoeff() > 0))
    throw std::invalid_argument("discrete Moser-Veselov: moments of inertia must be positive, momenta finite");
  if (!std::isfinite(h) || h == 0)
    throw std::invalid_argument(fmt::format("discrete Moser-Veselov with a step of {}", h));
  if (order == 2) return inertia;

  const Vector<double, 3> out = modified_inverses(inertia, momentum, h, order);
  if (!out.allFinite() || !(out.minCoeff() > 0))
    throw std::domain_error(
        fmt::format("discrete Moser-Veselov of order {}: a step of {} is too long for this momentum", order, h));
  return out.cwiseInverse();
}

Vector<VariedNumber, 3> preprocess(const Vector<VariedNumber, 3>& inertia, const Vector<VariedNumber, 3>& momentum,
                                   double h, int order) {
  if (order == 2) return inertia;
  return modified_inverses(inertia, momentum, h, order).cwiseInverse();
}

MoserVeselov MoserVeselov::preprocessed(const Vector<double, 3>& inertia, const Vector<double, 3>& momentum, double h,
                                        int order) {
  MoserVeselov system;
  system.h = h;
  system.inertia = inertia;
  system.modified = preprocess(inertia, momentum, h, order);
  system.order = order;
  if (!system.rodrigues(momentum))
    throw std::domain_error(
        fmt::format("discrete Moser-Veselov of order {}: there is no step of {} from this momentum", order, h));
  return system;
}

std::optional<Vector<double, 3>> MoserVeselov::rodrigues(const Vector<double, 3>& momentum, double& k) const {
  const Vector<double, 3> u = 0.5 * h * momentum;
  const double square = u.squaredNorm();
  const double determinant = modified.prod();
  const double trace = 0.5 * modified.sum();
  const double e = pairs_of(weights<double>());
  const double constant = determinant * u.cwiseQuotient(modified).dot(u);
  // Newton's iteration from the left, where f falls and is convex: up to `inflection` at most.
  const double inflection =
      0.5 * (trace - std::sqrt(std::max(0.0, (weights<double>().squaredNorm() - 4 * square) / 3)));
  for (;;) {
    const double b = square - k * trace + k * k;
    const double f = b * b + (e * k - determinant) * k + constant;
    const double slope = 2 * b * (2 * k - trace) + 2 * e * k - determinant;
    if (!(slope < 0 && k < inflection)) return std::nullopt;
    const double next = k - f / slope;
    if (!(next > k)) break;
    k = next;
  }
  const Matrix<double, 3, 3> matrix{
      {modified(0) - k, u(2), -u(1)}, {-u(2), modified(1) - k, u(0)}, {u(1), -u(0), modified(2) - k}};
  return Vector<double, 3>(matrix.inverse() * u);
}

bool MoserVeselov::admissible(const Matrix<double, 3, 3>& g) const {
  const Vector<double, 3> d = weights<double>();
  const double a = g.diagonal().dot(d);
  // The characteristic polynomial of gD is x^3 - a x^2 + b x - det D.
  const Matrix<double, 3, 3> y = g * d.asDiagonal();
  const double b = 0.5 * (a * a - (y * y).trace());
  return a > 0 && a * b > d.prod() && a * a + b > 0;
}

Step<MoserVeselov> MoserVeselov::first_guess(const State<SO3>& s) const {
  const auto r = rodrigues(s.momentum);
  return {r ? SO3::cayley(Vector<double, 3>(2 * *r)) : Matrix<double, 3, 3>::Identity(), {}};
}

StepReport MoserVeselovStep::solve(const MoserVeselov& system, const State<SO3>& state,
                                   StepSolution<MoserVeselov>& solution) {
  // The root is a constant of the motion: the search begins a little below the last one.
  constexpr double below = 1 - 1e-6;
  const double start = below * root_;
  double k = start;
  auto r = system.rodrigues(state.momentum, k);
  if (start > 0 && (!r || k == start)) {  // of another trajectory: not from below
    k = 0;
    r = system.rodrigues(state.momentum, k);
  }
  if (!r) return {};
  root_ = k;
  const Vector<double, 3> moved = system.modified.cwiseProduct(*r);
  solution.step.arrow = SO3::cayley(Vector<double, 3>(2 * *r));
  solution.momentum_change = (4 / (system.h * (1 + r->squaredNorm()))) * moved.cross(*r);
  StepReport report;
  report.status = r->allFinite() ? SolveStatus::converged : SolveStatus::not_finite;
  return report;
}

State<SO3> MoserVeselov::reference(const State<SO3>& start, Matrix<double, 3, 3>& attitude, double t) const {
  RigidBody body;
  body.inertia = inertia;
  return body.reference(start, attitude, t);
}

MethodTraits MoserVeselov::traits() const {
  return {fmt::format("discrete Moser-Veselov, preprocessed to order {}", order), order, true, true, false, 1};
}

std::vector<Quantity<MoserVeselov>> MoserVeselov::quantities() const {
  using Point = TrajectoryPoint<MoserVeselov>;
  return {{"energy",
           {"H"},
           Promise::conserved,
           false,
           [system = *this](const Point& p, double* out) { *out = system.energy(p.state); }},
          {"spatial momentum A M", {"Jx", "Jy", "Jz"}, Promise::conserved, false, [](const Point& p, double* out) {
             Eigen::Map<Vector<double, 3>>(out).noalias() = p.configuration * p.state.momentum;
           }}};
}

}  // namespace lagroid
