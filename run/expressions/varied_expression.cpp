#include <lagroid/run/expressions/varied_expression.hpp>

namespace lagroid {

VariedExpression::VariedExpression(const std::string& text, const std::vector<std::string>& names)
    : values_(names.size()),
      expression_(parse_expression(text, names, values_.data())),
      used_(expression_->used()),
      by_(used_.size()) {}

VariedNumber VariedExpression::operator()(const VariedVector& numbers) {
  for (const std::size_t i : used_) values_[i] = numbers(Eigen::Index(i)).value;
  VariedNumber out(expression_->differentiate(by_.data()));
  for (std::size_t k = 0; k < used_.size(); ++k) {
    const VariedNumber& x = numbers(Eigen::Index(used_[k]));
    out = out + (x - VariedNumber(x.value)) * by_[k];
  }
  return out;
}

}  // namespace lagroid
