#include "uncertainty.hpp"

#include "../reading/data_set.hpp"

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/poisson/wiener_path.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace lagroid::app {

namespace {

/// What the columns of some errors are nudged by: one each.
std::vector<Nudge> nudges_of(const GradientSubject& subject, const InputErrors& errors, const Eigen::VectorXd& by) {
  std::vector<Nudge> out;
  for (std::size_t j = 0; j < errors.names.size(); ++j) {
    const GradientColumns columns = columns_of(subject, {errors.names[j]});
    for (const int i : columns.start) out.push_back({.index = i, .by = by(Eigen::Index(j))});
    for (const int i : columns.parameters)
      out.push_back({.parameter = subject.parameters[std::size_t(i)].name, .by = by(Eigen::Index(j))});
  }
  return out;
}

/// A with A A^T = covariance.
Eigen::MatrixXd root_of(const InputErrors& errors) {
  if (errors.are_independent) return errors.covariance.diagonal().cwiseSqrt().asDiagonal();
  const SymmetricEigenvectors found = symmetric_eigenvectors(errors.covariance);
  return found.vectors * found.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// Draw number `draw` of all columns.
Eigen::VectorXd drawn(const Eigen::MatrixXd& root, const WienerPath& stream, long draw) {
  Eigen::VectorXd normals(root.cols());
  for (Eigen::Index j = 0; j < normals.size(); ++j)
    normals(j) = stream.normals(draw, std::uint32_t(j / 2))[std::size_t(j % 2)];
  return root * normals;
}

Uncertainty::Sample sample(const GradientSubject& subject, const GradientTable& table, const InputErrors& errors,
                           const Draws& draws) {
  Uncertainty::Sample out;
  const Eigen::MatrixXd root = root_of(errors);
  const WienerPath stream{.seed = draws.seed};
  const auto size = table.values.size();
  // Of differences to the middle run, which are small, and their products (Welford).
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(size, size);
  long counted = 0;
  for (; out.runs < draws.count; ++out.runs) {
    const std::vector<Nudge> nudges = nudges_of(subject, errors, drawn(root, stream, out.runs));
    if (subject.refusal && !subject.refusal(nudges).empty()) {
      ++out.refused;
      continue;
    }
    const auto found = values_of(subject, table, nudges);
    if (!found || !found->values.allFinite()) {
      ++out.failed;
      continue;
    }
    if (!found->same_events) ++out.otherwise;
    const Eigen::VectorXd off = found->values - table.values - mean;
    mean += off / double(++counted);
    products += off * (found->values - table.values - mean).transpose();
  }
  if (counted < 2)
    throw GradientRefused(fmt::format(
        "fewer than two of the runs that were drawn came to their end; scenes refuse {} of {}", out.refused, out.runs));
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
  const double part = u.table.derivatives(row, column) * deviation_at(u.errors.covariance, column);
  return u.covariance(row, row) > 0 ? part * part / u.covariance(row, row) : 0;
}

/// Throws DataError for what is the covariance of nothing.
void require_covariance(const Eigen::MatrixXd& c, const std::string& file) {
  const auto refuse = [&](const char* what) {
    throw DataError(fmt::format("{}: its covariance {}; write it by lagroid fit --json", file, what));
  };
  const Eigen::VectorXd variances = c.diagonal();
  if (!c.allFinite() || !(variances.minCoeff() >= 0)) refuse("has a variance that is negative or no number");
  constexpr double rounding = 1e-9;
  const Eigen::VectorXd sizes =
      variances.unaryExpr([](double variance) { return variance > 0 ? std::sqrt(variance) : 1.0; });
  const Eigen::MatrixXd correlations = sizes.cwiseInverse().asDiagonal() * c * sizes.cwiseInverse().asDiagonal();
  if (!((correlations - correlations.transpose()).cwiseAbs().maxCoeff() <= rounding)) refuse("is not symmetric");
  if (!(symmetric_eigenvectors(correlations).values.minCoeff() >= -rounding * double(c.rows())))
    refuse("has a combination of negative variance");
}

}  // namespace

InputErrors independent_errors(const GradientSubject& subject, const std::vector<std::string>& words) {
  InputErrors out;
  std::vector<std::string> of_start, of_parameters;
  std::vector<double> start, parameters;
  for (const std::string& word : words) {
    const std::size_t at = word.find('=');
    double size = -1;
    if (at != std::string::npos) {
      const auto read = std::from_chars(word.data() + at + 1, word.data() + word.size(), size);
      if (read.ec != std::errc() || read.ptr != word.data() + word.size()) size = -1;
    }
    if (!(size > 0 && std::isfinite(size)))
      throw GradientRefused(fmt::format("{}: give NAME=SIGMA, a positive standard deviation", word));
    const GradientColumns columns = columns_of(subject, {word.substr(0, at)});
    for (const int i : columns.start) of_start.push_back("initial." + subject.start[std::size_t(i)].name);
    for (std::string& note : notes_on_left_out(subject, columns)) out.notes.push_back(std::move(note));
    start.insert(start.end(), columns.start.size(), size);
    for (const std::string& name : names_of(subject, columns)) of_parameters.push_back("parameters." + name);
    parameters.insert(parameters.end(), columns.parameters.size(), size);
  }
  out.names = of_start;
  out.names.insert(out.names.end(), of_parameters.begin(), of_parameters.end());
  start.insert(start.end(), parameters.begin(), parameters.end());
  std::vector<std::string> sorted = out.names;
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
    throw GradientRefused(fmt::format("{}: it has two deviations; give it one", *twice));
  out.covariance = Eigen::Map<const Eigen::VectorXd>(start.data(), Eigen::Index(start.size())).cwiseAbs2().asDiagonal();
  return out;
}

InputErrors fitted_errors(const std::string& file) {
  InputErrors out;
  out.are_independent = false;
  std::ifstream in(file);
  if (std::error_code none; !in || std::filesystem::is_directory(file, none))
    throw DataError(fmt::format("{}: cannot be read; write it by lagroid fit --json", file));
  try {
    const nlohmann::json fit = nlohmann::json::parse(in);
    for (const auto& unknown : fit.at("unknowns")) {
      out.names.push_back(unknown.at("name").get<std::string>());
      out.values.push_back(unknown.at("value").get<double>());
      if (out.names.back().find(" of run ") != std::string::npos)
        throw DataError(
            fmt::format("{}: {} is one start among several, and a prediction has one; fit one run, or "
                        "parameters alone",
                        file, out.names.back()));
      if (unknown.value("at_bound", false))
        throw DataError(fmt::format("{}: {} ended at its bound, where errors are not normal ones; fit without it", file,
                                    out.names.back()));
      if (unknown.at("deviation").is_null())
        throw DataError(
            fit.contains("scale") && fit.at("scale").is_null()
                ? fmt::format("{}: of as many numbers as unknowns errors are not known; give --sigma", file)
                : fmt::format("{}: {} is not told by its data; fit fewer unknowns", file, out.names.back()));
    }
    const auto n = Eigen::Index(out.names.size());
    out.covariance.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < n; ++k)
        out.covariance(i, k) = fit.at("covariance").at(std::size_t(i)).at(std::size_t(k)).get<double>();
    out.system = fit.at("system").get<std::string>();
  } catch (const nlohmann::json::exception&) {
    throw DataError(fmt::format("{}: it has no unknowns with their covariance; write it by lagroid fit --json", file));
  }
  if (out.names.empty()) throw DataError(fmt::format("{}: it has no unknowns; write it by lagroid fit --json", file));
  require_covariance(out.covariance, file);
  return out;
}

GradientSubject moved_to(const GradientSubject& subject, const InputErrors& errors) {
  if (errors.values.empty()) return subject;
  if (errors.system != subject.system)
    throw GradientRefused(
        fmt::format("--covariance: what was fitted is {}, and the scene is one of {}", errors.system, subject.system));
  GradientSubject out = subject;
  std::vector<Nudge> offsets;
  for (std::size_t j = 0; j < errors.names.size(); ++j) {
    const GradientColumns columns = columns_of(subject, {errors.names[j]});
    if (columns.start.size() + columns.parameters.size() != 1)
      throw GradientRefused(fmt::format("{}: it is no single number of this scene", errors.names[j]));
    const bool of_start = !columns.start.empty();
    const std::size_t place =
        of_start ? std::size_t(columns.start.front()) : subject.start.size() + std::size_t(columns.parameters.front());
    const double by = errors.values[j] - subject.sizes[place];
    out.sizes[place] += by;
    offsets.push_back(of_start ? Nudge{.index = columns.start.front(), .by = by}
                               : Nudge{.parameter = names_of(subject, columns).front(), .by = by});
  }
  const auto and_offsets = [offsets](std::vector<Nudge> nudges) {
    nudges.insert(nudges.end(), offsets.begin(), offsets.end());
    return nudges;
  };
  out.begin = [=](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
    return subject.begin(parameters, and_offsets(nudges));
  };
  if (subject.refusal) {
    out.refusal = [=](const std::vector<Nudge>& nudges) { return subject.refusal(and_offsets(nudges)); };
    if (const std::string why = out.refusal({}); !why.empty())
      throw GradientRefused(fmt::format("--covariance: a scene with what was fitted is refused: {}", why));
  }
  if (subject.begun_by)
    out.begun_by = [=](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      return subject.begun_by(parameters, and_offsets(nudges));
    };
  if (subject.through_events)
    out.through_events = [=](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges, long node,
                             ThroughEvents by) {
      return subject.through_events(parameters, and_offsets(nudges), node, by);
    };
  return out;
}

Uncertainty uncertainty_of(const GradientSubject& subject, const std::vector<std::string>& of,
                           const InputErrors& errors, const Draws& draws) {
  Uncertainty out;
  out.errors = errors;
  out.table = differentiate(subject, of, errors.names, /*check=*/false);
  out.table.notes.insert(out.table.notes.begin(), errors.notes.begin(), errors.notes.end());
  if (!out.table.failure.empty()) return out;
  if (out.table.columns != errors.names)
    throw GradientRefused("errors of starts come first, and then those of parameters, each once");
  out.covariance = out.table.derivatives * errors.covariance * out.table.derivatives.transpose();
  if (!out.covariance.allFinite()) {
    out.table.failure =
        "the covariance is no finite number: deviations, or derivatives, are too large for their squares";
    return out;
  }
  if (draws.count > 0) out.sample = sample(subject, out.table, errors, draws);
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
    if (!u.errors.are_independent) break;  // there are no shares of errors that go together
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
    const Uncertainty::Sample& drawn = *u.sample;
    const long counted = drawn.runs - drawn.failed - drawn.refused;
    const auto of_which = [](long some, const char* what) {
      return some > 0 ? fmt::format(", {} of which {}", some, what) : "";
    };
    out +=
        fmt::format("  {} runs were drawn{}{}", drawn.runs,
                    of_which(drawn.failed,
                             "failed, or ended elsewhere or through other events than are asked for, and do not count"),
                    of_which(drawn.refused, "have numbers that scenes refuse and do not count"));
    out += fmt::format("; deviations of {} are known to {:.2g} %\n",
                       counted < drawn.runs ? fmt::format("the other {}", counted) : "them",
                       100 / std::sqrt(2 * (double(counted) - 1)));
    if (drawn.otherwise > 0)
      out += fmt::format(
          "  {} of those that count go through other events than the run in the middle: of these derivatives know "
          "nothing\n",
          drawn.otherwise);
  }
  return out;
}

std::string json_of(const Uncertainty& u) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson out = OrderedJson::parse(json_of(u.table));
  if (!u.table.failure.empty()) return out.dump(2);
  const auto vector = [](const Eigen::VectorXd& v) { return std::vector<double>(v.data(), v.data() + v.size()); };
  const auto matrix = [&](const Eigen::MatrixXd& a) {
    OrderedJson rows = OrderedJson::array();
    for (Eigen::Index i = 0; i < a.rows(); ++i) rows.push_back(vector(a.row(i)));
    return rows;
  };
  out["deviations"] = vector(u.errors.covariance.diagonal().cwiseSqrt());
  out["covariance"] = matrix(u.covariance);
  if (u.sample)
    out["draws"] = {{"runs", u.sample->runs},         {"failed", u.sample->failed},
                    {"refused", u.sample->refused},   {"through_other_events", u.sample->otherwise},
                    {"mean", vector(u.sample->mean)}, {"covariance", matrix(u.sample->covariance)}};
  return out.dump(2);
}

}  // namespace lagroid::app
