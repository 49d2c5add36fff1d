#include "computed_columns.hpp"

#include "../gradient_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

namespace {

/// A motion that shows more columns, after its own.
class WithColumns final : public LinearisedMotion {
 public:
  /// `places`: of the motion's parameters among all, whose values are `values`; `with_time`: after these the time,
  /// which depends on nothing.
  WithColumns(std::unique_ptr<LinearisedMotion> motion, std::vector<std::shared_ptr<ComputedNumber>> columns,
              std::vector<double> values, std::vector<std::size_t> places, bool with_time)
      : motion_(std::move(motion)),
        columns_(std::move(columns)),
        values_(std::move(values)),
        places_(std::move(places)),
        with_time_(with_time) {}

  int states() const override { return motion_->states(); }
  int parameters() const override { return motion_->parameters(); }
  double time() const override { return motion_->time(); }
  bool has_equal_steps() const override { return motion_->has_equal_steps(); }
  StepReport advance() override { return motion_->advance(); }
  bool linearise() override { return motion_->linearise(); }
  int stages() const override { return motion_->stages(); }
  const StepDerivative& stage(int k) const override { return motion_->stage(k); }
  void serialize(NumberArchive& archive) override { motion_->serialize(archive); }
  StepReport pass() override { return motion_->pass(); }
  void keep_node(std::unique_ptr<KeptNode>& node) override { motion_->keep_node(node); }
  void return_to(const KeptNode& node) override { motion_->return_to(node); }
  bool takes_back() const override { return motion_->takes_back(); }
  bool take_back(const KeptNode& before, const KeptNode& after, Eigen::MatrixXd& gradients) override {
    return motion_->take_back(before, after, gradients);
  }

  NodeValues observe() const override { return completed(motion_->observe(), motion_->time()); }
  Eigen::VectorXd seen() const override {
    const Eigen::VectorXd own = motion_->seen();
    return completed({own, Eigen::MatrixXd(own.size(), 0)}, motion_->time()).values;
  }
  LinearisedMotion& without_columns() { return *motion_; }
  std::optional<NodeValues> observe_later(double time) override {
    const auto own = motion_->observe_later(time);
    if (!own) return std::nullopt;
    return completed(*own, time);
  }

 private:
  NodeValues completed(const NodeValues& own, double time) const {
    const auto count = own.values.size(), more = Eigen::Index(columns_.size());
    NodeValues out{Eigen::VectorXd(count + more), Eigen::MatrixXd::Zero(count + more, own.derivatives.cols())};
    out.values.head(count) = own.values;
    out.derivatives.topRows(count) = own.derivatives;
    std::vector<double> numbers(values_);
    if (with_time_) numbers.push_back(time);
    numbers.insert(numbers.end(), own.values.begin(), own.values.end());
    for (Eigen::Index c = 0; c < more; ++c) {
      ComputedNumber& column = *columns_[std::size_t(c)];
      out.values(count + c) = column.evaluate(numbers);
      for (std::size_t k = 0; k < column.used().size(); ++k) add(out, count + c, column.used()[k], column.by()[k]);
      numbers.push_back(out.values(count + c));
    }
    return out;
  }
  /// The chain rule, of number `used` among parameters, the time and columns.
  void add(NodeValues& out, Eigen::Index row, std::size_t used, double by) const {
    if (out.derivatives.cols() == 0) return;
    const std::size_t first_column = values_.size() + (with_time_ ? 1 : 0);
    if (used >= first_column) {
      out.derivatives.row(row) += by * out.derivatives.row(Eigen::Index(used - first_column));
    } else if (const auto found = std::find(places_.begin(), places_.end(), used); found != places_.end()) {
      out.derivatives(row, states() + (found - places_.begin())) += by;
    }
  }

  std::unique_ptr<LinearisedMotion> motion_;
  std::vector<std::shared_ptr<ComputedNumber>> columns_;
  std::vector<double> values_;
  std::vector<std::size_t> places_;
  bool with_time_;
};

std::size_t place_of(const GradientSubject& subject, const std::string& parameter) {
  const auto found = std::find_if(subject.parameters.begin(), subject.parameters.end(),
                                  [&](const GradientName& each) { return each.name == parameter; });
  return std::size_t(found - subject.parameters.begin());
}

}  // namespace

