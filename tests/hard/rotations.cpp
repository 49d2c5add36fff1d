// Rotations and rigid motions: angles that are tiny, near pi and near 2 pi, in three precisions; long products.
#include "support/hard_case.hpp"

#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lagroid::hard {
namespace {

using Long = long double;
template <class T> using V3 = Vector<T, 3>;
template <class T> using M3 = Matrix<T, 3, 3>;

template <class T> V3<T> axis() { return V3<T>(T(2), T(-1), T(2)) / T(3); }

/// sin(angle) hat(u) = (g - g^T) / 2 and tr g = 1 + 2 cos(angle), solved for both.
template <class T> V3<T> textbook_log(const M3<T>& g) {
  const T angle = std::acos((g.trace() - 1) / 2);
  return V3<T>(g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1)) * (angle / (2 * std::sin(angle)));
}
/// I + sin(angle) hat(u) + (1 - cos(angle)) hat(u)^2, u = w / |w|.
template <class T> M3<T> textbook_exp(const V3<T>& w) {
  const T angle = w.norm();
  const M3<T> u = SO3::hat(V3<T>(w / angle));
  return M3<T>::Identity() + std::sin(angle) * u + (1 - std::cos(angle)) * (u * u);
}
/// The rotation by an angle about the axis, to the last bit of T.
template <class T> M3<T> rotation(Long angle) { return SO3::exp(V3<Long>(angle * axis<Long>())).template cast<T>(); }

/// The largest |f(a) / exact(a) - 1| over the angles.
template <class F, class G> double relative(std::initializer_list<double> angles, const F& f, const G& exact) {
  double worst = 0;
  for (const double a : angles) worst = worse(worst, std::abs(f(a) / exact(a) - 1));
  return worst;
}

/// |log(exp(a u)) - a u| / a, the largest.
template <class T, class Exp, class Log>
double round_trip(std::initializer_list<double> angles, const Exp& exp, const Log& log) {
  double worst = 0;
  for (const double a : angles) {
    const V3<T> w = T(a) * axis<T>();
    const V3<T> back = log(M3<T>(exp(w)));
    worst = worse(worst, double((back - w).cwiseAbs().maxCoeff() / T(a)));
  }
  return worst;
}

template <class T> double near_pi(V3<T> (*log)(const M3<T>&), std::initializer_list<double> gaps) {
  double worst = 0;
  for (const double gap : gaps) {
    const Long angle = std::numbers::pi_v<Long> - Long(gap);
    const V3<T> found = log(rotation<T>(angle));
    worst = worse(worst, double((found.template cast<Long>() - angle * axis<Long>()).norm()));
  }
  return worst;
}

/// Half turns about general and special axes: the angle, and the axis up to its sign.
double half_turns(V3<double> (*log)(const M3<double>&)) {
  double worst = 0;
  for (const V3<double>& u : {V3<double>(0.6, 0, 0.8), V3<double>(1, 0, 0), V3<double>(0, 0, 1),
                              V3<double>(V3<double>(1, 1e-9, 0).normalized()), axis<double>()}) {
    const V3<double> w = log(2 * u * u.transpose() - M3<double>::Identity());
    worst = worse(worst, std::abs(w.norm() - std::numbers::pi));
    worst = worse(worst, w.cross(u).norm());
  }
  return worst;
}

/// (w, p) of a motion of the plane, p = V(w) v, with V^{-1} = w / (2 (1 - cos w)) [sin w, 1 - cos w; cos w - 1, sin w].
V3<double> textbook_plane(const V3<double>& xi) {
  const double w = xi(0);
  const double s = std::sin(w);
  const double c = 1 - std::cos(w);
  const Vector<double, 2> p((s * xi(1) - c * xi(2)) / w, (c * xi(1) + s * xi(2)) / w);
  const double f = w / (2 * c);
  return {w, f * (s * p(0) + c * p(1)), f * (-c * p(0) + s * p(1))};
}
/// The same in space: p = (I + (1 - cos a) / a^2 hat(w) + (a - sin a) / a^3 hat(w)^2) v and its inverse.
Vector<double, 6> textbook_space(const Vector<double, 6>& xi) {
  const V3<double> w = xi.head<3>();
  const double a = w.norm();
  const M3<double> x = SO3::hat(w);
  const M3<double> one = M3<double>::Identity();
  const V3<double> p = (one + (1 - std::cos(a)) / (a * a) * x + (a - std::sin(a)) / (a * a * a) * x * x) * xi.tail<3>();
  const double d = (1 - a * std::sin(a) / (2 * (1 - std::cos(a)))) / (a * a);
  Vector<double, 6> out;
  out << w, (one - 0.5 * x + d * x * x) * p;
  return out;
}

