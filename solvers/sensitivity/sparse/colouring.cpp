#include <lagroid/solvers/sensitivity/sparse/colouring.hpp>

#include <algorithm>

namespace lagroid {

std::vector<int> coloured(const std::vector<std::vector<int>>& columns, const std::vector<int>& order, int rows) {
  std::vector<int> out(columns.size());
  std::vector<std::vector<char>> taken;  // by each colour, its rows
  for (const int k : order) {
    const std::vector<int>& column = columns[std::size_t(k)];
    const auto is_free = [&](const std::vector<char>& of) {
      return std::none_of(column.begin(), column.end(), [&](int row) { return of[std::size_t(row)] != 0; });
    };
    const auto found = std::find_if(taken.begin(), taken.end(), is_free);
    out[std::size_t(k)] = int(found - taken.begin());
    auto& of = found == taken.end() ? taken.emplace_back(std::size_t(rows), char(0)) : *found;
    for (const int row : column) of[std::size_t(row)] = 1;
  }
  return out;
}

}  // namespace lagroid
