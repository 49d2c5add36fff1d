#pragma once
/// Chains of k spherical pendula on (TS^2)^k and (T*S^2)^k,
///
///     L = 1/2 sum_ij M_ij q_i'.q_j' - g sum_i mu_i l_i e_3.q_i,    M_ij = mu_max(i,j) l_i l_j,    |q_i| = 1,
///
/// as vector fields whose evaluation costs O(k), by the tensions of the rods.
///
///     const PendulumChain<2> chain({1, 1}, {1, 0.5});
///     PendulumChain<2>::Points start = chain.space().zero_point();
///     start.topRows<3>() << 1, 0, 0, 0, 0, -1;  // q_1 = e_1, q_2 = -e_3, at rest
///
/// Masses and lengths must be as many, and in the range of `chain_number` (std::invalid_argument). [H] (mapfham)

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace lagroid {

/// What masses and lengths of a chain must be: neither products of them nor inverses overflow.
inline constexpr NumberRule chain_number{"positive, from 1e-300 to 1e300",
                                         [](double x) { return x >= 1e-300 && x <= 1e300; }};

namespace detail {

/// One number for each link, as formulas over S read it.
template <class S, int K> Vector<lagroid::ParameterScalar<S>, K> varied_links(const Vector<double, K>& members) {
  Vector<lagroid::ParameterScalar<S>, K> out;
  out.resize(members.size());
  for (Eigen::Index i = 0; i < members.size(); ++i) out(i) = varied<S>(members.data()[i]);
  return out;
}
/// mu_i = m_i + ... + m_k.
template <class P, int K> Vector<P, K> carried_masses(Vector<P, K> mass) {
  for (Eigen::Index i = mass.size() - 1; i-- > 0;) mass(i) += mass(i + 1);
  return mass;
}

}  // namespace detail

/// k masses on k rods, the first from the origin: x_i = l_1 q_1 + ... + l_i q_i, q_i in S^2, in gravity -g e_3. K is k,
/// or Eigen::Dynamic.
///
///     L = 1/2 sum_ij M_ij q_i'.q_j' - U,   M_ij = mu_max(i,j) l_i l_j,   mu_i = m_i + ... + m_k,
///     U = g sum_i mu_i l_i e_3.q_i
///
/// States are 6 x k: (q_i, w_i) with q_i' = w_i x q_i in (TS^2)^k, or (q_i, p_i) with p_i = (I - q_i q_i^T) sum_j M_ij
/// q_j' in (T*S^2)^k. What is a function of states is written for any scalar, and varies with the parameters.
template <int K> struct PendulumChain {
  using Numbers = Vector<double, K>;
  template <class S> using PointsOver = typename CotangentSpheres<K, S>::Point;
  using Points = PointsOver<double>;

  Numbers mass;     ///< m_i, kg
  Numbers length;   ///< l_i, m
  double gravity;   ///< g, m/s^2
  Numbers carried;  ///< mu_i, kg

  static auto parameters() {
    return std::tuple(required(parameter("masses", &PendulumChain::mass, "kg",
                                         "of the bobs, from the top: one each, or one for all", chain_number)),
                      required(parameter("lengths", &PendulumChain::length, "m",
                                         "of the rods: one each, or one for all", chain_number)),
                      parameter("gravity", &PendulumChain::gravity, "m/s^2", "acceleration"));
  }

  /// Throws std::invalid_argument unless masses and lengths are as many and in the range of `chain_number`, and g is
  /// finite.
  PendulumChain(Numbers masses, Numbers lengths, double g = 9.81)
      : mass(std::move(masses)), length(std::move(lengths)), gravity(g), carried(detail::carried_masses(mass)) {
    if (mass.size() != length.size() || mass.size() == 0)
      throw std::invalid_argument("a chain has as many masses as lengths, one or more");
    for (Eigen::Index i = 0; i < mass.size(); ++i)
      if (!chain_number.holds(mass(i)) || !chain_number.holds(length(i)))
        throw std::invalid_argument("masses and lengths of a chain are " + std::string(chain_number.words) +
                                    "; those of link " + std::to_string(i + 1) + " are not");
    if (!std::isfinite(g)) throw std::invalid_argument("the gravity of a chain is not finite");
  }

  int links() const { return int(mass.size()); }
  CotangentSpheres<K> space() const { return {links()}; }

  /// Of (q, w).
  template <class S> S kinetic_energy(const Eigen::Matrix<S, 6, K>& z) const {
    S sum(0.0);
    Vector<S, 3> velocity = Vector<S, 3>::Zero();
    for (int i = 0; i < links(); ++i) {
      velocity += link_velocity(z, i) * varied<S>(length(i));
      sum += velocity.squaredNorm() * (varied<S>(mass(i)) * 0.5);
    }
    return sum;
  }
  template <class S> S potential_energy(const Eigen::Matrix<S, 6, K>& z) const {
    const auto& mu = carried_over<S>();
    S sum(0.0);
    for (int i = 0; i < links(); ++i) sum += z(2, i) * (varied<S>(gravity) * mu(i) * varied<S>(length(i)));
    return sum;
  }
  template <class S> S energy(const Eigen::Matrix<S, 6, K>& z) const { return kinetic_energy(z) + potential_energy(z); }
  /// J_z = e_3 . sum_i m_i x_i x x_i', of (q, w).
  template <class S> S vertical_momentum(const Eigen::Matrix<S, 6, K>& z) const {
    using V = Vector<S, 3>;
    V place = V::Zero();
    V velocity = V::Zero();
    S sum(0.0);
    for (int i = 0; i < links(); ++i) {
      place += V(z.col(i).template head<3>()) * varied<S>(length(i));
      velocity += link_velocity(z, i) * varied<S>(length(i));
      sum += (place(0) * velocity(1) - place(1) * velocity(0)) * varied<S>(mass(i));
    }
    return sum;
  }
  /// sum_i |x_i| (m_i |x_i'| + mu_i (|g| l_i)^(1/2)), the size of its terms and of what tensions exchange between them
  /// over a step that resolves the swing.
  double momentum_size(const Points& z) const {
    using V = Vector<double, 3>;
    V place = V::Zero();
    V velocity = V::Zero();
    double sum = 0;
    for (int i = 0; i < links(); ++i) {
      place += length(i) * V(z.col(i).template head<3>());
      velocity += length(i) * link_velocity(z, i);
      sum += place.stableNorm() *
             (mass(i) * velocity.stableNorm() + carried(i) * std::sqrt(std::abs(gravity) * length(i)));
    }
    return sum;
  }
  /// (q, w) -> (q, p), the Legendre transform.
  template <class S> PointsOver<S> to_momenta_over(const Eigen::Matrix<S, 6, K>& z) const {
    using V = Vector<S, 3>;
    PointsOver<S> out = z;
    V velocity = V::Zero();
    PointsOver<S> momentum = z;  // of the masses, below
    for (int i = 0; i < links(); ++i) {
      velocity += link_velocity(z, i) * varied<S>(length(i));
      momentum.col(i).template tail<3>() = velocity * varied<S>(mass(i));
    }
    V below = V::Zero();
    for (int i = links(); i-- > 0;) {
      below += momentum.col(i).template tail<3>();
      const V q = z.col(i).template head<3>();
      out.col(i).template tail<3>() = (below - q * q.dot(below)) * varied<S>(length(i));
    }
    return out;
  }
  Points to_momenta(const Points& z) const { return to_momenta_over<double>(z); }
  /// (q, p) -> (q, w).
  template <class S> PointsOver<S> to_velocities_over(const Eigen::Matrix<S, 6, K>& z) const;
  Points to_velocities(const Points& z) const { return to_velocities_over<double>(z); }

  template <class S> static Vector<S, 3> link_velocity(const Eigen::Matrix<S, 6, K>& z, int i) {
    return cross(Vector<S, 3>(z.col(i).template tail<3>()), Vector<S, 3>(z.col(i).template head<3>()));
  }

 private:
  /// mu_i.
  template <class S> decltype(auto) carried_over() const {
    if constexpr (std::is_same_v<ParameterScalar<S>, double>) {
      return (carried);
    } else {
      return detail::carried_masses(detail::varied_links<S>(mass));
    }
  }
};

/// The symmetric positive definite tridiagonal equations of the tensions of rods in the directions q_i,
///
///     x_i (1/m_i + 1/m_{i-1}) - x_{i+1} q_i.q_{i+1} / m_i - x_{i-1} q_i.q_{i-1} / m_{i-1} = b_i,      1/m_0 = 0,
///
/// by elimination from both ends to the middle, so that two short recurrences go on side by side in place of a long
/// one. From above the pivots are 1/m_i + e_i, from below 1/m_{i-1} + f_i, and e_i + f_i in the middle, with
///
///     e_i = ( |q_{i-1} x q_i|^2 / m_{i-1} + e_{i-1} ) / (m_{i-1} (1/m_{i-1} + e_{i-1})),      e_1 = 0,
///     f_i = ( |q_{i+1} x q_i|^2 / m_i + f_{i+1} ) / (m_i (1/m_i + f_{i+1})),                  f_k = 1/m_k:
///
/// sums of what is positive, where 1/m_i + 1/m_{i-1} - (q_i.q_{i-1} / m_{i-1})^2 / d_{i-1} would cancel beside a light
/// bob on rods that are nearly in line.
template <int K, class S> struct ChainTensions {
  Vector<ParameterScalar<S>, K> mass, inverse_mass;
  Vector<S, K> x;

  explicit ChainTensions(const PendulumChain<K>& chain)
      : mass(detail::varied_links<S>(chain.mass)),
        inverse_mass(mass.cwiseInverse()),
        x(Vector<S, K>::Zero(chain.links())),
        factor_(Vector<S, K>::Zero(chain.links())) {}

  /// x <- A^{-1} x, q(i) being unit vectors.
  template <class Q> LAGROID_INLINE void solve(const Q& q) {
    using V = Vector<S, 3>;
    const int n = int(x.size());
    const int middle = n / 2;
    // e_i and f_i as fractions over / under: the recurrences then have no quotient to wait for.
    End above{S(0.0), S(1.0), x(0)};
    End below{S(inverse_mass(n - 1)), S(1.0), x(n - 1)};
    // Eliminates x_from from the equation of its neighbour, over the bob between them.
    const auto eliminate = [&](int from, int to, int bob, End& end) {
      const V a = q(from);
      const V b = q(to);
      const S under = end.over * mass(bob) + end.under;
      const S inverse = end.under / under;  // of the pivot, over the bob's mass
      const S factor = a.dot(b) * inverse;
      x(from) = end.x * inverse * mass(bob);
      factor_(from) = factor;
      end.x = x(to) + factor * end.x;
      end.over += cross(a, b).squaredNorm() * end.under * inverse_mass(bob);
      end.under = under;
    };
    for (int i = 0; i < middle; ++i) {
      eliminate(i, i + 1, i, above);
      const int from = n - 1 - i;
      if (from > middle) eliminate(from, from - 1, from - 1, below);
      if (i % links_between_reductions == links_between_reductions - 1) {
        above.reduce();
        below.reduce();
      }
    }
    // Both ends have come to the middle with its own right hand side, which counts once.
    S up = (above.x + below.x - x(middle)) / (above.over / above.under + below.over / below.under);
    S down = up;
    x(middle) = up;
    for (int i = 1; i <= middle; ++i) {
      up = x(middle - i) + factor_(middle - i) * up;
      x(middle - i) = up;
      if (middle + i < n) {
        down = x(middle + i) + factor_(middle + i) * down;
        x(middle + i) = down;
      }
    }
  }

 private:
  /// What was eliminated from one end: e or f as a fraction, and the right hand side.
  struct End {
    S over, under, x;
    void reduce() {
      over /= under;
      under = S(1.0);
    }
  };
  /// Over each link numerators and denominators grow, by up to the ratio of neighbouring masses.
  static constexpr int links_between_reductions = 4;

  Vector<S, K> factor_;  ///< by which the neighbour nearer to the middle comes in
};

/// The motion of (q, w) by SO(3)^k x R^3^k, in O(k): the tensions T_i of the rods solve their equations (ChainTensions)
/// with b_i = l_i |w_i|^2 - [i = 1] g e_3.q_1, and
///
///     w_i' = q_i x (T_{i+1} q_{i+1} / m_i + T_{i-1} q_{i-1} / m_{i-1} - [i = 1] g e_3) / l_i,
///     F(q, w) = (w, w').
///
/// q_i.w_i is constant.
template <int K, class S = double> class ChainRotationField {
 public:
  using Space = SpheresAndVectors<K, S>;
  using Z = typename Space::Point;

  explicit ChainRotationField(const PendulumChain<K>& chain)
      : gravity_(varied<S>(chain.gravity)), length_(detail::varied_links<S>(chain.length)), tension_(chain) {
    above_ = below_ = length_.cwiseInverse();
    for (int i = 0; i < chain.links(); ++i) {
      below_(i) *= tension_.inverse_mass(i);
      above_(i) *= i > 0 ? tension_.inverse_mass(i - 1) : P(0);
    }
  }

  void operator()(const S&, const Z& z, Z& f) {
    using V = Vector<S, 3>;
    const int k = int(length_.size());
    for (int i = 0; i < k; ++i) tension_.x(i) = Space::second(z, i).squaredNorm() * length_(i);
    tension_.x(0) -= z(2, 0) * gravity_;
    tension_.solve([&](int i) { return Space::first(z, i); });
    for (int i = 0; i < k; ++i) {
      V pull = V::Zero();
      if (i == 0) pull(2) -= gravity_ / length_(0);
      if (i > 0) pull += Space::first(z, i - 1) * (tension_.x(i - 1) * above_(i));
      if (i + 1 < k) pull += Space::first(z, i + 1) * (tension_.x(i + 1) * below_(i));
      Space::set(f, i, Space::second(z, i), cross(Space::first(z, i), pull));
    }
  }

 private:
  using P = ParameterScalar<S>;
  P gravity_;
  Vector<P, K> length_;
  Vector<P, K> above_, below_;  ///< 1/(l_i m_{i-1}) and 1/(l_i m_i)
  ChainTensions<K, S> tension_;
};

/// The same motion on (TS^2)^k as a map to se(3)^k,
///
///     F(q, w) = (w, q x w').
template <int K, class S = double> class ChainVelocityField {
 public:
  using Space = CotangentSpheres<K, S>;
  using Z = typename Space::Point;

  explicit ChainVelocityField(const PendulumChain<K>& chain) : rotations_(chain) {}

  void operator()(const S& t, const Z& z, Z& f) {
    rotations_(t, z, f);
    for (int i = 0; i < z.cols(); ++i)
      Space::set(f, i, Space::first(f, i), cross(Space::first(z, i), Space::second(f, i)));
  }

 private:
  ChainRotationField<K, S> rotations_;
};

/// The motion on (T*S^2)^k as a map to se(3)^k, in O(k): with the equations of the tensions (ChainTensions) and b_i =
/// q_i.p_{i+1} / (l_{i+1} m_i) + q_i.p_{i-1} / (l_{i-1} m_{i-1}), multipliers tau_i such that c_i = p_i / l_i + tau_i
/// q_i are the momenta of the masses from i on; x_i' = (c_i - c_{i+1}) / m_i, v_i = (x_i' - x_{i-1}') / l_i = q_i',
///
///     F(q, p)_i = (q_i x v_i, -g mu_i l_i q_i x e_3 - l_i tau_i q_i x v_i),
///
/// which is F[H] of [H] (mapfham) up to what leaves (q_i, p_i) fixed.
template <int K, class S = double> class ChainMomentumField {
 public:
  using Space = CotangentSpheres<K, S>;
  using Z = typename Space::Point;
  using V = Vector<S, 3>;

  explicit ChainMomentumField(const PendulumChain<K>& chain)
      : gravity_(varied<S>(chain.gravity)),
        length_(detail::varied_links<S>(chain.length)),
        carried_mass_(detail::carried_masses(detail::varied_links<S>(chain.mass))),
        multiplier_(chain) {}

  void operator()(double, const Z& z, Z& f) {
    solve(z);
    const int k = int(length_.size());
    V momentum = carried(z, 0);
    V above = V::Zero();  // x_{i-1}'
    for (int i = 0; i < k; ++i) {
      const V next = i + 1 < k ? carried(z, i + 1) : V(V::Zero());
      const V velocity = (momentum - next) * multiplier_.inverse_mass(i);
      const V q = Space::first(z, i);
      const V xi = cross(q, V((velocity - above) * (1.0 / length_(i))));
      const P weight = gravity_ * carried_mass_(i) * length_(i);
      V eta = xi * (multiplier_.x(i) * -length_(i));
      eta(0) -= q(1) * weight;
      eta(1) += q(0) * weight;
      Space::set(f, i, xi, eta);
      momentum = next;
      above = velocity;
    }
  }

 private:
  using P = ParameterScalar<S>;
  void solve(const Z& z) {
    const int k = int(length_.size());
    const auto& inverse_mass = multiplier_.inverse_mass;
    for (int i = 0; i < k; ++i) {
      const V q = Space::first(z, i);
      S right(0.0);
      if (i + 1 < k) right += q.dot(Space::second(z, i + 1)) * (inverse_mass(i) / length_(i + 1));
      if (i > 0) right += q.dot(Space::second(z, i - 1)) * (inverse_mass(i - 1) / length_(i - 1));
      multiplier_.x(i) = right;
    }
    multiplier_.solve([&](int i) { return Space::first(z, i); });
  }
  /// c_i.
  V carried(const Z& z, int i) const {
    return Space::second(z, i) * (1.0 / length_(i)) + Space::first(z, i) * multiplier_.x(i);
  }

  P gravity_;
  Vector<P, K> length_, carried_mass_;
  ChainTensions<K, S> multiplier_;
};

template <int K>
template <class S>
auto PendulumChain<K>::to_velocities_over(const Eigen::Matrix<S, 6, K>& z) const -> PointsOver<S> {
  PointsOver<S> u = z;
  ChainMomentumField<K, S> (*this)(0, z, u);
  PointsOver<S> out = z;
  out.template bottomRows<3>() = u.template topRows<3>();
  return out;
}

}  // namespace lagroid
