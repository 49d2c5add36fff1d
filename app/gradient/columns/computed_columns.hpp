#pragma once
/// Columns that are functions of those of a run and of its parameters, with their derivatives:
///
///     const GradientSubject more = with_columns(subject, {{"w1", "M1 / parameters.inertia.0"}});
///
/// Names in a text are columns of the run, earlier ones of these, `t`, and parameters.NAME; a name of its own that is
/// not of the state stands for these from there on. Errors: GradientRefused, one line, for a name that is taken and for
/// a text that is no expression of these.

#include "../gradient_subject.hpp"

#include <lagroid/run/expressions/expression.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

using NamedText = std::pair<std::string, std::string>;

/// A text over numbers that have these names, with its derivatives.
class ComputedNumber {
 public:
  ComputedNumber(const NamedText& text, const std::vector<std::string>& names);

  /// Of as many numbers as there are names; throws std::logic_error for any other count.
  double evaluate(const std::vector<double>& numbers);
  /// Which of them it depends on, and after an evaluation its derivatives by these.
  const std::vector<std::size_t>& used() const { return used_; }
  const std::vector<double>& by() const { return by_; }

 private:
  std::vector<double> numbers_;
  std::unique_ptr<Expression> expression_;
  std::vector<std::size_t> used_;
  std::vector<double> by_;
};

GradientSubject with_columns(const GradientSubject& subject, const std::vector<NamedText>& columns);

/// NAME=EXPRESSION of a command line.
NamedText named_text(const std::string& word);

}  // namespace lagroid::app
