#include <lagroid/run/files/nesting.hpp>

#include <algorithm>
#include <vector>

namespace lagroid {

namespace {

/// Behind the string that begins at `at`, or at its end of line where nothing closes it.
std::size_t behind_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool escapes = quote == '"';
  const std::string_view three = quote == '"' ? R"(""")" : "'''";
  const bool lines = text.substr(at).starts_with(three);
  for (std::size_t i = at + (lines ? 3 : 1); i < text.size(); ++i) {
    if (escapes && text[i] == '\\')
      ++i;
    else if (lines && text.substr(i).starts_with(three))
      return std::min(text.find_first_not_of(quote, i), i + 5);  // two quotes may stand at its end
    else if (!lines && (text[i] == quote || text[i] == '\n'))
      return i + 1;
  }
  return text.size();
}

using Json = nlohmann::json;

/// Goes on as long as the nesting is not too deep.
class Shallow final : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(Json::binary_t&) override { return true; }
  bool start_object(std::size_t) override { return down(); }
  bool key(std::string&) override { return true; }
  bool end_object() override { return up(); }
  bool start_array(std::size_t) override { return down(); }
  bool end_array() override { return up(); }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

 private:
  bool down() { return ++depth_ <= most_nested; }
  bool up() {
    --depth_;
    return true;
  }
  std::size_t depth_ = 0;
};

}  // namespace

bool toml_nests_too_deep(std::string_view text) {
  std::vector<std::size_t> brackets;  // that are open: how deep each goes, with the key before it
  std::size_t depth = 0;              // of all of them
  std::size_t key = 0;                // parts of the key, or of the key of the value, that is being read
  for (std::size_t i = 0; i < text.size();) {
    switch (text[i]) {
      case '"':
      case '\'':
        i = behind_string(text, i);
        continue;
      case '#':
        i = std::min(text.find('\n', i), text.size());
        continue;
      case '.':
        ++key;
        break;
      case '[':
      case '{':
        brackets.push_back(key + 1);
        depth += key + 1;
        key = 0;
        break;
      case ']':
      case '}':
        if (brackets.empty()) break;
        depth -= brackets.back();
        brackets.pop_back();
        key = 0;
        break;
      case ',':
      case '\n':
        key = 0;
        break;
      default:
        break;
    }
    if (depth + key > most_nested) return true;
    ++i;
  }
  return false;
}

std::optional<nlohmann::ordered_json> read_json(std::string_view text) {
  Shallow shallow;
  if (!Json::sax_parse(text, &shallow)) return std::nullopt;
  return nlohmann::ordered_json::parse(text);
}

std::optional<nlohmann::json> parse_cbor(std::string_view bytes) {
  Shallow shallow;
  if (!Json::sax_parse(bytes, &shallow, Json::input_format_t::cbor)) return std::nullopt;
  return Json::from_cbor(bytes);
}

}  // namespace lagroid
