#include "differences.hpp"

#include "../../reading/scene_reader.hpp"

#include <lagroid/core/derivatives/extrapolated_difference.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

using ValuesAt = std::function<std::optional<Eigen::VectorXd>(double)>;
using Booleans = Eigen::Array<bool, Eigen::Dynamic, 1>;

/// The unit of what a row shows.
std::string unit_of_row(const GradientSubject& subject, const GradientTable& table, std::size_t row) {
  const int column = table.event_rows.empty() ? table.observed[row] : table.event_rows[row].column;
  return column < 0 ? "t" : unit_of(subject.observed[std::size_t(column)]);
}

constexpr double usual_size = 1e-2;
/// The change of column j by which some row changes by a hundredth of its size: the unit of a number that is zero. What
/// hardly changes a row by a usual size is rounding, and tells none.
double size_by_what_it_does(const GradientTable& table, const Eigen::ArrayXd& scales, Eigen::Index j) {
  std::map<double, double> largest;  // the derivative, by the size that rows of a unit share
  for (Eigen::Index i = 0; i < scales.size(); ++i)
    largest[scales(i)] = std::max(largest[scales(i)], std::abs(table.derivatives(i, j)));
  double size = std::numeric_limits<double>::infinity();
  constexpr double least = 1e-10;
  for (const auto& [scale, slope] : largest)
    if (scale > 0 && slope * usual_size > least * scale) size = std::min(size, 1e-2 * scale / slope);
  return std::isfinite(size) ? size : usual_size;
}
/// That of a number of the start, or a hundredth of the largest in its group: their unit is one. Zero where all are.
double size_of_start(const GradientSubject& subject, std::size_t index) {
  double largest = 0;
  for (std::size_t i = 0; i < subject.start.size(); ++i)
    if (subject.start[i].group == subject.start[index].group) largest = std::max(largest, std::abs(subject.sizes[i]));
  return std::max(std::abs(subject.sizes[index]), 1e-2 * largest);
}

/// One column beside differences of it; numbers are changes of rows where the column changes by its own size.
struct Compared {
  bool at_all = false;
  double size = 0;
  Eigen::ArrayXd difference = {};  ///< those that agree best
  Eigen::ArrayXd off = {};         ///< by how much these do not
  Eigen::ArrayXd error = {};       ///< to which the best known are known
  Booleans agrees = {};
  Booleans told_otherwise = {};  ///< by some that are known
};

/// What is alike for all columns.
struct RowScales {
  Eigen::ArrayXd scales;       ///< of values
  Eigen::ArrayXd noise;        ///< of values
  Eigen::ArrayXd derivatives;  ///< to which those are known
  Eigen::ArrayXd most;         ///< the largest change of each by a column's size
};

constexpr double known = 0.1;        ///< to so much of the largest in its row a difference tells something
constexpr double well_known = 1e-4;  ///< what a difference of the narrowest is to be known to
constexpr double agreed = 1e-5;      ///< of that: differences that are off by less are no contradiction
constexpr double settled = 1e-9;     ///< of that: no others are tried

constexpr double usual = 2e-3;  ///< width of a difference, in sizes of its number
/// How often some row, or what it does not show, changes by its own size where the number does by its.
double steepest_of(const Eigen::ArrayXd& exact, const RowScales& rows, double size, double rate) {
  return size * std::max(rate, (rows.scales > 0).select(exact.abs() / rows.scales, 0.0).maxCoeff());
}
/// Of differences, one after another: of the usual width, and narrower ones. Where some row is steep, or what it does
/// not show, that changes by its own size where the number changes by less than its.
std::vector<double> widths_of(const Eigen::ArrayXd& exact, const RowScales& rows, double size, double rate) {
  const double steepest = steepest_of(exact, rows, size, rate);
  std::vector<double> out{usual * size};
  if (steepest > 3)
    for (const double narrower : {1.0, 0.1}) out.push_back(narrower * usual * size / steepest);
  for (const double narrower : {0.1, 0.01, 0.001}) out.push_back(narrower * usual * size);
  return out;
}

/// What the values are known to, three times over, by nine beside each other, so near that a polynomial of degree three
/// has them but for rounding: fourth differences, of which each has 70 times the variance of a value (Moré and Wild,
/// Estimating computational noise, SIAM J. Sci. Comput. 33 (2011), section 3). Of terms that cancel a value shows
/// nothing. None where some has no value.
std::optional<Eigen::ArrayXd> noise_beside(const ValuesAt& values, double apart) {
  constexpr int order = 4;
  constexpr double variance = 70;
  std::vector<Eigen::ArrayXd> left;
  for (int k = -4; k <= 4; ++k) {
    const std::optional<Eigen::VectorXd> value = values(k * apart);
    if (!value) return std::nullopt;
    left.push_back(value->array());
  }
  for (int taken = 0; taken < order; ++taken) {
    for (std::size_t i = 0; i + 1 < left.size(); ++i) left[i] = (left[i + 1] - left[i]).eval();
    left.pop_back();
  }
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(left.front().size());
  for (const Eigen::ArrayXd& each : left) squares += each.square();
  return 3 * (squares / (variance * double(left.size()))).sqrt();
}

