#pragma once
/// The coefficients of explicit Lie group integrators, for z' = F(t, z)_M(z) on a homogeneous space M:
///
///     Z_i = exp(h sum_j w_rj K_j) ... exp(h sum_j w_1j K_j) z_n,    K_j = F(t + c_j h, Z_j)      (commutator-free)
///     z_{n+1} = exp(u) z_n,    u' = dexp_u^{-1} F(t, exp(u) z_n)                                  (Munthe-Kaas)
///
/// Such methods stay on M, as spheres of unit vectors, whatever the step, without a projection.
///
///     const LieGroupMethod* method = lie_group_methods::named("munthe-kaas-54");  // null for an unknown name
///     const int order = lie_group_methods::commutator_free_4.order;
///
/// Sources stand with each method.

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace lagroid {

/// What such a method goes by.
enum class LieGroupScheme {
  commutator_free,  ///< products of exponentials of combinations of slopes
  munthe_kaas,      ///< a Runge-Kutta method for u in z = exp(u) z_n
  classical,        ///< a Runge-Kutta method in the coordinates of M, which leaves M: to compare with
};

/// An explicit method for z' = F(t, z)_M(z) on a homogeneous space. Slopes are K_j = F(t + c_j h, Z_j).
struct LieGroupMethod {
  static constexpr int most_stages = 7;
  static constexpr int most_factors = 3;
  using Row = std::array<double, most_stages>;

  /// Z = exp(h sum_j w_rj K_j) ... exp(h sum_j w_1j K_j) Z_from: the first factor acts first.
  struct Product {
    int from = 0;  ///< the stage that it goes on from; 0 is z_n
    int factors = 0;
    std::array<Row, most_factors> weights{};
  };

  std::string_view name;
  int order = 0;
  LieGroupScheme scheme = LieGroupScheme::commutator_free;
  int stages = 1;
  std::array<Product, most_stages + 1> products{};  ///< of commutator-free methods: the stages, then z_{n+1}
  std::array<Row, most_stages> a{};                 ///< of the others: Runge and Kutta's matrix
  Row b{};
  Row error{};               ///< b less the weights of an embedded method of order - 1; zero where there is none
  bool reuses_last = false;  ///< the last slope is the first of the next step

  constexpr bool embedded() const {
    for (const double e : error)
      if (e != 0) return true;
    return false;
  }
  /// c_j.
  constexpr double node(int stage) const {
    double c = 0;
    if (scheme != LieGroupScheme::commutator_free) {
      for (const double w : a[std::size_t(stage)]) c += w;
      return c;
    }
    for (int at = stage; at > 0; at = products[std::size_t(at)].from)
      for (const Row& row : products[std::size_t(at)].weights)
        for (const double w : row) c += w;
    return c;
  }
};

namespace lie_group_methods {

/// exp(h F(z)) z.
inline constexpr LieGroupMethod lie_euler{"lie-euler", 1, LieGroupScheme::commutator_free, 1, {{{}, {0, 1, {{{1}}}}}}};

/// Crouch and Grossman (J. Nonlinear Sci. 3, 1993), the midpoint of order 2.
inline constexpr LieGroupMethod crouch_grossman_2{
    "crouch-grossman-2", 2, LieGroupScheme::commutator_free, 2, {{{}, {0, 1, {{{0.5}}}}, {0, 1, {{{0, 1}}}}}}};

/// Crouch and Grossman's method of order 3 (Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.8.1).
inline constexpr LieGroupMethod crouch_grossman_3{"crouch-grossman-3",
                                                  3,
                                                  LieGroupScheme::commutator_free,
                                                  3,
                                                  {{{},
                                                    {0, 1, {{{3.0 / 4}}}},
                                                    {0, 2, {{{119.0 / 216}, {0, 17.0 / 108}}}},
                                                    {0, 3, {{{13.0 / 51}, {0, -2.0 / 3}, {0, 0, 24.0 / 17}}}}}}};

/// CF4 of Celledoni, Marthinsen and Owren (Future Gener. Comput. Syst. 19, 2003): five exponentials, four slopes.
inline constexpr LieGroupMethod commutator_free_4{
    "commutator-free-4",
    4,
    LieGroupScheme::commutator_free,
    4,
    {{{},
      {0, 1, {{{0.5}}}},
      {0, 1, {{{0, 0.5}}}},
      {1, 1, {{{-0.5, 0, 1}}}},
      {0, 2, {{{3.0 / 12, 2.0 / 12, 2.0 / 12, -1.0 / 12}, {-1.0 / 12, 2.0 / 12, 2.0 / 12, 3.0 / 12}}}}}}};

namespace detail {
constexpr std::array<LieGroupMethod::Row, 7> kutta{{{}, {0.5}, {0, 0.5}, {0, 0, 1}}};
constexpr LieGroupMethod::Row kutta_weights{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
}  // namespace detail

/// Munthe-Kaas' method (Appl. Numer. Math. 29, 1999) on Kutta's: u_j' = dexp_u^{-1} F, of which order 4 requires F -
/// [u, F] / 2 + [u, [u, F]] / 12 (Hairer, Lubich, Wanner, theorem IV.8.5).
inline constexpr LieGroupMethod munthe_kaas_4{
    "munthe-kaas-4", 4, LieGroupScheme::munthe_kaas, 4, {}, detail::kutta, detail::kutta_weights};

/// The same on Dormand and Prince's pair of orders 5 and 4 (Hairer, Norsett, Wanner, table II.5.2). Order 5 requires no
/// more terms of dexp_u^{-1}, because the third has coefficient zero.
inline constexpr LieGroupMethod munthe_kaas_54{
    "munthe-kaas-54",
    5,
    LieGroupScheme::munthe_kaas,
    7,
    {},
    {{{},
      {1.0 / 5},
      {3.0 / 40, 9.0 / 40},
      {44.0 / 45, -56.0 / 15, 32.0 / 9},
      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
      {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}}},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
    {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40},
    true};

/// Euler's method, in coordinates.
inline constexpr LieGroupMethod euler{"euler", 1, LieGroupScheme::classical, 1, {}, {}, {1}};

/// Kutta's method, in coordinates.
inline constexpr LieGroupMethod runge_kutta_4{"runge-kutta-4",      4, LieGroupScheme::classical, 4, {}, detail::kutta,
                                              detail::kutta_weights};

inline constexpr std::array all{
    lie_euler, crouch_grossman_2, crouch_grossman_3, commutator_free_4, munthe_kaas_4, munthe_kaas_54,
    euler,     runge_kutta_4};

/// The method of that name; null where there is none.
constexpr const LieGroupMethod* named(std::string_view name) {
  for (const auto& method : all)
    if (method.name == name) return &method;
  return nullptr;
}

}  // namespace lie_group_methods

}  // namespace lagroid
