#include <lagroid/run/reports/curves.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace lagroid {

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// A recorded column by its label: a number at each node, NaN where there is no row.
class Column {
 public:
  Column(const Trajectory& trajectory, const std::string& label) {
    if (label == "t") {
      first_ = trajectory.time.data();
      rows_ = trajectory.time.size();
      return;
    }
    for (const Columns& s : trajectory.series) {
      const auto at = std::find(s.components.begin(), s.components.end(), label);
      if (at == s.components.end()) continue;
      first_ = s.values.data() + (at - s.components.begin());
      stride_ = s.width();
      rows_ = s.values.size() / s.width();
      skipped_ = s.on_arrows ? 1 : 0;
      return;
    }
  }

  double operator[](std::size_t node) const {
    return node >= skipped_ && node - skipped_ < rows_ ? first_[(node - skipped_) * stride_] : no_number;
  }

 private:
  const double* first_ = nullptr;
  std::size_t stride_ = 1;
  std::size_t rows_ = 0;
  std::size_t skipped_ = 0;
};

std::vector<Column> columns_of(const std::vector<std::string>& labels, const Trajectory& trajectory) {
  std::vector<Column> out;
  for (const std::string& label : labels) out.emplace_back(trajectory, label);
  return out;
}

/// The least and the greatest finite number of some columns; none: least > greatest.
struct Range {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -least;

