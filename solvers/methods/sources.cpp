#include <lagroid/solvers/methods/sources.hpp>

#include <array>
#include <utility>

namespace lagroid {

namespace {

using Row = std::pair<std::string_view, Source>;

template <class Rows> Source in(const Rows& rows, std::string_view name) {
  for (const auto& [each, source] : rows)
    if (each == name) return source;
  return {};
}

}  // namespace

Source source_of(const Composition& composition) {
  constexpr std::string_view what = "the coefficients of a composition";
  constexpr std::string_view of_flows = "the coefficients of a splitting";
  static constexpr std::array<Row, 10> rows{{{compositions::triple_jump.name, {"yoshida1990", what}},
                                             {compositions::suzuki.name, {"suzuki1990", what}},
                                             {compositions::kahan_li_6.name, {"kahan1997", what}},
                                             {compositions::suzuki_umeno_8.name, {"mclachlan1995", what}},
                                             {compositions::kahan_li_8.name, {"kahan1997", what}},
                                             {splittings::s6.name, {"blanes2002", of_flows}},
                                             {splittings::s10.name, {"blanes2002", of_flows}},
                                             {splittings::srkn6.name, {"blanes2002", of_flows}},
                                             {splittings::srkn11.name, {"blanes2002", of_flows}},
                                             {splittings::srkn14.name, {"blanes2002", of_flows}}}};
  return in(rows, composition.name);
}

Source source_of(const LieGroupMethod& method) {
  using namespace lie_group_methods;
  constexpr std::string_view products = "methods of products of exponentials";
  constexpr std::string_view algebra = "Runge-Kutta methods in the Lie algebra";
  static constexpr std::array<Row, 6> rows{{{lie_euler.name, {"crouch1993", products}},
                                            {crouch_grossman_2.name, {"crouch1993", products}},
                                            {crouch_grossman_3.name, {"crouch1993", products}},
                                            {commutator_free_4.name, {"celledoni2003", "commutator-free methods"}},
                                            {munthe_kaas_4.name, {"munthe-kaas1999", algebra}},
                                            {munthe_kaas_54.name, {"munthe-kaas1999", algebra}}}};
  return in(rows, method.name);
}

}  // namespace lagroid
