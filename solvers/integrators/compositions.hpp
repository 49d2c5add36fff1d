#pragma once
/// Symmetric compositions: the coefficients gamma_i that make of a symmetric step of order two one of order four, six
/// or eight, and those for the exact flows of two parts of an energy.
///
///     Psi_h = Phi_{gamma_s h} o ... o Phi_{gamma_1 h}
///
/// They are constants, chosen by name or order; a list of your own is a `Composition` as well.
///
///     static constexpr std::array gamma{0.5, 0.5};
///     const Composition halves{"two halves", 2, gamma, "our own"};
///     const Composition eighth = compositions::kahan_li_8;
///
/// Sources stand with each list (Hairer, Lubich, Wanner V.3.2; Blanes and Moan 2002).

#include <array>
#include <span>
#include <string_view>

namespace lagroid {

/// Psi_h = Phi_{gamma_s h} o ... o Phi_{gamma_1 h}, of a symmetric one-step map Phi_h of order two.
///
/// Requires gamma_{s+1-i} = gamma_i, so that Psi_h is symmetric too and its order even; order p requires of the
/// coefficients that sum gamma_i = 1 and, among other conditions, sum gamma_i^k = 0 for odd k from 3 to p - 1 (Hairer,
/// Lubich, Wanner, *Geometric Numerical Integration*, 2006, V.3.2). Above order two some of them are negative: Phi must
/// bear steps back. Whatever Phi preserves (momenta, the Poisson structure, reversibility), Psi does.
///
/// With `kicks` it is of two exact flows instead, those of H_0 and of H_1 (SplitSystem):
///
///     Psi_h = phi0_{b_{s+1} h} o phi1_{gamma_s h} o phi0_{b_s h} o ... o phi1_{gamma_1 h} o phi0_{b_1 h},
///
/// symmetric as well; it can do with fewer flows, for a Strang step spends half of them on its own symmetry.
///
/// `coefficients` and `kicks` refer to numbers that must outlive it.
struct Composition {
  std::string_view name;
  int order;
  std::span<const double> coefficients;  ///< gamma_1 ... gamma_s
  std::string_view source;
  std::span<const double> kicks = {};  ///< b_1 ... b_{s+1}
  bool nystrom = false;                ///< the order is had only where [H_0, [H_0, [H_0, H_1]]] = 0

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

/// Of a symmetric sequence, its first half (and the middle) given: the last of the half is what is missing to one.
template <std::size_t Half, std::size_t Size>
constexpr std::array<double, Size> symmetric_to_one(const std::array<double, Half>& half) {
  std::array<double, Size> all{};
  double sum = 0;
  for (std::size_t i = 0; i < Half; ++i) {
    all[i] = all[Size - 1 - i] = half[i];
    sum += half[i];
  }
  if (Size == 2 * Half + 1) all[Half] = 1 - 2 * sum;
  if (Size == 2 * Half + 2) all[Half] = all[Half + 1] = 0.5 - sum;
  return all;
}

// Blanes and Moan 2002: tables 2 (S6, S10) and 3 (SRKN 6b, 11b, 14a). What begins with phi1 has kicks of zero length at
// its ends.
inline constexpr auto s6_flows = symmetric_to_one<3, 7>({0.0792036964311957, 0.353172906049774, -0.0420650803577195});
inline constexpr auto s6_kicks = symmetric_to_one<3, 8>({0, 0.209515106613362, -0.143851773179818});
inline constexpr auto s10_flows = symmetric_to_one<5, 11>(
    {0.0502627644003922, 0.413514300428344, 0.0450798897943977, -0.188054853819569, 0.541960678450780});
inline constexpr auto s10_kicks =
    symmetric_to_one<5, 12>({0, 0.148816447901042, -0.132385865767784, 0.067307604692185, 0.432666402578175});
inline constexpr auto srkn6_flows = symmetric_to_one<2, 6>({0.245298957184271, 0.604872665711080});
inline constexpr auto srkn6_kicks =
    symmetric_to_one<3, 7>({0.0829844064174052, 0.396309801498368, -0.0390563049223486});
inline constexpr auto srkn11_flows = symmetric_to_one<5, 11>(
    {0.123229775946271, 0.290553797799558, -0.127049212625417, -0.246331761062075, 0.357208872795928});
inline constexpr auto srkn11_kicks = symmetric_to_one<5, 12>(
    {0.0414649985182624, 0.198128671918067, -0.0400061921041533, 0.0752539843015807, -0.0115113874206879});
inline constexpr auto srkn14_flows =
    symmetric_to_one<7, 15>({0.0378593198406116, 0.102635633102435, -0.0258678882665587, 0.314241403071447,
                             -0.130144459517415, 0.106417700369543, -0.00879424312851058});
inline constexpr auto srkn14_kicks =
    symmetric_to_one<7, 16>({0, 0.09171915262446165, 0.183983170005006, -0.05653436583288827, 0.004914688774712854,
                             0.143761127168358, 0.328567693746804});

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

/// The compositions of two flows by name (Blanes and Moan, J. Comput. Appl. Math. 142 (2002) 313). The last three are
/// for a kinetic energy that is quadratic in the momenta and a potential (Runge-Kutta-Nystrom).
namespace splittings {

inline constexpr std::string_view blanes_moan = "Blanes and Moan 2002, J. Comput. Appl. Math. 142";
inline constexpr Composition s6{"blanes-moan-4", 4, detail::s6_flows, blanes_moan, detail::s6_kicks};
inline constexpr Composition s10{"blanes-moan-6", 6, detail::s10_flows, blanes_moan, detail::s10_kicks};
inline constexpr Composition srkn6{"nystrom-4", 4, detail::srkn6_flows, blanes_moan, detail::srkn6_kicks, true};
inline constexpr Composition srkn11{"nystrom-6", 6, detail::srkn11_flows, blanes_moan, detail::srkn11_kicks, true};
inline constexpr Composition srkn14{"nystrom-6-14", 6, detail::srkn14_flows, blanes_moan, detail::srkn14_kicks, true};

inline constexpr std::array<Composition, 5> all{s6, s10, srkn6, srkn11, srkn14};

}  // namespace splittings

}  // namespace lagroid
