#pragma once
/// What is kept of members of a sweep.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace lagroid::app {

/// One number of every member; NaN where a member has none.
struct Column {
  std::string name;  ///< group/label, as "final/px"
  std::string unit;
  std::string meaning;
  std::vector<double> values;
};

/// A row of numbers of every member, in the order of its nodes.
struct SeriesColumn {
  std::string name;
  std::string unit;
  std::string meaning;
  std::vector<std::vector<double>> values;
};

/// Members `first`, `first` + 1, ...: their columns are those that any of them has, in the order in which they come up.
class SweepPart {
 public:
  SweepPart() = default;
  SweepPart(long first, long count) : first_(first), status_(std::size_t(count)) {}

  long first() const { return first_; }
  long count() const { return long(status_.size()); }
  const std::vector<std::string>& status() const { return status_; }
  /// Of members that failed, by their place in this part.
  const std::map<long, std::string>& messages() const { return messages_; }
  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<SeriesColumn>& series() const { return series_; }
  /// Null where there is none of that name.
  const Column* find(const std::string& name) const;

  /// Sets what is known of the member at the given place of this part.
  void end(long at, const std::string& status, const std::string& message);
  void set(long at, const std::string& name, const std::string& unit, const std::string& meaning, double value);
  void set_series(long at, const std::string& name, const std::string& unit, const std::string& meaning,
                  std::vector<double> values);

  /// Puts the members of `next`, which begins where this one ends, after its own.
  void append(const SweepPart& next);

  nlohmann::json json() const;
  /// Throws nlohmann::json::exception where `json` is none of these.
  static SweepPart from(const nlohmann::json& json);

 private:
  long first_ = 0;
  std::vector<std::string> status_;
  std::map<long, std::string> messages_;
  std::vector<Column> columns_;
  std::vector<SeriesColumn> series_;
  std::size_t column_at_ = 0;  ///< where the next one is expected
  std::size_t series_at_ = 0;
};

}  // namespace lagroid::app
