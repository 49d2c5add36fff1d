#pragma once
/// RATTLE for chains of spherical pendula, in O(k) a step:
///
///     v* = v + h/2 a(q, T),    q+ = q + h v*,    tensions T such that |q_i+| = 1,
///     v+ = v* + h/2 a(q+, T+),    tensions T+ such that q_i+.v_i+ = 0.
///
/// The one method of these chains that is symplectic, and keeps the momentum about the vertical exactly.
///
///     const PendulumChain<2> chain({1, 1}, {1, 0.5});
///     PendulumChain<2>::Points start = chain.space().zero_point();
///     start.topRows<3>() << 1, 0, 0, 0, 0, -1;
///     ChainRattle<2> rattle(chain, start, 0.01);  // h
///     const StepReport report = rattle.advance();
///
/// Requires as many points as links (std::invalid_argument). Status: `left_domain` where the step is too large for the
/// rods to keep their lengths, `not_finite`; both leave everything as it was. (Hairer, Lubich, Wanner VII.1.4.)

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/scalars/numbers_of.hpp>
#include <lagroid/solvers/integrators/composed_step.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace lagroid {

inline constexpr DeclaredMethod rattle_method{
    .name = "rattle",
    .other_orders = OtherOrders::composed_steps,
    .implicit = true,
    .source = {"marrero2015", "discrete mechanics with constraints, of which RATTLE is a case"}};

/// RATTLE on (S^2)^k: the discrete Euler-Lagrange equations of the trapezoid Lagrangian h (L(q, (q' - q)/h) + L(q', (q'
/// - q)/h)) / 2 with |q_i| = 1, in O(k) by tensions (Ryckaert, Ciccotti and Berendsen 1977; Andersen 1983; Hairer,
/// Lubich, Wanner VII.1.4). Order 2, symmetric and symplectic; the momentum about the vertical is exact, because
/// tensions act along the rods whatever their size. With v_i = q_i' and d_i = 1/m_i + 1/m_{i-1}:
///
///     l_i v_i* = l_i v_i + h/2 (-[i=1] g e_3 - T_i d_i q_i + T_{i+1} q_{i+1} / m_i + T_{i-1} q_{i-1} / m_{i-1})
///     q_i+ = q_i + h v_i*,   |q_i+| = 1                                     (Newton on the k tensions, tridiagonal)
///     l_i v_i+ = l_i v_i* + the same at q+ with tensions such that q_i+.v_i+ = 0               (linear, tridiagonal)
///
/// A step may be composed of several such, of orders four, six and eight (Composition).
///
/// Over numbers with derivatives S (core/scalars/varied.hpp) those of tensions are what the equations say at the
/// solution, by the implicit function theorem, and nothing of the iteration that led there.
template <int K, class S = double> class ChainRattle {
 public:
  using Points = typename CotangentSpheres<K, S>::Point;
  using V = Vector<S, 3>;
  using Columns = Eigen::Matrix<S, 3, K>;

  /// `start` is (q, w). Throws std::invalid_argument unless it has as many columns as the chain has links.
  ChainRattle(const PendulumChain<K>& chain, const Points& start, double h,
              const Composition& composition = compositions::single)
      : gravity_(varied<S>(chain.gravity)),
        length_(detail::varied_links<S>(chain.length)),
        composition_(composition),
        h_(h),
        q_(start.template topRows<3>()),
        v_(q_),
        next_(q_),
        half_(q_),
        tension_(Vector<S, K>::Zero(chain.links())),
        end_(tension_),
        slope_(tension_),
        off_(tension_),
        pivot_(tension_),
        upper_(tension_),
        inverse_length_(length_.cwiseInverse()),
        system_(chain),
        share_(system_.inverse_mass) {
    if (start.cols() != chain.links())
      throw std::invalid_argument("a chain starts from as many points as it has links");
    for (int i = 1; i < chain.links(); ++i) share_(i) += system_.inverse_mass(i - 1);
    for (int i = 0; i < chain.links(); ++i) v_.col(i) = PendulumChain<K>::link_velocity(start, i);
    tensions_at_rest();
  }

  static MethodTraits traits(const Composition& composition) {
    std::string name(rattle_method.name);
    if (composition.stages() > 1) name += ", " + std::string(composition.name);
    return {std::move(name), composition.order, true, true, false};
  }
  MethodTraits traits() const { return traits(composition_); }
  double time() const { return double(index_) * h_; }
  long index() const { return index_; }
  const Columns& directions() const { return q_; }
  const Columns& velocities() const { return v_; }  ///< q_i'
  /// (q, w).
  Points point() const {
    Points z(6, links());
    for (int i = 0; i < links(); ++i) CotangentSpheres<K, S>::set(z, i, q_.col(i), cross(V(q_.col(i)), V(v_.col(i))));
    return z;
  }

  /// `converged`; `left_domain` where the step is too large for the rods to keep their lengths; `not_finite`. Only the
  /// first advances.
  StepReport advance();

  /// Visits all that the next step goes on from, to its last bit.
  void serialize(NumberArchive& archive) {
    auto q = numbers_of(q_);
    auto v = numbers_of(v_);
    auto end = numbers_of(end_);
    auto slope = numbers_of(slope_);
    archive(q, v, end, slope, index_);
  }

 private:
  using P = ParameterScalar<S>;

  int links() const { return int(length_.size()); }
  /// sum_j (d l_i v_i / d(h T_j / 2)) T_j, that is -T_i d_i q_i + T_{i+1} q_{i+1} / m_i + T_{i-1} q_{i-1} / m_{i-1}.
  V pull(const Columns& q, const Vector<S, K>& t, int i) const {
    const int k = links();
    V out = q.col(i) * (-t(i) * share_(i));
    if (i + 1 < k) out += q.col(i + 1) * (t(i + 1) * system_.inverse_mass(i));
    if (i > 0) out += q.col(i - 1) * (t(i - 1) * system_.inverse_mass(i - 1));
    return out;
  }
  void tensions_at_rest();
  /// Tensions such that q_i . (l_i v_i + h/2 (pull + gravity)) = 0, in system_.x.
  void project_velocities(const Columns& q, const Columns& v, double h);
  /// A step of order two of this size; nothing changes where it does not converge.
  StepReport stage(double h);
  double drift(double h);
  bool correct(double h);
  /// One correction more, at the solution, has the derivatives that the equations there give the tensions.
  bool carry_derivatives(double h) {
    if constexpr (std::is_same_v<S, double>) {
      return true;
    } else {
      return correct(h) && std::isfinite(drift(h));
    }
  }
  static double size(const S& x) { return std::abs(value_of(x)); }
  StepReport close(double h);

  P gravity_;
  Vector<P, K> length_;
  Composition composition_;
  double h_;
  long index_ = 0;
  Columns q_, v_, next_, half_;
  std::tuple<Columns, Columns, Vector<S, K>, Vector<S, K>> start_;  ///< of a step of several stages
  Vector<S, K> tension_;                                            ///< over the step, T
  Vector<S, K> end_;                                                ///< at its end, for the velocities
  Vector<S, K> slope_;          ///< by which tension_ differs from end_ at the start of the step, over h
  Vector<S, K> off_;            ///< (|q_i+|^2 - 1) / 2
  Vector<S, K> pivot_, upper_;  ///< of Newton's correction
  Vector<P, K> inverse_length_;
  ChainTensions<K, S> system_;
  Vector<P, K> share_;  ///< d_i
};