/// Of a column of derivatives, at a size of its number, of values that are known to the noise of their rows.
Compared compare_column_by(const Eigen::ArrayXd& exact, const RowScales& rows, const ValuesAt& values, double size,
                           double rate) {
  const Eigen::Index count = exact.size();
  Compared out{.size = size};
  out.agrees.setConstant(count, false);
  out.told_otherwise.setConstant(count, false);
  bool is_settled = false;
  const auto compare_at = [&](double width, double known_to) {
    const auto found = extrapolated_difference(values, width);
    if (!found) return;
    const Eigen::ArrayXd value = found->value;
    const Eigen::ArrayXd off = (value - exact).abs() * size;
    const Eigen::ArrayXd own = 10 * rows.derivatives * size;
    // Values are rounded, and so is the changed number.
    const Eigen::ArrayXd rounding = (rows.noise + exact.abs() * std::numeric_limits<double>::epsilon() * size) / width;
    const Eigen::ArrayXd of_difference = 10 * (found->correction.array().abs() + rounding) * size;
    const Eigen::ArrayXd error = of_difference + own;
    const Eigen::ArrayXd most = rows.most.max(value.abs() * size).max(1e-3 * rows.scales);
    // Of runs that end farther apart than rows are large, differences are no derivatives.
    const auto is_near =
        (rows.scales <= 0 || exact.abs() * width <= rows.scales) && Booleans::Constant(count, rate * width <= 1);
    const auto is_known = is_near && of_difference <= own.max(known_to * most);
    const auto tells = error <= most.max(rows.scales);
    out.agrees = out.agrees || (is_known && off <= error) || (tells && off <= own.max(agreed * most));
    out.told_otherwise = out.told_otherwise || (is_known && off > error);
    if (!std::exchange(out.at_all, true)) {
      out.difference = value;
      out.off = off;
      out.error = error;
    } else {
      const Booleans nearer = off < out.off;
      out.difference = nearer.select(value, out.difference).eval();
      out.error = out.error.min(error).eval();
      out.off = nearer.select(off, out.off).eval();
    }
    is_settled = (out.off <= settled * most).all();
  };
  for (const double width : widths_of(exact, rows, size, rate)) {
    compare_at(width, known);
    if (is_settled) return out;
  }
  // An angle of many turns repeats itself within these: only differences that are known well tell more than they.
  for (const double narrower : {1e-4, 1e-5, 1e-6, 1e-7})
    if ((out.told_otherwise && !out.agrees).any()) compare_at(narrower * usual * size, well_known);
  return out;
}

/// The same; what differences contradict is compared once more, by the noise that values have.
Compared compare_column(const Eigen::ArrayXd& exact, RowScales rows, const ValuesAt& values, double size, double rate) {
  Compared out = compare_column_by(exact, rows, values, size, rate);
  const Booleans contradicted = out.told_otherwise && !out.agrees;
  if (!contradicted.any()) return out;
  constexpr double narrow = 1e-10, narrowest = 1e-14;  // of which the changed number has some ulps
  const double apart = std::max(narrowest, narrow / std::max(1.0, steepest_of(exact, rows, size, rate)));
  const std::optional<Eigen::ArrayXd> noise = noise_beside(values, apart * size);
  if (!noise || (*noise <= rows.noise || !contradicted).all()) return out;
  rows.noise = rows.noise.max(*noise);
  return compare_column_by(exact, rows, values, size, rate);
}

Eigen::ArrayXd scales_of_rows(const GradientSubject& subject, const GradientTable& table, const ValuesAreKnown& is) {
  std::map<std::string, double> units;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::string unit = unit_of_row(subject, table, i);
    const auto of_run = is.sizes.find(unit);
    double& most = units[unit];
    most = std::max({most, std::abs(table.values(Eigen::Index(i))), of_run == is.sizes.end() ? 0 : of_run->second});
  }
  Eigen::ArrayXd out(table.values.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) out(Eigen::Index(i)) = units[unit_of_row(subject, table, i)];
  return out;
}

