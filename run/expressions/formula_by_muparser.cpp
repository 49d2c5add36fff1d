// Texts as formula graphs: muparser is given operations that make nodes of nodes, in place of numbers of numbers.
#include <lagroid/run/expressions/formula_graph.hpp>
#include <lagroid/run/expressions/muparser_text.hpp>

#include <fmt/format.h>
#include <muParser.h>
#include <boost/algorithm/string/replace.hpp>

#include <cctype>
#include <numbers>
#include <regex>
#include <stdexcept>

namespace lagroid {

namespace {

using enum FormulaOperation;

/// That of the formula that is read: muparser's operations are told nothing but their arguments.
thread_local FormulaGraph* graph = nullptr;

template <FormulaOperation kind> double of_one(double a) { return double(graph->apply(kind, std::size_t(a))); }
template <FormulaOperation kind> double of_two(double a, double b) {
  return double(graph->apply(kind, std::size_t(a), std::size_t(b)));
}

int read_constant(const char* text, int* position, double* node) {
  double value = 0;
  const int length = detail::read_number(text, value);
  if (length == 0) return 0;
  *position += length;
  *node = double(graph->constant(value));
  return 1;
}

void define(mu::Parser& parser) {
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearInfixOprt();
  parser.EnableBuiltInOprt(false);
  parser.EnableOptimizer(false);
  parser.DefineInfixOprt("-", of_one<negate>);
  parser.DefineInfixOprt("+", [](double a) { return a; });
  parser.DefineOprt("+", of_two<add>, mu::prADD_SUB, mu::oaLEFT);
  parser.DefineOprt("-", of_two<subtract>, mu::prADD_SUB, mu::oaLEFT);
  parser.DefineOprt("*", of_two<multiply>, mu::prMUL_DIV, mu::oaLEFT);
  parser.DefineOprt("/", of_two<divide>, mu::prMUL_DIV, mu::oaLEFT);
  parser.DefineOprt("^", of_two<power>, mu::prPOW, mu::oaRIGHT);
  parser.DefineFun("sin", of_one<FormulaOperation::sin>);
  parser.DefineFun("cos", of_one<FormulaOperation::cos>);
  parser.DefineFun("tan", of_one<FormulaOperation::tan>);
  parser.DefineFun("asin", of_one<FormulaOperation::asin>);
  parser.DefineFun("acos", of_one<FormulaOperation::acos>);
  parser.DefineFun("atan", of_one<FormulaOperation::atan>);
  parser.DefineFun("sinh", of_one<FormulaOperation::sinh>);
  parser.DefineFun("cosh", of_one<FormulaOperation::cosh>);
  parser.DefineFun("tanh", of_one<FormulaOperation::tanh>);
  parser.DefineFun("asinh", of_one<FormulaOperation::asinh>);
  parser.DefineFun("acosh", of_one<FormulaOperation::acosh>);
  parser.DefineFun("atanh", of_one<FormulaOperation::atanh>);
  parser.DefineFun("exp", of_one<FormulaOperation::exp>);
  parser.DefineFun("ln", of_one<FormulaOperation::log>);
  parser.DefineFun("log", of_one<FormulaOperation::log>);
  parser.DefineFun("sqrt", of_one<FormulaOperation::sqrt>);
  parser.DefineFun("abs", of_one<FormulaOperation::abs>);
  parser.DefineFun("atan2", of_two<FormulaOperation::atan2>);
  parser.AddValIdent(read_constant);
  parser.DefineConst("pi", double(graph->constant(std::numbers::pi)));
}

/// What is wrong with the words of a text: the first that is neither a name nor, before a parenthesis, a function.
std::string unknown_word(const std::string& text, const mu::Parser& parser) {
  const std::regex word_or_number("[A-Za-z_][A-Za-z_0-9]*'*\\s*\\(?|[0-9.]+([eE][-+]?[0-9]+)?");
  for (auto each = std::sregex_iterator(text.begin(), text.end(), word_or_number); each != std::sregex_iterator();
       ++each) {
    std::string word = each->str();
    if (std::isdigit(static_cast<unsigned char>(word.front())) != 0 || word.front() == '.') continue;
    if (each->position() > 0 && std::isdigit(static_cast<unsigned char>(text[std::size_t(each->position()) - 1])) != 0)
      return fmt::format("a number stands before \"{}\" without *", word);
    const bool called = word.back() == '(';
    while (word.back() == '(' || std::isspace(static_cast<unsigned char>(word.back())) != 0) word.pop_back();
    if (called && !parser.GetFunDef().contains(word)) return fmt::format("there is no smooth function \"{}\"", word);
    if (!called && !parser.GetVar().contains(word) && !parser.GetConst().contains(word))
      return fmt::format("there is no \"{}\"", word);
  }
  return {};
}

}  // namespace

FormulaGraph::Node FormulaGraph::read(const std::string& text, const std::vector<std::string>& names) {
  if (std::regex_search(text, std::regex("column_[0-9]+_"))) throw std::invalid_argument("a name in it is reserved");
  for (const char sign : {'?', '<', '>', '=', '&', '|'})
    if (text.find(sign) != std::string::npos)
      throw std::invalid_argument(fmt::format("\"{}\" makes it no smooth function", sign));
  graph = this;
  std::vector<double> nodes(names.size());
  const auto in_names = [&](std::string message) {
    for (std::size_t i = 0; i < names.size(); ++i) boost::algorithm::replace_all(message, detail::word_of(i), names[i]);
    return message;
  };
  try {
    mu::Parser parser;
    define(parser);
    for (std::size_t i = 0; i < names.size(); ++i) {
      nodes[i] = double(variable(i));
      parser.DefineVar(detail::word_of(i), &nodes[i]);
    }
    const std::string words = detail::in_words(text, names);
    if (const std::string unknown = unknown_word(words, parser); !unknown.empty())
      throw std::invalid_argument(in_names(unknown));
    parser.SetExpr(words);
    reading_ = true;
    const double found = parser.Eval();
    reading_ = false;
    if (parser.GetNumResults() != 1) throw std::invalid_argument("it has several values");
    return std::size_t(found);
  } catch (const std::invalid_argument&) {
    reading_ = false;
    throw;
  } catch (const mu::Parser::exception_type& error) {
    reading_ = false;
    // Places are those of another text.
    throw std::invalid_argument(
        in_names(std::regex_replace(error.GetMsg(), std::regex(" at( expression)? position \\d+\\.?"), "")));
  }
}

}  // namespace lagroid
