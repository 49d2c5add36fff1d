#include <lagroid/solvers/extrapolation/extrapolation_table.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace lagroid {

namespace {

/// Those of rows first to last, among so many.
Eigen::VectorXd weights_of(int first, int last, int rows) {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(rows);
  for (int j = first; j <= last; ++j) {
    double product = 1;
    for (int i = first; i <= last; ++i)
      if (i != j) product *= double(j * j) / double(j * j - i * i);
    w(j - 1) = product;
  }
  return w;
}

}  // namespace

ExtrapolationTable ExtrapolationTable::of(int rows, int lanes, int unit) {
  if (rows < 1 || rows > most_rows) throw std::invalid_argument("a table of extrapolation has eight rows at most");
  ExtrapolationTable table;
  table.rows = rows;
  const auto width = std::size_t(lanes);
  std::vector<std::vector<int>> rows_of(width);
  std::vector<int> steps(width, 0);
  for (int j = rows; j > 0; --j) {
    const auto least = std::min_element(steps.begin(), steps.end());
    *least += unit * j;
    rows_of[std::size_t(least - steps.begin())].push_back(j);
  }
  const std::vector<double> nothing(width, 0);
  const Slot idle{nothing, nothing, nothing, nothing, {}, {}, false};
  table.slots.assign(std::size_t(*std::max_element(steps.begin(), steps.end())), idle);
  for (std::size_t lane = 0; lane < width; ++lane) {
    auto slot = table.slots.begin();
    for (const int row : rows_of[lane]) {
      const int n = unit * row;
      for (int i = 0; i < n; ++i, ++slot) {
        slot->time[lane] = double(i) / n;
        slot->step[lane] = 1.0 / n;
        slot->first[lane] = i == 0 ? 1 : 0;
        slot->begins = slot->begins || i == 0;
        slot->last[lane] = i + 1 == n ? 1 : 0;
      }
      Slot& end = *(slot - 1);
      end.ends.push_back({int(lane), row});
      if (row == rows_of[lane].back()) continue;
      if (end.others.empty()) end.others = nothing;
      end.others[lane] = 1;
    }
  }
  const auto value = [&](int first, int last) { return weights_of(first, last, rows); };
  table.weights.resize(rows, 3);
  table.weights << value(1, rows), value(1, rows) - value(2, rows), value(1, rows - 1) - value(2, rows - 1);
  table.growth = table.weights.col(0).cwiseAbs().sum();
  return table;
}

/// Made once: a short motion takes little more time than they do.
auto ExtrapolationOrder::tables_of(int lanes, int unit) -> std::shared_ptr<const Tables> {
  static std::mutex one_at_a_time;
  static std::map<std::pair<int, int>, std::shared_ptr<const Tables>> known;
  const std::lock_guard lock(one_at_a_time);
  std::shared_ptr<const Tables>& tables = known[{lanes, unit}];
  if (!tables) {
    Tables made;
    for (int k = ExtrapolationTable::fewest_rows - 1; k <= ExtrapolationTable::most_rows; ++k)
      made[std::size_t(k)] = ExtrapolationTable::of(k, lanes, unit);
    tables = std::make_shared<const Tables>(std::move(made));
  }
  return tables;
}

ExtrapolationOrder::ExtrapolationOrder(double tolerance, int lanes, int unit, double longest)
    : tolerance_(tolerance), longest_(longest) {
  if (!(tolerance > 0) || !(longest > 0) || lanes < 1 || unit < 1)
    throw std::invalid_argument("extrapolation has a positive tolerance and steps, a lane at least, and rows of steps");
  tables_ = tables_of(lanes, unit);
  // About what steps settle at; the first few find the rest.
  rows_ = std::clamp(int(std::lround(2.5 - 0.5 * std::log10(tolerance))), ExtrapolationTable::fewest_rows + 1,
                     ExtrapolationTable::most_rows);
}

auto ExtrapolationOrder::judge(double h, double error, double error_below, double number) -> Verdict {
  // What the first row changes of T_k is O(h^(2k - 1)) over a step.
  const double allowed = std::max(tolerance_, std::numeric_limits<double>::epsilon() * table().growth * number);
  const auto size = [&](int rows, double of) {
    // A float is near enough, and costs a third: of short steps this is a fifth.
    const auto ratio = float(std::clamp(0.25 * allowed / std::max(of, 1e-300), 1e-30, 1e30));
    const double factor = 0.9 * double(std::pow(ratio, 1.0F / float(2 * rows - 1)));
    return h * std::clamp(factor, 0.1, 4.0);
  };
  const auto cost = [&](int rows) { return (*tables_)[std::size_t(rows)].cost(); };
  const double here = size(rows_, error);
  const double lower = size(rows_ - 1, error_below);
  const double work = cost(rows_) / std::min(here, longest_);
  const double work_below = cost(rows_ - 1) / std::min(lower, longest_);
  const bool accepted = error <= allowed;
  const bool lower_pays = rows_ > ExtrapolationTable::fewest_rows && work_below < 0.9 * work;
  const bool higher_may =
      accepted && rows_ < ExtrapolationTable::most_rows && work < 0.9 * work_below && here < longest_;
  double next = here;
  if (lower_pays) {
    --rows_;
    next = lower;
  } else if (higher_may) {
    next = here * cost(rows_ + 1) / cost(rows_);
    ++rows_;
  }
  // A step that was refused is not tried again as it was.
  return {accepted, accepted ? next : std::min(next, 0.7 * h)};
}

}  // namespace lagroid
