#include "uncertainty.hpp"

#include <lagroid/solvers/poisson/wiener_path.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lagroid::app {

namespace {

/// What a column is nudged by.
struct Nudged {
  Nudge nudge;
  double deviation;
};

/// Draw number `draw` of all columns.
std::vector<Nudge> drawn(const std::vector<Nudged>& columns, const WienerPath& stream, long draw) {
  std::vector<Nudge> out;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    out.push_back(columns[j].nudge);
    out.back().by = columns[j].deviation * stream.normals(draw, std::uint32_t(j / 2))[j % 2];
  }
  return out;
}

Uncertainty::Sample sample(const GradientSubject& subject, const GradientTable& table,
                           const std::vector<Nudged>& columns, const Draws& draws) {
  Uncertainty::Sample out;
  const WienerPath stream{.seed = draws.seed};
  const auto size = table.values.size();
  // Of differences to the middle run, which are small, and their products (Welford).
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(size, size);
  long counted = 0;
  for (; out.runs < draws.count; ++out.runs) {
    const auto values = values_of(subject, table, drawn(columns, stream, out.runs));
    if (!values || !values->allFinite()) {
      ++out.failed;
      continue;
    }
    const Eigen::VectorXd off = *values - table.values - mean;
    mean += off / double(++counted);
    products += off * (*values - table.values - mean).transpose();
  }
  if (counted < 2) throw GradientRefused("fewer than two of the runs that were drawn came to their end");
  out.mean = table.values + mean;
  out.covariance = products / double(counted - 1);
  return out;
}

double deviation_at(const Eigen::MatrixXd& covariance, Eigen::Index i) { return std::sqrt(covariance(i, i)); }

/// Of rows i and k; zero where one of them has no error at all.
double correlation(const Eigen::MatrixXd& covariance, Eigen::Index i, Eigen::Index k) {
  const double sizes = deviation_at(covariance, i) * deviation_at(covariance, k);
  return sizes > 0 ? covariance(i, k) / sizes : 0;
}

/// How much of a row's variance is due to a column.
double share(const Uncertainty& u, Eigen::Index row, Eigen::Index column) {
  const double part = u.table.derivatives(row, column) * u.deviations(column);
  return u.covariance(row, row) > 0 ? part * part / u.covariance(row, row) : 0;
}

}  // namespace

std::vector<Deviation> deviations_of(const std::vector<std::string>& words) {
  std::vector<Deviation> out;
  for (const std::string& word : words) {
    const std::size_t at = word.find('=');
    double size = -1;
    if (at != std::string::npos) {
      const auto read = std::from_chars(word.data() + at + 1, word.data() + word.size(), size);
      if (read.ec != std::errc() || read.ptr != word.data() + word.size()) size = -1;
    }
    if (!(size > 0 && std::isfinite(size)))
      throw GradientRefused(fmt::format("{}: give NAME=SIGMA, a positive standard deviation", word));
    out.push_back({word.substr(0, at), size});
  }
  return out;
}

Uncertainty uncertainty_of(const GradientSubject& subject, const std::vector<std::string>& of,
                           const std::vector<Deviation>& deviations, const Draws& draws) {
  std::vector<std::string> words;
  std::vector<Nudged> start, parameters;
  for (const Deviation& each : deviations) {
    words.push_back(each.name);
    const GradientColumns columns = columns_of(subject, {each.name});
    for (const int i : columns.start) start.push_back({{.index = i}, each.size});
    for (const int i : columns.parameters)
      parameters.push_back({{.parameter = subject.parameters[std::size_t(i)].name}, each.size});
  }
  Uncertainty out;
  out.table = differentiate(subject, of, words, /*check=*/false);
  std::vector<Nudged> all = start;
  all.insert(all.end(), parameters.begin(), parameters.end());
  if (all.size() != out.table.columns.size())
    throw GradientRefused("a start or a parameter has two deviations; give each one");
  if (!out.table.failure.empty()) return out;
  out.deviations.resize(Eigen::Index(all.size()));
  std::transform(all.begin(), all.end(), out.deviations.begin(), [](const Nudged& each) { return each.deviation; });
  const Eigen::MatrixXd scaled = out.table.derivatives * out.deviations.asDiagonal();
  out.covariance = scaled * scaled.transpose();
  if (draws.count > 0) out.sample = sample(subject, out.table, all, draws);
  return out;
}

std::string text_of(const Uncertainty& u) {
  const GradientTable& table = u.table;
  const auto count = Eigen::Index(table.rows.size());
  std::string out = fmt::format("{}: what errors become in {} steps\n\n", table.system, table.steps);
  std::size_t first = 0;
  for (const std::string& row : table.rows) first = std::max(first, row.size());
  out += fmt::format("  {:{}}  {:>18}  {:>12}", "", first, "value", "deviation");
  if (u.sample) out += fmt::format("  {:>12}", "of draws");
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) {
    widths.push_back(std::max<std::size_t>(8, column.size() + 5));
    out += fmt::format("  {:>{}}", "% by " + column, widths.back());
  }
  out += "\n";
  for (Eigen::Index i = 0; i < count; ++i) {
    out += fmt::format("  {:{}}  {:18.10g}  {:12.4g}", table.rows[std::size_t(i)], first, table.values(i),
                       deviation_at(u.covariance, i));
    if (u.sample) out += fmt::format("  {:12.4g}", deviation_at(u.sample->covariance, i));
    for (std::size_t j = 0; j < widths.size(); ++j)
      out += fmt::format("  {:{}.1f}", 100 * share(u, i, Eigen::Index(j)), widths[j]);
    out += "\n";
  }
  if (count > 1) {
    out += "\n  correlations\n";
    for (Eigen::Index i = 0; i < count; ++i) {
      out += fmt::format("  {:{}}", table.rows[std::size_t(i)], first);
      for (Eigen::Index k = 0; k <= i; ++k) out += fmt::format("  {:7.4f}", correlation(u.covariance, i, k));
      out += "\n";
    }
  }
  out += words_of_growth(table);
  if (u.sample) {
    const double counted = double(u.sample->runs - u.sample->failed);
    out += fmt::format("  {} runs were drawn{}; their deviations are known to {:.2g} %\n", u.sample->runs,
                       u.sample->failed > 0 ? fmt::format(", {} of which ended early", u.sample->failed) : "",
                       100 / std::sqrt(2 * (counted - 1)));
  }
  return out;
}

std::string json_of(const Uncertainty& u) {
  using Json = nlohmann::ordered_json;
  Json out = Json::parse(json_of(u.table));
  if (!u.table.failure.empty()) return out.dump(2);
  const auto vector = [](const Eigen::VectorXd& v) { return std::vector<double>(v.data(), v.data() + v.size()); };
  const auto matrix = [&](const Eigen::MatrixXd& a) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < a.rows(); ++i) rows.push_back(vector(a.row(i)));
    return rows;
  };
  out["deviations"] = vector(u.deviations);
  out["covariance"] = matrix(u.covariance);
  if (u.sample)
    out["draws"] = {{"runs", u.sample->runs},
                    {"failed", u.sample->failed},
                    {"mean", vector(u.sample->mean)},
                    {"covariance", matrix(u.sample->covariance)}};
  return out.dump(2);
}

}  // namespace lagroid::app
