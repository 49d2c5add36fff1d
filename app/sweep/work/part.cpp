#include "part.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

namespace lagroid::app {

namespace {

using Json = nlohmann::json;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// The column of the given name, which is made where it is missing; `at` is where it is expected: members name theirs
/// in the same order.
template <class Columns, class Value>
auto& named(Columns& columns, std::size_t& at, const std::string& name, const std::string& unit,
            const std::string& meaning, std::size_t count, const Value& empty) {
  if (at >= columns.size() || columns[at].name != name) {
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
    at = std::size_t(found - columns.begin());
    if (found == columns.end()) {
      columns.push_back({name, unit, meaning, {}});
      columns.back().values.assign(count, empty);
    }
  }
  return columns[at++];
}

Json bytes_of(const std::vector<double>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(double));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return Json::binary(std::move(bytes));
}

std::vector<double> values_of(const Json& json) {
  const auto& bytes = json.get_binary();
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

}  // namespace

const Column* SweepPart::find(const std::string& name) const {
  const auto found = std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == name; });
  return found == columns_.end() ? nullptr : &*found;
}

void SweepPart::end(long at, const std::string& status, const std::string& message) {
  status_[std::size_t(at)] = status;
  if (!message.empty()) messages_[at] = message;
}

void SweepPart::set(long at, const std::string& name, const std::string& unit, const std::string& meaning,
                    double value) {
  named(columns_, column_at_, name, unit, meaning, status_.size(), no_value).values[std::size_t(at)] = value;
}

void SweepPart::set_series(long at, const std::string& name, const std::string& unit, const std::string& meaning,
                           std::vector<double> values) {
  named(series_, series_at_, name, unit, meaning, status_.size(), std::vector<double>()).values[std::size_t(at)] =
      std::move(values);
}

void SweepPart::append(const SweepPart& next) {
  const std::size_t before = status_.size();
  status_.insert(status_.end(), next.status_.begin(), next.status_.end());
  for (const auto& [at, message] : next.messages_) messages_[long(before) + at] = message;
  const auto join = [&](auto& own, const auto& others, std::size_t& at, const auto& empty) {
    for (auto& column : own) column.values.resize(status_.size(), empty);
    for (const auto& column : others) {
      auto& to = named(own, at, column.name, column.unit, column.meaning, status_.size(), empty);
      std::copy(column.values.begin(), column.values.end(), to.values.begin() + std::ptrdiff_t(before));
    }
  };
  join(columns_, next.columns_, column_at_, no_value);
  join(series_, next.series_, series_at_, std::vector<double>());
}

Json SweepPart::json() const {
  Json messages = Json::array();
  for (const auto& [at, message] : messages_) messages.push_back({at, message});
  Json columns = Json::array();
  for (const Column& c : columns_) columns.push_back({c.name, c.unit, c.meaning, bytes_of(c.values)});
  Json series = Json::array();
  for (const SeriesColumn& s : series_) {
    Json rows = Json::array();
    for (const auto& values : s.values) rows.push_back(bytes_of(values));
    series.push_back({s.name, s.unit, s.meaning, std::move(rows)});
  }
  return {{"first", first_}, {"status", status_}, {"messages", messages}, {"columns", columns}, {"series", series}};
}

SweepPart SweepPart::from(const Json& json) {
  SweepPart out;
  out.first_ = json.at("first").get<long>();
  out.status_ = json.at("status").get<std::vector<std::string>>();
  for (const Json& m : json.at("messages")) out.messages_[m.at(0).get<long>()] = m.at(1).get<std::string>();
  for (const Json& c : json.at("columns")) out.columns_.push_back({c.at(0), c.at(1), c.at(2), values_of(c.at(3))});
  for (const Json& s : json.at("series")) {
    out.series_.push_back({s.at(0), s.at(1), s.at(2), {}});
    for (const Json& row : s.at(3)) out.series_.back().values.push_back(values_of(row));
  }
  return out;
}

}  // namespace lagroid::app