ComputedNumber::ComputedNumber(const NamedText& text, const std::vector<std::string>& names) try
    : numbers_(names.size()),
      expression_(parse_expression(text.second, names, numbers_.data())),
      used_(expression_->used()),
      by_(used_.size()) {
} catch (const std::invalid_argument& error) {
  throw GradientRefused(
      fmt::format("{}={}: {}; it is of {}", text.first, text.second, error.what(), fmt::join(names, ", ")));
}

double ComputedNumber::evaluate(const std::vector<double>& numbers) {
  if (numbers.size() != numbers_.size())
    throw std::logic_error(fmt::format("an expression of {} numbers is given {}: this is a fault of the program",
                                       numbers_.size(), numbers.size()));
  std::copy(numbers.begin(), numbers.end(), numbers_.begin());  // the expression reads them there
  return expression_->differentiate(by_.data());
}

NamedText named_text(const std::string& word) {
  const std::size_t at = word.find('=');
  if (at == std::string::npos || at == 0 || at + 1 == word.size())
    throw GradientRefused(fmt::format("{}: give NAME=EXPRESSION", word));
  if (word.substr(0, at).find(',') != std::string::npos)
    throw GradientRefused(fmt::format("{}: a comma is none of a name, as names are listed by commas", word));
  return {word.substr(0, at), word.substr(at + 1)};
}

GradientSubject with_columns(const GradientSubject& subject, const std::vector<NamedText>& columns) {
  if (columns.empty()) return subject;
  if (subject.cost || subject.through_events)
    throw GradientRefused("--column is of runs of an initial value without events");
  GradientSubject out = subject;
  std::vector<std::string> names;
  for (const GradientName& each : subject.parameters) names.push_back("parameters." + each.name);
  // Of steps that vary the time is a column.
  const bool with_time = std::none_of(subject.observed.begin(), subject.observed.end(),
                                      [](const GradientName& each) { return each.name == "t"; });
  if (with_time) names.emplace_back("t");
  const auto is_column = [&](const std::string& name) {
    return std::any_of(columns.begin(), columns.end(), [&](const NamedText& each) { return each.first == name; });
  };
  // A column of the user's own stands in the place of one that comes by its name alone.
  for (GradientName& each : out.observed)
    if (each.only_by_name && is_column(each.name))
      each = {"recorded " + each.group, "recorded " + each.name, true, true};
  for (const GradientName& each : out.observed) names.push_back(each.name);
  std::vector<std::shared_ptr<ComputedNumber>> computed;
  for (const NamedText& column : columns) {
    if (std::find(names.begin(), names.end(), column.first) != names.end())
      throw GradientRefused(fmt::format("--column {}: there is one of that name", column.first));
    computed.push_back(std::make_shared<ComputedNumber>(column, names));
    names.push_back(column.first);
    out.observed.push_back({"computed", column.first, true});
  }
  out.begin = [subject, computed, with_time](const std::vector<std::string>& parameters,
                                             const std::vector<Nudge>& nudges) -> std::unique_ptr<LinearisedMotion> {
    std::vector<double> values(subject.sizes.begin() + std::ptrdiff_t(subject.start.size()), subject.sizes.end());
    for (const Nudge& nudge : nudges)
      if (!nudge.parameter.empty()) values[place_of(subject, nudge.parameter)] += nudge.by;
    std::vector<std::size_t> places;
    for (const std::string& name : parameters) places.push_back(place_of(subject, name));
    return std::make_unique<WithColumns>(subject.begin(parameters, nudges), computed, values, places, with_time);
  };
  if (subject.begin_along)
    out.begin_along = [begin_along = subject.begin_along](LinearisedMotion& begun, const Eigen::MatrixXd& directions) {
      begin_along(dynamic_cast<WithColumns&>(begun).without_columns(), directions);
    };
  return out;
}

}  // namespace lagroid::app