/// To how many digits all that could be compared agrees, or how many the rounding of differences leaves.
void count_digits(const std::vector<Compared>& columns, const RowScales& rows, GradientTable& table) {
  table.within_rounding = true;
  double fewest = 16, of_rounding = 0;
  for (Eigen::Index i = 0; i < rows.most.size(); ++i) {
    double off = 0, error = 0, most = 0;
    bool is_told = false;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const Compared& column = columns[j];
      if (!column.agrees(i) && !column.told_otherwise(i)) continue;
      is_told = true;
      off = std::max(off, column.off(i));
      error = std::max(error, column.error(i));
      most = std::max(most, std::abs(table.derivatives(i, Eigen::Index(j))) * column.size);
    }
    if (!is_told) continue;
    // Of a row that depends on nothing all that can be told is that.
    const bool is_nothing = most <= error && off <= error;
    const double least = is_nothing ? error : 1e-12 * rows.scales(i);
    const double digits = least > 0 ? std::log10(std::max(1.0, (is_nothing ? rows.scales(i) : most) / least)) : 16;
    if (least > 0) of_rounding = std::max(of_rounding, digits);  // of a row without a size nothing is told
    if (off <= least) continue;
    table.within_rounding = false;
    fewest = std::min(fewest, std::max(0.0, std::log10(most / off)));
  }
  table.digits_agreed = table.within_rounding ? std::min(16.0, of_rounding) : fewest;
}

}  // namespace

void compare_with_differences(const GradientSubject& subject, const GradientColumns& columns, GradientTable& table,
                              const std::function<std::optional<Eigen::VectorXd>(const std::vector<Nudge>&)>& values,
                              const ValuesAreKnown& is) {
  const auto count = table.derivatives.cols();
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(table.values.size());
  RowScales rows{scales_of_rows(subject, table, is), none, is.derivatives.size() > 0 ? is.derivatives : none, none};
  rows.noise = (2 * std::numeric_limits<double>::epsilon() + is.tolerance) * is.growth * rows.scales;
  if (is.conditions.size() > 0) rows.noise *= is.conditions;
  std::vector<Nudge> nudges(static_cast<std::size_t>(count));
  std::vector<double> sizes, of_numbers;
  for (std::size_t j = 0; j < nudges.size(); ++j) {
    const bool of_start = j < columns.start.size();
    const int index = of_start ? columns.start[j] : columns.parameters[j - columns.start.size()];
    if (of_start) {
      nudges[j].index = index;
      of_numbers.push_back(size_of_start(subject, std::size_t(index)));
    } else {
      nudges[j].parameter = subject.parameters[std::size_t(index)].name;
      of_numbers.push_back(std::abs(subject.sizes[subject.start.size() + std::size_t(index)]));
    }
    const auto at = Eigen::Index(j);
    sizes.push_back(of_numbers.back() != 0 ? of_numbers.back() : size_by_what_it_does(table, rows.scales, at));
    if (of_numbers.back() != 0) rows.most = rows.most.max(table.derivatives.col(at).array().abs() * sizes.back());
  }
  table.differences.resize(table.derivatives.rows(), count);
  std::vector<Compared> found;
  for (std::size_t j = 0; j < nudges.size(); ++j) {
    const Eigen::ArrayXd exact = table.derivatives.col(Eigen::Index(j)).array();
    const double rate = is.rates.size() > 0 ? is.rates(Eigen::Index(j)) : 0;
    std::string why = is.where_none;
    const auto nudged = [&](double by) -> std::optional<Eigen::VectorXd> {
      nudges[j].by = by;
      try {
        return values({nudges[j]});
      } catch (const NothingBeside& reason) {
        why = reason.what();
      } catch (const SceneError& refusal) {
        why = fmt::format("are refused ({})", refusal.problem());
      } catch (const std::invalid_argument& refusal) {
        why = fmt::format("are refused ({})", refusal.what());
      }
      return std::nullopt;
    };
    Compared compared = compare_column(exact, rows, nudged, sizes[j], rate);
    // A derivative that is rounding says nothing of sizes.
    if (of_numbers[j] == 0 && !(compared.at_all && compared.agrees.all()))
      if (Compared again = compare_column(exact, rows, nudged, usual_size, rate); again.at_all)
        compared = std::move(again);
    if (!compared.at_all)
      throw GradientRefused(fmt::format("--check: {} beside this one, with another {}, {}; leave it out", is.what,
                                        table.columns[j], why));
    table.differences.col(Eigen::Index(j)) = compared.difference;
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      if (const auto at = Eigen::Index(i); !compared.agrees(at))
        (compared.told_otherwise(at) ? table.contradicted : table.untold)
            .push_back(fmt::format("{} by {}", table.rows[i], table.columns[j]));
    found.push_back(std::move(compared));
  }
  count_digits(found, rows, table);
}

}  // namespace lagroid::app