/// dexp^{-1} of SE(2) where turns are tiny and shifts are long, against long double.
double inverse_differential_at_zero(const std::function<double(double)>& coefficient) {
  double worst = 0;
  for (const double w : {1e-8, 1e-6, 1e-4}) {
    const V3<double> xi(w, 3 / w, -2 / w);
    const M3<Long> exact = SE2::dexp_inverse(V3<Long>(xi.cast<Long>()));
    const M3<double> ad = SE2::ad(xi);
    const M3<double> found =
        coefficient ? M3<double>(M3<double>::Identity() + 0.5 * ad + coefficient(w) * ad * ad) : SE2::dexp_inverse(xi);
    worst = worse(worst, double((found.cast<Long>() - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff()));
  }
  return worst;
}
/// dexp^{-1} of SO(3) against long double, relative to its size.
double inverse_differential(std::initializer_list<double> angles,
                            const std::function<M3<double>(const V3<double>&)>& found) {
  double worst = 0;
  for (const double a : angles) {
    const V3<double> w = a * axis<double>();
    const M3<Long> exact = SO3::dexp_inverse(V3<Long>(w.cast<Long>()));
    worst = worse(worst, double((found(w).cast<Long>() - exact).norm() / exact.norm()));
  }
  return worst;
}
M3<double> by_ad(const V3<double>& w, double d) {
  const M3<double> x = SO3::hat(w);
  return M3<double>::Identity() + 0.5 * x + d * x * x;
}
/// sum_k B_k^+ ad^k / k!, to ad^20.
M3<double> bernoulli_series(const V3<double>& w) {
  constexpr std::array even{1.0 / 6,       -1.0 / 30, 1.0 / 42,      -1.0 / 30,     5.0 / 66,
                            -691.0 / 2730, 7.0 / 6,   -3617.0 / 510, 43867.0 / 798, -174611.0 / 330};
  const M3<double> x = SO3::hat(w);
  M3<double> sum = M3<double>::Identity() + 0.5 * x;
  M3<double> power = M3<double>::Identity();
  double factorial = 1;
  for (int k = 1; k <= int(even.size()); ++k) {
    power = (power * x * x).eval();
    factorial *= (2 * k - 1) * (2 * k);
    sum += even[std::size_t(k - 1)] / factorial * power;
  }
  return sum;
}

/// log(exp) of all angles from tiny to near pi, in units of the scalar's round-off; at the largest angles relative to
/// exact rotation matrices.
template <class T> double in_units_of_round_off(bool ours) {
  const T eps = std::numeric_limits<T>::epsilon();
  const double tiny = std::max(1e-3 * double(std::sqrt(std::numeric_limits<T>::min())), 1e-300);
  const auto log = [ours](const M3<T>& g) { return ours ? SO3::log(g) : textbook_log<T>(g); };
  const auto exp = [ours](const V3<T>& w) { return ours ? SO3::exp(w) : textbook_exp<T>(w); };
  double worst = round_trip<T>({tiny, 1e-12, 1e-8, 1e-4, 0.01, 0.3, 1, 2, 2.9}, exp, log);
  if (ours) {
    using M4 = Matrix<T, 4, 4>;
    for (const double a : {1e-8, 1e-3, 0.5, 2.5}) {
      Vector<T, 6> xi;
      xi << T(a) * axis<T>(), T(1), T(-2), T(3);
      worst = worse(worst, double((SE3::log(M4(SE3::exp(xi))) - xi).norm()));
      const V3<T> plane(T(a), T(1), T(2));
      worst = worse(worst, double((SE2::log(M3<T>(SE2::exp(plane))) - plane).norm()));
      const V3<T> w = T(a) * axis<T>();
      worst = worse(worst, double((SO3::dexp(w) * SO3::dexp_inverse(w) - M3<T>::Identity()).norm()));
      worst = worse(worst, double((SO3::cayley_inverse(M3<T>(SO3::cayley(w))) - w).norm() / T(a)));
    }
  }
  return worst / double(eps);
}

/// |g^T g - I| of a product of a million equal rotations.
double defect_of_product(bool project) {
  const M3<double> step = SO3::exp(V3<double>(0.3, -0.7, 0.2));
  M3<double> product = M3<double>::Identity();
  for (int k = 0; k < 1'000'000; ++k) {
    product = SO3::multiply(product, step);
    if (project) product = SO3::project(product);
  }
  return (product.transpose() * product - M3<double>::Identity()).cwiseAbs().maxCoeff();
}

V3<double> our_log(const M3<double>& g) { return SO3::log(g); }

}  // namespace