  void take(double x) {
    if (!std::isfinite(x)) return;
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
  double width() const { return greatest - least; }
  /// Which of so many equal parts x lies in.
  long part(double x, long parts) const {
    return width() > 0 ? std::clamp(long((x - least) / width() * double(parts)), 0L, parts - 1) : 0;
  }
};

Range range_of(const std::vector<Column>& columns, std::size_t nodes) {
  Range out;
  for (const Column& column : columns)
    for (std::size_t node = 0; node < nodes; ++node) out.take(column[node]);
  return out;
}

/// The number of the fewest digits that is no farther from the middle than the range is wide; 0 where none is needed.
double offset_of(const Range& range) {
  constexpr double told_apart = 1e-3;
  const double size = std::max(std::abs(range.least), std::abs(range.greatest));
  if (!(range.width() > 0) || !(range.width() < told_apart * size)) return 0;
  const double middle = range.least + 0.5 * range.width();
  for (int digits = 0; digits < 16; ++digits)
    if (const double rounded = std::strtod(fmt::format("{:.{}e}", middle, digits).c_str(), nullptr);
        std::abs(rounded - middle) <= range.width())
      return rounded;
  return middle;
}

bool never_falls(const Column& x, std::size_t nodes) {
  for (std::size_t node = 1; node < nodes; ++node)
    if (!(x[node] >= x[node - 1])) return false;
  return true;
}

Stroke visible_over(const Column& x, const std::vector<Column>& curves, std::size_t nodes) {
  constexpr long parts = 1000;
  Range across;
  across.take(x[0]);
  across.take(x[nodes - 1]);
  Stroke rows{0, nodes - 1};
  struct Extremes {
    std::size_t least, greatest;
  };
  for (const Column& curve : curves) {
    long part = -1;
    std::optional<Extremes> found;
    const auto keep = [&] {
      if (found) rows.insert(rows.end(), {found->least, found->greatest});
      found.reset();
    };
    for (std::size_t node = 0; node < nodes; ++node) {
      if (const long now = across.part(x[node], parts); now != part) {
        keep();
        part = now;
      }
      const double y = curve[node];
      if (!std::isfinite(y)) continue;
      if (!found) found = {node, node};
      if (y < curve[found->least]) found->least = node;
      if (y > curve[found->greatest]) found->greatest = node;
    }
    keep();
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

/// The places of a picture that a pen has been to.
class Paper {
 public:
  Paper(Range x, Range y) : x_(x), y_(y), touched_(std::size_t(cells * cells)) {}

  using Cell = std::pair<long, long>;
  Cell at(double x, double y) const { return {x_.part(x, cells), y_.part(y, cells)}; }

  /// Draws a straight line; false where all of it has been drawn before.
  bool draw(Cell from, Cell to) {
    const long steps = std::max({std::abs(to.first - from.first), std::abs(to.second - from.second), 1L});
    bool is_new = false;
    for (long k = 0; k <= steps; ++k) {
      const auto between = [&](long a, long b) { return a + std::lround(double((b - a) * k) / double(steps)); };
      auto& place = touched_[std::size_t(between(from.first, to.first) * cells + between(from.second, to.second))];
      is_new = is_new || place == 0;
      place = 1;
    }
    return is_new;
  }

 private:
  static constexpr long cells = 400;
  Range x_, y_;
  std::vector<std::uint8_t> touched_;
};

std::vector<Stroke> visible_path(const Column& x, const std::vector<Column>& curves, std::size_t nodes) {
  const Range across = range_of({x}, nodes);
  const Range up = range_of(curves, nodes);
  std::vector<Stroke> strokes;
  std::vector<Paper> papers(curves.size(), Paper(across, up));  // curves may hide each other, but not themselves alone
  const auto cells = [&](std::size_t node) {
    std::vector<Paper::Cell> out;
    for (std::size_t c = 0; c < curves.size(); ++c) out.push_back(papers[c].at(x[node], curves[c][node]));
    return out;
  };
  const auto is_finite = [&](std::size_t node) {
    return std::isfinite(x[node]) &&
           std::all_of(curves.begin(), curves.end(), [&](const Column& c) { return std::isfinite(c[node]); });
  };
  std::vector<Paper::Cell> before, last;  // where the node before lies, and where the last stroke ends
  for (std::size_t node = 0; node < nodes; ++node) {
    if (!is_finite(node)) {
      before.clear();
      last.clear();
      continue;
    }
    auto now = cells(node);
    if (!before.empty()) {
      bool is_new = false;
      for (std::size_t c = 0; c < curves.size(); ++c) is_new = papers[c].draw(before[c], now[c]) || is_new;
      if (is_new) {
        if (strokes.empty() || last != before) strokes.push_back({node - 1});
        strokes.back().push_back(node);
        last = now;
      }
    }
    before = std::move(now);
  }
  if (strokes.empty()) strokes.push_back({0});
  return strokes;
}

}  // namespace

void take_offsets(Panel& panel, const Trajectory& trajectory) {
  const std::size_t nodes = trajectory.time.size();
  panel.x_offset = offset_of(range_of({Column(trajectory, panel.x)}, nodes));
  panel.y_offset = offset_of(range_of(columns_of(panel.curves, trajectory), nodes));
}

std::string label_of(const std::string& label, double offset) {
  if (offset == 0) return label;
  return fmt::format("{} {} {}", label, offset > 0 ? '-' : '+', std::abs(offset));
}

std::vector<Stroke> visible_strokes(const Panel& panel, const Trajectory& trajectory) {
  const std::size_t nodes = trajectory.time.size();
  if (nodes == 0) return {};
  const Column x(trajectory, panel.x);
  const auto curves = columns_of(panel.curves, trajectory);
  if (never_falls(x, nodes)) return {visible_over(x, curves, nodes)};
  return visible_path(x, curves, nodes);
}

std::string table_of_visible(const std::vector<Panel>& panels, const Trajectory& trajectory) {
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  for (const Panel& panel : panels) {
    fmt::format_to(to, "{}# {},{}\n", out.size() == 0 ? "" : "\n\n", panel.x, fmt::join(panel.curves, ","));
    const Column x(trajectory, panel.x);
    const auto curves = columns_of(panel.curves, trajectory);
    bool first = true;
    for (const Stroke& stroke : visible_strokes(panel, trajectory)) {
      if (!std::exchange(first, false)) out.push_back('\n');
      for (const std::size_t node : stroke) {
        fmt::format_to(to, "{}", x[node]);
        for (const Column& curve : curves) fmt::format_to(to, ",{}", curve[node]);
        out.push_back('\n');
      }
    }
  }
  return fmt::to_string(out);
}

}  // namespace lagroid
