#pragma once
/// Columns of a sparse matrix that share no row can be varied in one direction: each entry of what comes out belongs to
/// one of them. The columns of a chain need as many directions as a few bodies have, whatever its length.
///
///     const std::vector<int> colours = coloured({{0, 1}, {1, 2}, {2, 3}}, {0, 1, 2}, 4);  // 0, 1, 0
///
/// Columns are given by their rows, and take the first colour that is free, one after another in an order. Nothing
/// throws.
///
/// Source: Curtis, Powell and Reid, On the estimation of sparse Jacobian matrices, J. Inst. Math. Appl. 13, 1974.

#include <vector>

namespace lagroid {

/// The colour of each column, from zero up.
std::vector<int> coloured(const std::vector<std::vector<int>>& columns, const std::vector<int>& order, int rows);

}  // namespace lagroid
