#include <lagroid/run/expressions/muparser_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numeric>

namespace lagroid::detail {

namespace {

bool in_a_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

std::string word_of(std::size_t i) { return fmt::format("column_{}_", i); }

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

int read_number(const char* text, double& value) {
  if (std::isdigit(static_cast<unsigned char>(*text)) == 0 && *text != '.') return 0;
#ifdef __cpp_lib_to_chars
  const auto read = std::from_chars(text, text + std::strlen(text), value);
  return read.ec == std::errc() ? int(read.ptr - text) : 0;
#else
  // A browser's library has no from_chars of numbers with a point, and one locale.
  char* end = nullptr;
  value = std::strtod(text, &end);
  return std::isfinite(value) ? int(end - text) : 0;
#endif
}

}  // namespace lagroid::detail
