#pragma once
/// Symmetric compositions: from a symmetric step of order two, steps of orders four, six and eight.

#include <array>
#include <span>
#include <string_view>

namespace lagroid {

/// Psi_h = Phi_{gamma_s h} o ... o Phi_{gamma_1 h}, of a symmetric one-step map Phi_h of order two.
///
/// Requires gamma_{s+1-i} = gamma_i, so that Psi_h is symmetric too and its order even; order p asks of the
/// coefficients that sum gamma_i = 1 and, among other conditions, sum gamma_i^k = 0 for odd k from 3 to p - 1 (Hairer,
/// Lubich, Wanner, *Geometric Numerical Integration*, 2006, V.3.2). Above order two some of them are negative: Phi must
/// bear steps back. Whatever Phi preserves (momenta, the Poisson structure, reversibility), Psi does.
///
/// `coefficients` refers to numbers that must outlive it.
struct Composition {
  std::string_view name;
  int order;
  std::span<const double> coefficients;  ///< gamma_1 ... gamma_s
  std::string_view source;

  constexpr int stages() const { return int(coefficients.size()); }
};

namespace detail {

inline constexpr std::array<double, 1> one{1.0};
/// 1 / (2 - 2^(1/3)).
inline constexpr std::array<double, 3> yoshida_4{1.35120719195965763404768781, -1.70241438391931526809537562,
                                                 1.35120719195965763404768781};
/// 1 / (4 - 4^(1/3)).
inline constexpr std::array<double, 5> suzuki_4{0.41449077179437573714235406, 0.41449077179437573714235406,
                                                -0.65796308717750294856941625, 0.41449077179437573714235406,
                                                0.41449077179437573714235406};
inline constexpr std::array<double, 9> kahan_li_6{
    0.39216144400731413927925056,  0.33259913678935943859974864, -0.70624617255763935980996482,
    0.08221359629355080023149045,  0.79854399093482996339895035, 0.08221359629355080023149045,
    -0.70624617255763935980996482, 0.33259913678935943859974864, 0.39216144400731413927925056};
inline constexpr std::array<double, 15> suzuki_umeno_8{
    0.74167036435061295344822780,  -0.40910082580003159399730010, 0.19075471029623837995387626,
    -0.57386247111608226665638733, 0.29906418130365592384446354,  0.33462491824529818378495798,
    0.31529309239676659663205666,  -0.79688793935291635401978884, 0.31529309239676659663205666,
    0.33462491824529818378495798,  0.29906418130365592384446354,  -0.57386247111608226665638733,
    0.19075471029623837995387626,  -0.40910082580003159399730010, 0.74167036435061295344822780};
inline constexpr std::array<double, 17> kahan_li_8{
    0.13020248308889008087881763,  0.56116298177510838456196441,  -0.38947496264484728640807860,
    0.15884190655515560089621075,  -0.39590389413323757733623154, 0.18453964097831570709183254,
    0.25837438768632204729397911,  0.29501172360931029887096624,  -0.60550853383003451169892108,
    0.29501172360931029887096624,  0.25837438768632204729397911,  0.18453964097831570709183254,
    -0.39590389413323757733623154, 0.15884190655515560089621075,  -0.38947496264484728640807860,
    0.56116298177510838456196441,  0.13020248308889008087881763};

}  // namespace detail

/// The compositions by name; "single" is the step itself.
namespace compositions {

inline constexpr Composition single{"single", 2, detail::one, "the step itself"};
inline constexpr Composition triple_jump{"triple-jump", 4, detail::yoshida_4,
                                         "Yoshida 1990; Suzuki 1990; Hairer, Lubich, Wanner, Example II.4.2"};
inline constexpr Composition suzuki{"suzuki", 4, detail::suzuki_4,
                                    "Suzuki 1990; Hairer, Lubich, Wanner, Example II.4.3"};
inline constexpr Composition kahan_li_6{"kahan-li-6", 6, detail::kahan_li_6,
                                        "Kahan and Li 1997; Hairer, Lubich, Wanner V.3.2"};
inline constexpr Composition suzuki_umeno_8{"suzuki-umeno-8", 8, detail::suzuki_umeno_8,
                                            "Suzuki and Umeno 1993; McLachlan 1995; Hairer, Lubich, Wanner V.3.2"};
inline constexpr Composition kahan_li_8{"kahan-li-8", 8, detail::kahan_li_8,
                                        "Kahan and Li 1997; Hairer, Lubich, Wanner V.3.2"};

inline constexpr std::array<Composition, 6> all{single, triple_jump, suzuki, kahan_li_6, suzuki_umeno_8, kahan_li_8};

}  // namespace compositions

}  // namespace lagroid