std::vector<HardCase> rotations() {
  return {
      {"VersineAtTinyAngles", "a = 1e-8, 1e-6, 1e-4", "relative error of (1 - cos a) / a^2", "the formula as it stands",
       1e-15,
       [] {
         return relative(
             {1e-8, 1e-6, 1e-4}, [](double a) { return stumpff<2>(a * a); }, [](double a) { return 0.5 - a * a / 24; });
       },
       [] {
         return relative(
             {1e-8, 1e-6, 1e-4}, [](double a) { return (1 - std::cos(a)) / (a * a); },
             [](double a) { return 0.5 - a * a / 24; });
       }},
      {"SineDefectAtTinyAngles", "a = 1e-8, 1e-6, 1e-4", "relative error of (a - sin a) / a^3",
       "the formula as it stands", 1e-15,
       [] {
         return relative(
             {1e-8, 1e-6, 1e-4}, [](double a) { return stumpff<3>(a * a); },
             [](double a) { return 1.0 / 6 - a * a / 120; });
       },
       [] {
         return relative(
             {1e-8, 1e-6, 1e-4}, [](double a) { return (a - std::sin(a)) / (a * a * a); },
             [](double a) { return 1.0 / 6 - a * a / 120; });
       }},
      {"LogOfExpAtTinyAngles", "angles 1e-12, 1e-8", "relative error of log(exp w) on SO(3)",
       "acos of the trace over twice its sine", 1e-14,
       [] {
         return round_trip<double>(
             {1e-12, 1e-8}, [](const V3<double>& w) { return SO3::exp(w); }, our_log);
       },
       [] {
         return round_trip<double>(
             {1e-12, 1e-8}, [](const V3<double>& w) { return SO3::exp(w); }, textbook_log<double>);
       }},
      {"ExpWhereSquaresUnderflow", "angles 1e-160, 1e-200", "relative error of log(exp w) on SO(3)",
       "exp by the unit axis w / |w|", 1e-14,
       [] {
         return round_trip<double>(
             {1e-160, 1e-200}, [](const V3<double>& w) { return SO3::exp(w); }, our_log);
       },
       [] {
         return round_trip<double>({1e-160, 1e-200}, textbook_exp<double>, our_log);
       }},
      {"LogNearPi", "angles pi - 1e-9, pi - 1e-13", "error of the rotation vector, rad",
       "acos of the trace over twice its sine", 2e-15,
       [] {
         return near_pi<double>(our_log, {1e-9, 1e-13});
       },
       [] {
         return near_pi<double>(textbook_log<double>, {1e-9, 1e-13});
       }},
      {"LogAtPi", "angle pi, general and special axes", "error of the rotation vector up to its sign, rad",
       "acos of the trace over twice its sine", 4e-15, [] { return half_turns(our_log); },
       [] { return half_turns(textbook_log<double>); }},
      {"PlaneMotionsAtTinyTurns", "SE(2), turns 1e-8 and 1e-12 with a shift", "error of log(exp xi)",
       "division by w and by 1 - cos w", 1e-15,
       [] {
         double worst = 0;
         for (const double w : {1e-8, 1e-12}) {
           const V3<double> xi(w, 1, 2);
           worst = worse(worst, (SE2::log(M3<double>(SE2::exp(xi))) - xi).norm());
         }
         return worst;
       },
       [] {
         const V3<double> xi(1e-8, 1, 2);
         return (textbook_plane(xi) - xi).norm();
       }},
      {"SpaceMotionsAtTinyTurns", "SE(3), turns 1e-8 and 1e-12 with a shift", "error of log(exp xi)",
       "division by a^2, a^3 and 1 - cos a", 2e-15,
       [] {
         double worst = 0;
         for (const double a : {1e-8, 1e-12}) {
           Vector<double, 6> xi;
           xi << a * axis<double>(), 1, -2, 3;
           worst = worse(worst, (SE3::log(Matrix<double, 4, 4>(SE3::exp(xi))) - xi).norm());
         }
         return worst;
       },
       [] {
         Vector<double, 6> xi;
         xi << 1e-8 * axis<double>(), 1, -2, 3;
         return (textbook_space(xi) - xi).norm();
       }},
      {"InverseDifferentialNearZero", "SE(2), turns 1e-8 to 1e-4 with shifts 3 / w",
       "relative error of the inverse differential of exp", "(1 - (a/2) cot(a/2)) / a^2 as it stands", 1e-14,
       [] { return inverse_differential_at_zero({}); },
       [] { return inverse_differential_at_zero([](double a) { return (1 - a / 2 / std::tan(a / 2)) / (a * a); }); }},
      {"InverseDifferentialNearPi", "SO(3), angles pi - 1e-9 and pi - 1e-13",
       "relative error of the inverse differential of exp", "1 / a^2 - (1 + cos a) / (2 a sin a)", 2e-15,
       [] {
         return inverse_differential({std::numbers::pi - 1e-9, std::numbers::pi - 1e-13},
                                     [](const V3<double>& w) { return SO3::dexp_inverse(w); });
       },
       [] {
         return inverse_differential({std::numbers::pi - 1e-9, std::numbers::pi - 1e-13}, [](const V3<double>& w) {
           const double a = w.norm();
           return by_ad(w, 1 / (a * a) - (1 + std::cos(a)) / (2 * a * std::sin(a)));
         });
       }},
      {"DifferentialsNearTwoPi", "SO(3), angle 2 pi - 1e-3, where exp folds",
       "relative error of the inverse differential of exp; its size is 1e3", "its Bernoulli series to order 20", 1e-11,
       [] {
         return inverse_differential({2 * std::numbers::pi - 1e-3},
                                     [](const V3<double>& w) { return SO3::dexp_inverse(w); });
       },
       [] { return inverse_differential({2 * std::numbers::pi - 1e-3}, bernoulli_series); }},
      {"SinglePrecision", "float: SO(3), SE(2), SE(3), angles from 1e-22 to 2.9",
       "errors of exp, log, Cayley and differentials, in units of epsilon", "unit axis, acos and sine in float", 64,
       [] { return in_units_of_round_off<float>(true); }, [] { return in_units_of_round_off<float>(false); }},
      {"ExtendedPrecision", "long double: the same, from 1e-300",
       "errors of exp, log, Cayley and differentials, in units of epsilon", "unit axis, acos and sine in long double",
       64, [] { return in_units_of_round_off<Long>(true); }, [] { return in_units_of_round_off<Long>(false); }},
      {"ProductOfAMillionRotations", "1e6 equal factors", "largest entry of g^T g - I", "products without project",
       4e-15, [] { return defect_of_product(true); }, [] { return defect_of_product(false); }},
  };
}

}  // namespace lagroid::hard
