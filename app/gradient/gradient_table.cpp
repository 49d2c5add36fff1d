#include "gradient_table.hpp"

#include "../reading/messages.hpp"
#include "boundary/boundary_cost.hpp"
#include "checks/differences.hpp"
#include "checks/run_growth.hpp"
#include "columns/table_lines.hpp"
#include "event_gradient.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace lagroid::app {

namespace {

/// A word of the command line: where, and what there.
struct Asked {
  std::string place;  ///< final, node.10, integral; initial or parameters
  std::string name;
};
constexpr const char* places_of_rows = "final.NAME, node.K.NAME or integral.NAME";

std::optional<Asked> split_after(const std::string& word, const std::string& place) {
  if (word == place) return Asked{place, ""};
  if (!word.starts_with(place + ".")) return std::nullopt;
  return Asked{place, word.substr(place.size() + 1)};
}

Asked row_of(const std::string& word, long steps) {
  for (const char* place : {"final", "integral"})
    if (const auto asked = split_after(word, place)) return *asked;
  if (word.starts_with("node.")) {
    const std::size_t dot = word.find('.', 5);
    const std::string number = word.substr(5, dot - 5);
    long node = -1;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), node);
    if (read.ec != std::errc() || read.ptr != number.data() + number.size() || node < 0 || node > steps)
      throw GradientRefused(fmt::format("{}: a node is a number from 0 to {}", word, steps));
    return {word.substr(0, dot), dot == std::string::npos ? "" : word.substr(dot + 1)};
  }
  throw GradientRefused(fmt::format("{}: ask for {}", word, places_of_rows));
}

Observed observed_at(const std::string& place) {
  if (place == "final") return Observed::at_end();
  if (place == "integral") return Observed::integral();
  return Observed::at_node(std::stol(place.substr(5)));
}

/// final, node.10, integral of a row.
std::string place_of(const std::string& row) { return row.substr(0, row.find('.', row.starts_with("node.") ? 5 : 0)); }

/// Whether a name is that of a number, of a group of it or of a vector with it; all have none.
bool chooses(const std::string& name, const GradientName& each) {
  if (name.empty()) return !each.only_by_name;
  return each.group == name || each.name == name || each.name.starts_with(name + ".");
}

/// Those with a derivative of what a word chooses at a place; the others are left out, unless it chooses nothing else.
std::vector<int> chosen_with_derivatives(const GradientSubject& subject, const std::vector<GradientName>& all,
                                         const std::string& word, const Asked& asked, std::vector<int>& left_out) {
  std::vector<int> out, refused;
  std::vector<char> is_refused(all.size(), 0);
  for (int i = 0; i < int(subject.refused.size()); ++i) {
    const auto of = split_after(subject.refused[std::size_t(i)].first, asked.place);
    if (!of) continue;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const GradientName& each) { return each.name == of->name; });
    if (found != all.end()) is_refused[std::size_t(found - all.begin())] = 1;
    if (chooses(asked.name, found != all.end() ? *found : GradientName{asked.place, of->name})) refused.push_back(i);
  }
  if (refused.empty()) return chosen_names(all, word, asked.name);
  for (int i = 0; i < int(all.size()); ++i)
    if (is_refused[std::size_t(i)] == 0 && chooses(asked.name, all[std::size_t(i)])) out.push_back(i);
  const auto& [first, why] = subject.refused[std::size_t(refused.front())];
  if (out.empty() && !asked.name.empty()) throw GradientRefused(fmt::format("{}: {}", first, why));
  for (const int each : refused)
    if (std::find(left_out.begin(), left_out.end(), each) == left_out.end()) left_out.push_back(each);
  return out;
}

/// In its own order.
bool has_whole_start(const GradientSubject& subject, const GradientColumns& columns) {
  for (std::size_t i = 0; i < columns.start.size(); ++i)
    if (columns.start[i] != int(i)) return false;
  return columns.start.size() == subject.start.size();
}

