#pragma once
/// Rows of numbers under names, from CSV files: a header, then a line each.
///
///     const CsvTable measured = read_csv_table("pendulum.csv", "t, q, p", Gaps::allowed);
///     const std::size_t q = measured.column("q");
///
/// Columns are separated by commas; lines that begin with # are comments. Errors: DataError, one line with file, row
/// and remedy, for a header that is none or has a name twice, for another number of fields, and for what is no number.

#include "data_set.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// Whether a field may be empty: a number that is not known, which becomes NaN.
enum class Gaps { refused, allowed };

struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  std::vector<long> lines;  ///< of the file, one for each row

  /// npos where there is none of that name.
  static constexpr std::size_t npos = std::size_t(-1);
  std::size_t column(std::string_view name) const;
};

/// `expected`: what the header names, for whoever forgot it.
CsvTable read_csv_table(const std::filesystem::path& path, std::string_view expected, Gaps gaps);

}  // namespace lagroid::app
