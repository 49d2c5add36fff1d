#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <boost/locale/utf.hpp>

#include <algorithm>
#include <functional>
#include <iterator>

namespace lagroid {

namespace {

namespace utf = boost::locale::utf;

bool in(utf::code_point c, utf::code_point first, utf::code_point last) { return first <= c && c <= last; }

bool is_refused(utf::code_point c) {
  const bool control = c < 0x20 || in(c, 0x7f, 0x9f);
  const bool ends_line = in(c, 0x2028, 0x2029);
  const bool turns = c == 0x61c || in(c, 0x200e, 0x200f) || in(c, 0x202a, 0x202e) || in(c, 0x2066, 0x2069);
  return control || ends_line || turns;
}

bool is_character(utf::code_point c) { return c != utf::illegal && c != utf::incomplete; }

std::string escape_of(utf::code_point c) { return fmt::format("\\u{:04x}", c); }

/// Calls `see` with each character and the bytes that it has; a byte that is none of UTF-8 is `utf::illegal`.
void for_each_character(std::string_view text,
                        const std::function<void(utf::code_point, std::string_view bytes)>& see) {
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    const char* next = at;
    const utf::code_point c = utf::utf_traits<char>::decode(next, end);
    if (!is_character(c)) next = at + 1;
    see(is_character(c) ? c : utf::illegal, {at, std::size_t(next - at)});
    at = next;
  }
}

}  // namespace

std::string text_problem(std::string_view text) {
  if (text.size() > longest_text)
    return fmt::format("a text of {} bytes, where {} are the most; shorten it", text.size(), longest_text);
  std::string problem;
  for_each_character(text, [&](utf::code_point c, std::string_view) {
    if (!problem.empty()) return;
    if (c == utf::illegal)
      problem = "a text that is not UTF-8; write it in UTF-8";
    else if (is_refused(c))
      problem = fmt::format("a text with the control character {} in it; leave it out", escape_of(c));
  });
  return problem;
}

std::string key_problem(std::string_view key) {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (const std::string problem = text_problem(key); !problem.empty()) return problem;
  if (!key.empty() && key.find_first_not_of(allowed) == std::string_view::npos) return "";
  return "no key: keys are of letters, digits, - and _, without quotes; those of a table stand below its [name]";
}

std::string visible(std::string_view text, std::string_view kept) {
  std::string out;
  out.reserve(text.size());
  for_each_character(text, [&](utf::code_point c, std::string_view bytes) {
    if (c == utf::illegal)
      out += "\xEF\xBF\xBD";
    else if (is_refused(c) && kept.find(bytes) == std::string_view::npos)
      out += escape_of(c);
    else
      out += bytes;
  });
  return out;
}

}  // namespace lagroid