/// Functions at a place, by all columns, in the direction that costs less; and the growth of errors on the way there.
struct AtPlace {
  Propagated found;
  double growth = 1;
};
AtPlace propagated(const GradientSubject& subject, const GradientColumns& columns, const RunGrowth& growth,
                   const Observed& observed, std::size_t rows, StateBudget budget) {
  const auto motion = subject.begin(names_of(subject, columns), {});
  const Eigen::MatrixXd asked = directions_of(subject, columns, {}, motion->states());
  const Eigen::MatrixXd along = growth.directions(motion->states(), columns.parameters);
  AtPlace out;
  Eigen::MatrixXd errors;
  if (budget.states == 0 && 4 * rows >= std::size_t(asked.cols())) {
    // Errors of the start are combinations of its columns, where all are asked for.
    const auto whole = Eigen::Index(subject.start.size());
    const bool has_whole = has_whole_start(subject, columns);
    Eigen::MatrixXd directions(asked.rows(), asked.cols() + (has_whole ? 0 : along.cols()));
    directions << asked, along.leftCols(directions.cols() - asked.cols());
    out.found = propagate_forward(*motion, subject.steps, directions, observed);
    if (!out.found.converged()) return out;
    const Eigen::MatrixXd& found = out.found.derivatives;
    if (has_whole)
      errors = found.leftCols(whole) * growth.along();
    else
      errors = found.rightCols(along.cols());
    out.found.derivatives = found.leftCols(asked.cols()).eval();
  } else {
    out.found = propagate_backward(*motion, subject.steps, observed, budget);
    if (!out.found.converged()) return out;
    errors = out.found.derivatives * along;
    out.found.derivatives = (out.found.derivatives * asked).eval();
  }
  out.growth = growth.factor(errors);
  return out;
}

/// Ends a table with a number that is none; a function is without derivative there, or has no value.
void fail_where_not_finite(GradientTable& table) {
  for (Eigen::Index i = 0; i < table.values.size() && table.failure.empty(); ++i) {
    const std::string& row = table.rows[std::size_t(i)];
    if (!std::isfinite(table.values(i)))
      table.failure =
          fmt::format("{} is no finite number; leave it out, or take a function that has a value there", row);
    for (Eigen::Index j = 0; j < table.derivatives.cols() && table.failure.empty(); ++j)
      if (!std::isfinite(table.derivatives(i, j)))
        table.failure =
            fmt::format("{} has no finite derivative by {}; leave one of them out", row, table.columns[std::size_t(j)]);
  }
}

/// A reason without the name of its number and without what it says in parentheses, as the numbers of one case.
std::string kind_of_reason(std::string why, const std::string& number) {
  const std::string name = number.substr(number.find('.') + 1);
  const auto is_part_of_word = [&](std::size_t at) {
    return at < why.size() && (std::isalnum(static_cast<unsigned char>(why[at])) != 0 || why[at] == '_');
  };
  for (std::size_t at = 0; (at = why.find(name, at)) != std::string::npos;)
    if ((at > 0 && is_part_of_word(at - 1)) || is_part_of_word(at + name.size())) {
      ++at;
    } else {
      why.erase(at, name.size());
    }
  if (const std::size_t open = why.find('('), close = why.rfind(')'); open < close && close != std::string::npos)
    why.erase(open, close - open + 1);
  return why;
}

}  // namespace

