#pragma once
/// The function of an event at a node, g(t, z), from its text or from C++.
///
/// Columns are read where the function needs them, and no others.
///
///     EventFunction height({.name = "floor", .when = "q2 - 1"}, motion.look());
///     const double above = height(motion.look());
///
/// Requires nodes with the fields and quantities of the first. Returns what the expression has there, which may be no
/// finite number. Errors: std::invalid_argument for a text that is none, with the columns there are.

#include <lagroid/run/events/event.hpp>
#include <lagroid/run/expressions/expression.hpp>
#include <lagroid/run/motion/observables.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

/// What is known at any time of a motion, also inside of steps: fields that belong to nodes and are no drifts.
std::vector<std::size_t> fields_within(const Observables& node);
/// Their columns.
std::vector<std::string> columns_within(const Observables& node);
/// Their numbers, in the same order.
std::vector<double> values_within(const Observables& node);

class EventFunction {
 public:
  EventFunction(const Event& event, const Observables& node);

  double operator()(const Observables& node) {
    if (function_) return function_(node);
    values_[0] = node.time();
    for (const Read& read : fields_) node.read(read.which, values_.data() + read.at);
    for (const Read& read : quantities_) node.measure(read.which, values_.data() + read.at);
    return expression_->value();
  }

 private:
  /// A field or a quantity that it needs, and where its first number goes.
  struct Read {
    std::size_t which;
    std::size_t at;
  };

  std::function<double(const Observables&)> function_;
  std::vector<double> values_;  ///< the time, and all that it could need
  std::vector<Read> fields_;
  std::vector<Read> quantities_;
  std::unique_ptr<Expression> expression_;
};

}  // namespace lagroid