template <int K, class S> void ChainRattle<K, S>::project_velocities(const Columns& q, const Columns& v, double h) {
  const double rate = 2 / h;
  for (int i = 0; i < links(); ++i) system_.x(i) = q.col(i).dot(v.col(i)) * length_(i) * rate;
  system_.x(0) -= q(2, 0) * gravity_;
  system_.solve([&](int i) -> V { return q.col(i); });
}

template <int K, class S> void ChainRattle<K, S>::tensions_at_rest() {
  // Those of the continuous motion, l_i |v_i|^2 in place of 2 l_i q.v / h.
  for (int i = 0; i < links(); ++i) system_.x(i) = v_.col(i).squaredNorm() * length_(i);
  system_.x(0) -= q_(2, 0) * gravity_;
  system_.solve([&](int i) -> V { return q_.col(i); });
  end_ = system_.x;
  slope_.setZero();
}

/// v* and q+ of the tensions in tension_; how far the q_i+ are from unit length, over what round-off in the terms that
/// they are made of would leave, at most.
template <int K, class S> double ChainRattle<K, S>::drift(double h) {
  const int k = links();
  double worst = 0;
  for (int i = 0; i < k; ++i) {
    V change = pull(q_, tension_, i);
    if (i == 0) change(2) -= gravity_;
    const P kick = inverse_length_(i) * (h / 2);
    half_.col(i) = v_.col(i) + change * kick;
    next_.col(i) = q_.col(i) + half_.col(i) * h;
    off_(i) = (next_.col(i).squaredNorm() - 1.0) * 0.5;
    double pulls = size(tension_(i)) * size(share_(i));
    if (i > 0) pulls += size(tension_(i - 1)) * size(system_.inverse_mass(i - 1));
    if (i + 1 < k) pulls += size(tension_(i + 1)) * size(system_.inverse_mass(i));
    const double relative = size(off_(i)) / (1 + std::abs(h) * size(kick) * pulls);
    if (!(relative <= worst)) worst = relative;
  }
  return worst;
}

