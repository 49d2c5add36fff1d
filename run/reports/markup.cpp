#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/text.hpp>

#include <boost/algorithm/string/replace.hpp>
#include <nlohmann/json.hpp>

namespace lagroid {

std::string in_html(std::string_view text) {
  std::string out;
  for (const char c : visible(text)) switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string in_markdown(std::string_view text) {
  constexpr std::string_view means_something = "\\`*_[]<>&|~#$";
  std::string out;
  for (const char c : visible(text)) {
    if (means_something.find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string in_csv(std::string_view text) {
  std::string out = visible(text);
  if (out.find_first_of(",\"") == std::string::npos) return out;
  boost::replace_all(out, "\"", "\"\"");
  return '"' + out + '"';
}

std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string in_script(const nlohmann::ordered_json& json) {
  std::string out = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  boost::replace_all(out, "<", "\\u003c");
  return out;
}

}  // namespace lagroid
