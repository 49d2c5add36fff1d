#include <lagroid/run/expressions/varied_expression.hpp>

namespace lagroid {

VariedExpression::VariedExpression(const std::string& text, const std::vector<std::string>& names)
    : values_(names.size()),
      expression_(parse_expression(text, names, values_.data())),
      used_(expression_->used()),
      by_(used_.size()) {}

VariedNumber VariedExpression::operator()(const VariedVector& numbers) {
  for (const std::size_t i : used_) values_[i] = numbers(Eigen::Index(i)).value;
  const double value = expression_->differentiate(by_.data());
  // The value stays one where there is no derivative.
  VariedNumber::Tangent tangent{};
  for (int i = 0; i < VariedNumber::directions; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < used_.size(); ++k) sum += by_[k] * numbers(Eigen::Index(used_[k])).tangent(i);
    tangent.set(i, sum);
  }
  return {value, tangent};
}

}  // namespace lagroid