/// tension_ <- tension_ less Newton's correction. The matrix is not symmetric, but its pivots are positive while no rod
/// turns by a right angle: n_i.q_i / m_i + e_i, n = q+, with
///
///     e_i = ( (n_{i-1} x n_i).(q_{i-1} x q_i) / m_{i-1} + n_i.q_i e_{i-1} ) / (m_{i-1} d_{i-1}),
///
/// which is that of ChainTensions where n = q. False where a pivot is not positive.
template <int K, class S> bool ChainRattle<K, S>::correct(double h) {
  const int k = links();
  const double unit = 2 / (h * h);
  Vector<S, K>& x = system_.x;
  S extra(0.0);
  for (int i = 0; i < k; ++i) {
    const V here = q_.col(i);
    const V ahead = next_.col(i);
    const S along = ahead.dot(here);
    x(i) = off_(i) * length_(i) * unit;
    if (i > 0) {
      const V before = q_.col(i - 1);
      const V ahead_before = next_.col(i - 1);
      const P r = system_.inverse_mass(i - 1);
      const S over = r / pivot_(i - 1);
      extra = (cross(ahead_before, ahead).dot(cross(before, here)) * r + along * extra) * over;
      x(i) += ahead.dot(before) * over * x(i - 1);
    }
    pivot_(i) = along * system_.inverse_mass(i) + extra;
    if (!(value_of(pivot_(i)) > 0)) return false;
    if (i + 1 < k) upper_(i) = -ahead.dot(q_.col(i + 1)) * system_.inverse_mass(i);
  }
  for (int i = k; i-- > 0;) {
    if (i + 1 < k) x(i) -= upper_(i) * x(i + 1);
    x(i) /= pivot_(i);
    tension_(i) += x(i);
  }
  return true;
}

/// Newton's iteration for the tensions that keep |q+| = 1, to round-off, from those that stand in tension_; leaves q+
/// and v*.
template <int K, class S> StepReport ChainRattle<K, S>::close(double h) {
  constexpr int most = 50;
  constexpr double round_off = 2 * std::numeric_limits<double>::epsilon();
  constexpr double close_to_it = 32 * round_off;
  StepReport report;
  double last = std::numeric_limits<double>::infinity();
  for (report.iterations = 0; report.iterations <= most; ++report.iterations) {
    report.residual = drift(h);
    if (!std::isfinite(report.residual)) {
      report.status = SolveStatus::not_finite;
      return report;
    }
    const bool falls = report.residual < 0.5 * last;
    if (report.residual <= round_off || (report.residual <= close_to_it && !falls)) {
      report.status = carry_derivatives(h) ? SolveStatus::converged : SolveStatus::left_domain;
      return report;
    }
    last = report.residual;
    if (!correct(h)) {
      report.status = SolveStatus::left_domain;
      return report;
    }
  }
  report.status = SolveStatus::not_converged;
  return report;
}

template <int K, class S> StepReport ChainRattle<K, S>::stage(double h) {
  for (int i = 0; i < links(); ++i) tension_(i) = end_(i) + h * slope_(i);
  StepReport report = close(h);
  if (!report.converged()) return report;
  project_velocities(next_, half_, h);
  const double kick = h / 2;
  bool finite = true;
  for (int i = 0; i < links(); ++i) {
    V change = pull(next_, system_.x, i);
    if (i == 0) change(2) -= gravity_;
    half_.col(i) += change * (inverse_length_(i) * kick);
    finite = finite && std::isfinite(value_of(half_.col(i).sum()));
  }
  if (!finite) {
    report.status = SolveStatus::not_finite;
    return report;
  }
  for (int i = 0; i < links(); ++i) {
    slope_(i) = (tension_(i) - end_(i)) * (1 / h);
    end_(i) = system_.x(i);
  }
  std::swap(q_, next_);
  std::swap(v_, half_);
  return report;
}

template <int K, class S> StepReport ChainRattle<K, S>::advance() {
  if (composition_.stages() == 1) {
    const StepReport report = stage(h_);
    if (report.converged()) ++index_;
    return report;
  }
  start_ = {q_, v_, end_, slope_};
  const StepReport report = step_by_stages(
      composition_.coefficients, [&](double weight) { return stage(weight * h_); },
      [&] { std::tie(q_, v_, end_, slope_) = start_; });
  if (report.converged()) ++index_;
  return report;
}

}  // namespace lagroid
