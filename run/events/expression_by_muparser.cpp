#include <lagroid/run/events/expression.hpp>

#include <fmt/format.h>
#include <muParser.h>
#include <boost/algorithm/string/replace.hpp>

#include <algorithm>
#include <cctype>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string_view>

namespace lagroid::detail {

namespace {

bool in_a_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The name under which muparser, whose names are words, knows the i-th.
std::string word_of(std::size_t i) { return fmt::format("column_{}_", i); }

/// The text with words in place of the names, of which the longest that fits is meant.
std::string in_words(const std::string& text, const std::vector<std::string>& names) {
  std::vector<std::size_t> longest_first(names.size());
  std::iota(longest_first.begin(), longest_first.end(), std::size_t(0));
  std::stable_sort(longest_first.begin(), longest_first.end(),
                   [&](std::size_t a, std::size_t b) { return names[a].size() > names[b].size(); });
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto fits = [&](std::size_t i) {
      const std::size_t end = at + names[i].size();
      const bool begins = at == 0 || !in_a_word(text[at - 1]) || !in_a_word(names[i].front());
      return begins && text.compare(at, names[i].size(), names[i]) == 0 &&
             (end == text.size() || !in_a_word(text[end]) || !in_a_word(names[i].back()));
    };
    const auto found = std::find_if(longest_first.begin(), longest_first.end(), fits);
    if (found == longest_first.end()) {
      out += text[at++];
    } else {
      out += word_of(*found);
      at += names[*found].size();
    }
  }
  return out;
}

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
  MuParserExpression(const std::string& text, const std::vector<std::string>& names, const double* values) {
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

 private:
  mu::Parser parser_;
  std::vector<std::size_t> used_;
};

}  // namespace

std::unique_ptr<Expression> parse_any_expression(const std::string& text, const std::vector<std::string>& names,
                                                 const double* values) {
  return std::make_unique<MuParserExpression>(text, names, values);
}

}  // namespace lagroid::detail