std::vector<int> chosen_names(const std::vector<GradientName>& all, const std::string& word, const std::string& name) {
  std::vector<int> out;
  // Its own name comes before that of a group.
  const bool is_one = std::any_of(all.begin(), all.end(), [&](const GradientName& each) { return each.name == name; });
  for (int i = 0; i < int(all.size()); ++i) {
    const GradientName& each = all[std::size_t(i)];
    if (is_one ? each.name == name : chooses(name, each)) out.push_back(i);
  }
  if (!out.empty()) return out;
  std::vector<std::string> names;
  for (const GradientName& each : all)
    for (const std::string& one : {each.group, each.name})
      if (std::find(names.begin(), names.end(), one) == names.end()) names.push_back(one);
  const std::string guess = nearest(name, names);
  constexpr std::size_t many = 40;
  const std::size_t more = names.size() - std::min(many, names.size());
  names.resize(names.size() - more);
  throw GradientRefused(fmt::format("{}: nothing of that name is differentiable here{}; there are {}{}", word,
                                    guess.empty() ? "" : fmt::format("; did you mean \"{}\"?", guess),
                                    fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
}

std::vector<int> chosen_rows(const GradientSubject& subject, const std::string& word, const std::string& name) {
  const auto is_asked = [&](const GradientName& each) { return chooses(name, each); };
  if (std::none_of(subject.observed.begin(), subject.observed.end(), is_asked))
    for (const auto& [each, why] : subject.unobserved)
      if (is_asked(each)) throw GradientRefused(fmt::format("{}: no derivative of {}: {}", word, each.name, why));
  return chosen_names(subject.observed, word, name);
}

std::vector<std::string> names_of(const GradientSubject& subject, const GradientColumns& columns) {
  std::vector<std::string> out;
  for (const int i : columns.parameters) out.push_back(subject.parameters[std::size_t(i)].name);
  return out;
}

Eigen::MatrixXd directions_of(const GradientSubject& subject, const GradientColumns& columns,
                              const std::vector<Nudge>& nudges, Eigen::Index states) {
  const auto from_start = Eigen::Index(columns.start.size()), by_parameters = Eigen::Index(columns.parameters.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(states + by_parameters, from_start + by_parameters);
  out.bottomRightCorner(by_parameters, by_parameters).setIdentity();
  if (!subject.begun_by) {
    for (Eigen::Index j = 0; j < from_start; ++j) out(columns.start[std::size_t(j)], j) = 1;
    return out;
  }
  const Eigen::MatrixXd begun = subject.begun_by(names_of(subject, columns), nudges);
  for (Eigen::Index j = 0; j < from_start; ++j)
    out.col(j).head(begun.rows()) = begun.col(columns.start[std::size_t(j)]);
  out.topRightCorner(begun.rows(), by_parameters) = begun.rightCols(by_parameters);
  return out;
}

/// What a start is called, and both ends.
static const char* word_of_start(const GradientSubject& subject) { return subject.cost ? "boundary" : "initial"; }

GradientTable table_of(const GradientSubject& subject, const std::vector<std::string>& by, bool check) {
  GradientTable out;
  out.system = subject.system;
  out.steps = subject.steps;
  out.checked = check;
  const GradientColumns columns = columns_of(subject, by);
  for (const int i : columns.start)
    out.columns.push_back(fmt::format("{}.{}", word_of_start(subject), subject.start[std::size_t(i)].name));
  for (const std::string& name : names_of(subject, columns)) out.columns.push_back("parameters." + name);
  out.notes = notes_on_left_out(subject, columns);
  return out;
}

double digits_left_by(double growth) {
  Propagated propagated;
  propagated.growth = growth;
  return propagated.digits_left();
}

void set_growth(GradientTable& table, double growth) {
  table.growth = std::max(1.0, growth);
  table.digits_left = digits_left_by(table.growth);
}

GradientColumns columns_of(const GradientSubject& subject, const std::vector<std::string>& words) {
  GradientColumns out;
  for (const std::string& word : words) {
    std::vector<int>* into = nullptr;
    std::vector<int> more;
    if (const auto of_start = split_after(word, word_of_start(subject))) {
      into = &out.start;
      more = chosen_with_derivatives(subject, subject.start, word, *of_start, out.left_out);
    } else if (const auto of_system = split_after(word, "parameters")) {
      into = &out.parameters;
      more = chosen_with_derivatives(subject, subject.parameters, word, *of_system, out.left_out);
    } else {
      throw GradientRefused(
          fmt::format("{}: derivatives are by {}.NAME or parameters.NAME", word, word_of_start(subject)));
    }
    for (const int each : more)
      if (std::find(into->begin(), into->end(), each) == into->end()) into->push_back(each);
  }
  if (out.start.empty() && out.parameters.empty() && !out.left_out.empty())
    throw GradientRefused(notes_on_left_out(subject, out).front());
  return out;
}

std::vector<std::string> notes_on_left_out(const GradientSubject& subject, const GradientColumns& columns) {
  struct Reason {
    std::string kind, why;
    std::vector<std::string> names;
  };
  std::vector<Reason> reasons;
  for (const int i : columns.left_out) {
    const auto& [name, why] = subject.refused[std::size_t(i)];
    const std::string kind = kind_of_reason(why, name);
    auto same = std::find_if(reasons.begin(), reasons.end(), [&](const Reason& each) { return each.kind == kind; });
    if (same == reasons.end()) same = reasons.insert(reasons.end(), {kind, why, {}});
    same->names.push_back(name);
  }
  std::vector<std::string> out;
  for (const Reason& each : reasons)
    out.push_back(each.names.size() == 1 ? fmt::format("{} is left out: {}", each.names.front(), each.why)
                                         : fmt::format("{} are left out; {}: {}", fmt::join(each.names, ", "),
                                                       each.names.front(), each.why));
  return out;
}

void find_refused(GradientSubject& subject,
                  const std::function<void(const std::vector<std::string>& parameters)>& differentiate) {
  const auto why_none = [&](const std::vector<std::string>& parameters) -> std::string {
    try {
      differentiate(parameters);
      return "";
    } catch (const WithoutDerivative& refusal) {
      return refusal.what();
    }
  };
  std::vector<std::string> all;
  for (const GradientName& each : subject.parameters) all.push_back(each.name);
  if (why_none(all).empty()) return;
  for (const std::string& name : all)
    if (std::string why = why_none({name}); !why.empty())
      subject.refused.emplace_back("parameters." + name, std::move(why));
}

void find_refused(GradientSubject& subject) {
  find_refused(subject, [&](const std::vector<std::string>& parameters) {
    const auto motion = subject.begin(parameters, {});
    if (motion->advance().converged()) motion->linearise();
  });
}

std::optional<ValuesBeside> values_of(const GradientSubject& subject, const GradientTable& table,
                                      const std::vector<Nudge>& nudges) try {
  if (subject.through_events) return values_through_events(subject, table, nudges);
  Eigen::VectorXd out(Eigen::Index(table.rows.size()));
  for (std::size_t first = 0; first < table.rows.size();) {
    const std::string place = place_of(table.rows[first]);
    const auto motion = subject.begin({}, nudges);
    const Propagated run =
        propagate_forward(*motion, subject.steps, Eigen::MatrixXd::Zero(motion->states(), 0), observed_at(place));
    if (!run.converged()) return std::nullopt;
    for (; first < table.rows.size() && place_of(table.rows[first]) == place; ++first)
      out(Eigen::Index(first)) = run.values(table.observed[first]);
  }
  return ValuesBeside{out};
} catch (const std::domain_error&) {  // of numbers that a system cannot have
  return std::nullopt;
}

GradientTable differentiate(const GradientSubject& subject, const std::vector<std::string>& of,
                            const std::vector<std::string>& by, bool check, StateBudget budget) {
  if (budget.states > 0 && (subject.through_events || subject.cost))
    throw GradientRefused("--states: there is no way back through events, and none of a boundary value");
  if (subject.through_events) return differentiate_through_events(subject, of, by, check);
  if (subject.cost) return differentiate_cost(subject, of, by, check);
  GradientTable out = table_of(subject, by, check);
  const GradientColumns columns = columns_of(subject, by);
  std::vector<std::pair<std::string, std::vector<int>>> places;
  for (const std::string& word : of) {
    const Asked asked = row_of(word, subject.steps);
    const std::vector<int> rows = chosen_rows(subject, word, asked.name);
    auto place =
        std::find_if(places.begin(), places.end(), [&](const auto& each) { return each.first == asked.place; });
    if (place == places.end()) place = places.insert(places.end(), {asked.place, {}});
    for (const int row : rows)
      if (std::find(place->second.begin(), place->second.end(), row) == place->second.end())
        place->second.push_back(row);
  }
  std::size_t count = 0;
  for (const auto& [place, rows] : places) count += rows.size();
  const auto width = Eigen::Index(out.columns.size());
  out.values.resize(Eigen::Index(count));
  out.derivatives.resize(Eigen::Index(count), width);
  const RunGrowth growth(subject, sizes_of_run(subject));
  for (const auto& [place, rows] : places) {
    const auto [found, grew] = propagated(subject, columns, growth, observed_at(place), rows.size(), budget);
    out.steps_solved += found.steps_solved;
    out.states_kept = std::max(out.states_kept, found.states_kept);
    if (!found.converged()) {
      out.failure = found.message;
      return out;
    }
    set_growth(out, std::max(out.growth, grew));
    for (const int row : rows) {
      const auto at = Eigen::Index(out.rows.size());
      out.rows.push_back(place + "." + subject.observed[std::size_t(row)].name);
      out.observed.push_back(row);
      out.values(at) = found.values(row);
      out.derivatives.row(at) = found.derivatives.row(row);
    }
  }
  if (subject.tolerance > 0)
    out.digits_left = std::clamp(-std::log10(subject.tolerance * out.growth), 0.0, out.digits_left);
  fail_where_not_finite(out);
  if (check && out.failure.empty())
    compare_with_differences(subject, columns, out,
                             [&](const std::vector<Nudge>& nudges) -> std::optional<Eigen::VectorXd> {
                               const auto found = values_of(subject, out, nudges);
                               return found ? std::optional(found->values) : std::nullopt;
                             },
                             {.sizes = growth.sizes(), .growth = out.growth, .tolerance = subject.tolerance});
  return out;
}

}  // namespace lagroid::app
