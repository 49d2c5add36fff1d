#include <lagroid/run/expressions/differentiated_by_muparser.hpp>
#include <lagroid/run/expressions/expression.hpp>
#include <lagroid/run/expressions/muparser_text.hpp>

#include <fmt/format.h>
#include <muParser.h>
#include <boost/algorithm/string/replace.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string_view>

namespace lagroid::detail {

namespace {

/// Whether one of its signs "=" is no part of a comparison.
bool assigns(const std::string& text) {
  const auto is_one_of = [&](std::size_t at, const char* signs) {
    return at < text.size() && std::string_view(signs).find(text[at]) != std::string_view::npos;
  };
  for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1))
    if (!is_one_of(at + 1, "=") && (at == 0 || !is_one_of(at - 1, "=<>!"))) return true;
  return false;
}

class MuParserExpression final : public Expression {
 public:
  MuParserExpression(const std::string& text, const std::vector<std::string>& names, const double* values)
      : text_(text), names_(names), values_(values) {
    if (assigns(text)) throw std::invalid_argument("\"=\" sets nothing here: write what is to be zero");
    try {
      parser_.DefineConst("pi", std::numbers::pi);
      // Nothing is written there: expressions that set something are refused above.
      for (std::size_t i = 0; i < names.size(); ++i) parser_.DefineVar(word_of(i), const_cast<double*>(values + i));
      parser_.SetExpr(in_words(text, names));
      mu::varmap_type words = parser_.GetUsedVar();
      for (std::size_t i = 0; i < names.size(); ++i)
        if (words.erase(word_of(i)) > 0) used_.push_back(i);
      if (!words.empty()) throw std::invalid_argument(fmt::format("there is no \"{}\"", words.begin()->first));
      parser_.Eval();
      if (parser_.GetNumResults() != 1) throw std::invalid_argument("it has several values");
    } catch (const mu::Parser::exception_type& error) {
      std::string message = error.GetMsg();
      for (std::size_t i = 0; i < names.size(); ++i) boost::algorithm::replace_all(message, word_of(i), names[i]);
      throw std::invalid_argument(message);
    }
  }
  double value() const override { return parser_.Eval(); }
  std::vector<std::size_t> used() const override { return used_; }
  double differentiate(double* by) override {
    if (!differentiated_) differentiated_ = std::make_unique<DifferentiatedByMuParser>(text_, names_, used_, values_);
    const double here = value();
    const double again = differentiated_->differentiate(by);
    // A condition that is a number, not a comparison, is judged by muparser itself and may be judged otherwise there.
    if (!(std::abs(again - here) <= 1e-9 * differentiated_->largest())) std::fill_n(by, used_.size(), std::nan(""));
    return here;
  }

 private:
  mu::Parser parser_;
  std::vector<std::size_t> used_;
  std::string text_;
  std::vector<std::string> names_;
  const double* values_;
  std::unique_ptr<DifferentiatedByMuParser> differentiated_;  ///< once derivatives are asked for
};

}  // namespace

std::unique_ptr<Expression> parse_any_expression(const std::string& text, const std::vector<std::string>& names,
                                                 const double* values) {
  return std::make_unique<MuParserExpression>(text, names, values);
}

}  // namespace lagroid::detail
