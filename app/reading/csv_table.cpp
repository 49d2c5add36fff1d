#include "csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>

namespace lagroid::app {

namespace {

/// Of UTF-8, as spreadsheets write it.
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> fields(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(',', from), line.size());
    out.push_back(trimmed(line.substr(from, to - from)));
    from = to + 1;
  }
  return out;
}

/// A header that another program wrote in its own way.
void require_commas(std::string_view header, const std::string& file) {
  const auto at = header.find_first_of(";\"\t");
  if (at == header.npos) return;
  const std::string found = header[at] == '\t' ? "tabs" : fmt::format("the character {}", header[at]);
  throw DataError(
      fmt::format("{}: {} in the header; columns are separated by commas, and names have no quotes", file, found));
}

double number(std::string_view word, const std::string& file, long line) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (error != std::errc() || end != word.data() + word.size())
    throw DataError(fmt::format("{}: row {}: \"{}\" is no number", file, line, word));
  return x;
}

}  // namespace

std::size_t CsvTable::column(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? npos : std::size_t(found - names.begin());
}

CsvTable read_csv_table(const std::filesystem::path& path, std::string_view expected, Gaps gaps) {
  const std::string file = path.string();
  std::ifstream in(path);
  if (!in) throw DataError(fmt::format("{}: cannot be read", file));
  CsvTable out;
  long line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    if (line_number == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    if (out.names.empty()) {
      require_commas(line, file);
      for (const std::string_view name : fields(line)) {
        if (out.column(name) != CsvTable::npos)
          throw DataError(fmt::format("{}: there are two columns {}; leave one", file, name));
        out.names.emplace_back(name);
      }
      continue;
    }
    const auto words = fields(line);
    if (words.size() != out.names.size())
      throw DataError(fmt::format("{}: row {}: {} numbers, the header has {} columns; make them equal", file,
                                  line_number, words.size(), out.names.size()));
    std::vector<double> row;
    for (const std::string_view word : words)
      row.push_back(word.empty() && gaps == Gaps::allowed ? std::numeric_limits<double>::quiet_NaN()
                                                          : number(word, file, line_number));
    out.rows.push_back(std::move(row));
    out.lines.push_back(line_number);
  }
  if (in.bad()) throw DataError(fmt::format("{}: cannot be read to its end", file));
  if (out.names.empty()) throw DataError(fmt::format("{}: no header; the first line names {}", file, expected));
  return out;
}

}  // namespace lagroid::app
