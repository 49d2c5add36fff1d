#include <lagroid/run/expressions/differentiated_by_muparser.hpp>
#include <lagroid/run/expressions/muparser_text.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lagroid::detail {

namespace {

using Number = DifferentiatedByMuParser::Number;

/// Those of the expression that is evaluated: muparser's operations are told nothing but their arguments.
thread_local std::vector<Number>* numbers = nullptr;

const Number& at(double handle) { return (*numbers)[std::size_t(handle)]; }
double keep(Number number) {
  numbers->push_back(std::move(number));
  return double(numbers->size() - 1);
}
double constant(double value) { return keep({value, Eigen::VectorXd::Zero(at(0).by.size())}); }
/// What a comparison gives: the numbers zero and one have these places, and a condition asks for no more.
double truth(bool holds) { return holds ? 1 : 0; }

/// A slope times derivatives; where nothing varies none is asked for.
Eigen::VectorXd along(double slope, const Eigen::VectorXd& by) {
  return by.isZero(0) ? by : Eigen::VectorXd(slope * by);
}
double chain(double x, double f, double slope) { return keep({f, along(slope, at(x).by)}); }
double chain(double x, double y, double f, double by_x, double by_y) {
  return keep({f, along(by_x, at(x).by) + along(by_y, at(y).by)});
}

bool is_less(double x, double y) { return at(x).value < at(y).value; }

/// The one that was chosen among these; without a derivative where another is as large and goes another way.
double unless_kinked(double chosen, const double* x, int count) {
  for (int i = 0; i < count; ++i)
    if (at(x[i]).value == at(chosen).value && at(x[i]).by != at(chosen).by)
      return keep({at(chosen).value, along(std::nan(""), at(x[i]).by - at(chosen).by)});
  return chosen;
}

double add(double x, double y) { return chain(x, y, at(x).value + at(y).value, 1, 1); }
double subtract(double x, double y) { return chain(x, y, at(x).value - at(y).value, 1, -1); }
double multiply(double x, double y) {
  const double a = at(x).value, b = at(y).value;
  return chain(x, y, a * b, b, a);
}
double divide(double x, double y) {
  const double a = at(x).value, b = at(y).value;
  return chain(x, y, a / b, 1 / b, -a / (b * b));
}
double power(double x, double y) {
  const double a = at(x).value, b = at(y).value, f = std::pow(a, b);
  return chain(x, y, f, b == 0 ? 0 : b * std::pow(a, b - 1), f * std::log(a));
}

void define_operations(mu::Parser& parser) {
  using mu::oaLEFT;
  using mu::oaRIGHT;
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearInfixOprt();
  parser.EnableBuiltInOprt(false);
  parser.EnableOptimizer(false);  // which knows numbers, not their places
  parser.DefineInfixOprt("-", [](double x) { return chain(x, -at(x).value, -1); });
  parser.DefineInfixOprt("+", [](double x) { return x; });
  parser.DefineOprt("+", add, mu::prADD_SUB, oaLEFT);
  parser.DefineOprt("-", subtract, mu::prADD_SUB, oaLEFT);
  parser.DefineOprt("*", multiply, mu::prMUL_DIV, oaLEFT);
  parser.DefineOprt("/", divide, mu::prMUL_DIV, oaLEFT);
  parser.DefineOprt("^", power, mu::prPOW, oaRIGHT);
  const auto compare = [&](const char* sign, mu::fun_type2 holds) {
    parser.DefineOprt(sign, holds, mu::prCMP, oaLEFT);
  };
  compare("<", [](double x, double y) { return truth(is_less(x, y)); });
  compare(">", [](double x, double y) { return truth(is_less(y, x)); });
  compare("<=", [](double x, double y) { return truth(at(x).value <= at(y).value); });
  compare(">=", [](double x, double y) { return truth(at(x).value >= at(y).value); });
  compare("==", [](double x, double y) { return truth(at(x).value == at(y).value); });
  compare("!=", [](double x, double y) { return truth(at(x).value != at(y).value); });
  const auto join = [&](const char* sign, mu::fun_type2 holds, int precedence) {
    parser.DefineOprt(sign, holds, unsigned(precedence), oaLEFT);
  };
  join(
      "&&", [](double x, double y) { return truth(at(x).value != 0 && at(y).value != 0); }, mu::prLAND);
  join(
      "||", [](double x, double y) { return truth(at(x).value != 0 || at(y).value != 0); }, mu::prLOR);
}

void define_functions(mu::Parser& parser) {
  const auto define = [&](const char* name, mu::fun_type1 f) { parser.DefineFun(name, f); };
  const auto logarithm = [](double x) { return chain(x, std::log(at(x).value), 1 / at(x).value); };
  define("sin", [](double x) { return chain(x, std::sin(at(x).value), std::cos(at(x).value)); });
  define("cos", [](double x) { return chain(x, std::cos(at(x).value), -std::sin(at(x).value)); });
  define("tan", [](double x) {
    const double f = std::tan(at(x).value);
    return chain(x, f, 1 + f * f);
  });
  define("asin", [](double x) {
    const double a = at(x).value;
    return chain(x, std::asin(a), 1 / std::sqrt((1 - a) * (1 + a)));
  });
  define("acos", [](double x) {
    const double a = at(x).value;
    return chain(x, std::acos(a), -1 / std::sqrt((1 - a) * (1 + a)));
  });
  define("atan", [](double x) {
    const double a = at(x).value;
    return chain(x, std::atan(a), 1 / (1 + a * a));
  });
  define("sinh", [](double x) { return chain(x, std::sinh(at(x).value), std::cosh(at(x).value)); });
  define("cosh", [](double x) { return chain(x, std::cosh(at(x).value), std::sinh(at(x).value)); });
  define("tanh", [](double x) {
    const double f = std::tanh(at(x).value);
    return chain(x, f, (1 - f) * (1 + f));
  });
  define("asinh", [](double x) {
    const double a = at(x).value;
    return chain(x, std::asinh(a), 1 / std::hypot(1, a));
  });
  define("acosh", [](double x) {
    const double a = at(x).value;
    return chain(x, std::acosh(a), 1 / std::sqrt((a - 1) * (a + 1)));
  });
  define("atanh", [](double x) {
    const double a = at(x).value;
    return chain(x, std::atanh(a), 1 / ((1 - a) * (1 + a)));
  });
  define("exp", [](double x) {
    const double f = std::exp(at(x).value);
    return chain(x, f, f);
  });
  define("ln", logarithm);
  define("log", logarithm);
  define("log2", [](double x) {
    const double a = at(x).value;
    return chain(x, std::log2(a), 1 / (a * std::numbers::ln2));
  });
  define("log10", [](double x) {
    const double a = at(x).value;
    return chain(x, std::log10(a), 1 / (a * std::numbers::ln10));
  });
  define("sqrt", [](double x) {
    const double f = std::sqrt(at(x).value);
    return chain(x, f, 0.5 / f);
  });
  define("abs", [](double x) {
    const double a = at(x).value;
    return chain(x, std::abs(a), a == 0 ? std::nan("") : std::copysign(1.0, a));
  });
  define("sign", [](double x) {
    const double a = at(x).value;
    return a == 0 ? chain(x, 0, std::nan("")) : constant(double(a > 0) - double(a < 0));
  });
  define("rint", [](double x) { return constant(std::floor(at(x).value + 0.5)); });
  parser.DefineFun("atan2", [](double y, double x) {
    const double a = at(y).value, b = at(x).value, square = a * a + b * b;
    return chain(y, x, std::atan2(a, b), b / square, -a / square);
  });
  parser.DefineFun("sum", [](const double* x, int count) {
    double all = x[0];
    for (int i = 1; i < count; ++i) all = add(all, x[i]);
    return all;
  });
  parser.DefineFun("avg", [](const double* x, int count) {
    double all = x[0];
    for (int i = 1; i < count; ++i) all = add(all, x[i]);
    return divide(all, constant(count));
  });
  parser.DefineFun("min", [](const double* x, int count) {
    return unless_kinked(*std::min_element(x, x + count, is_less), x, count);
  });
  parser.DefineFun("max", [](const double* x, int count) {
    return unless_kinked(*std::max_element(x, x + count, is_less), x, count);
  });
}

/// A number of the text, which is kept.
int read_constant(const char* text, int* position, double* handle) {
  double value = 0;
  const int length = detail::read_number(text, value);
  if (length == 0) return 0;
  *position += length;
  *handle = constant(value);
  return 1;
}

}  // namespace

