#pragma once
/// The declaration of the Moser-Veselov method: name, orders and source, for scenes and studies.

#include <lagroid/solvers/methods/declared_methods.hpp>

#include <array>

namespace lagroid {

/// The orders to which it is preprocessed; the last is what there is by default.
inline constexpr std::array moser_veselov_orders{2, 4, 6, 8, 10};

inline constexpr DeclaredMethod moser_veselov_method{
    .name = "moser-veselov",
    .order = moser_veselov_orders.back(),
    .other_orders = OtherOrders::preprocessed,
    .source = {"hairer2006", "the preprocessed discrete Moser-Veselov algorithm"}};

}  // namespace lagroid