DifferentiatedByMuParser::DifferentiatedByMuParser(const std::string& text, const std::vector<std::string>& names,
                                                   const std::vector<std::size_t>& used, const double* values)
    : used_(used), values_(values), handles_(used.size()) {
  const auto count = Eigen::Index(used.size());
  for (const double value : {0.0, 1.0}) numbers_.push_back({value, Eigen::VectorXd::Zero(count)});
  for (std::size_t i = 0; i < used.size(); ++i) {
    handles_[i] = double(numbers_.size());
    numbers_.push_back({values[used[i]], Eigen::VectorXd::Unit(count, Eigen::Index(i))});
  }
  numbers = &numbers_;
  define_operations(parser_);
  define_functions(parser_);
  parser_.AddValIdent(read_constant);
  for (const auto& [name, value] :
       {std::pair("pi", std::numbers::pi), std::pair("_pi", std::numbers::pi), std::pair("_e", std::numbers::e)})
    parser_.DefineConst(name, constant(value));
  for (std::size_t i = 0; i < used.size(); ++i) parser_.DefineVar(word_of(used[i]), &handles_[i]);
  parser_.SetExpr(in_words(text, names));
  evaluate();  // reads the text: its numbers are kept from now on
  kept_ = numbers_.size();
}

double DifferentiatedByMuParser::evaluate() {
  numbers = &numbers_;
  return parser_.Eval();
}

double DifferentiatedByMuParser::differentiate(double* by) {
  numbers_.resize(kept_);
  for (std::size_t i = 0; i < used_.size(); ++i) numbers_[2 + i].value = values_[used_[i]];
  const Number& result = numbers_[std::size_t(evaluate())];
  std::copy(result.by.begin(), result.by.end(), by);
  largest_ = 0;
  for (const Number& each : numbers_) largest_ = std::max(largest_, std::abs(each.value));
  return result.value;
}

}  // namespace lagroid::detail
