#include "member_list.hpp"

#include "../../reading/data_set.hpp"

#include <H5Cpp.h>
#include <fmt/format.h>
#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out;
  boost::split(out, line, boost::is_any_of(","));
  for (std::string& field : out) boost::trim(field);
  return out;
}

double number(const std::string& word, const std::string& file, long line, const std::string& column) {
  const std::string_view digits = std::string_view(word).substr(word.starts_with('+') ? 1 : 0);
  double x = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw DataError(fmt::format("{}: line {}, column {}: \"{}\" is no number", file, line, column, word));
  if (!std::isfinite(x))
    throw DataError(fmt::format("{}: line {}, column {}: {} is not finite", file, line, column, word));
  return x;
}

MemberList read_csv(const fs::path& path) {
  const std::string file = path.string();
  std::ifstream in(path);
  MemberList out;
  long line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (line_number == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
    boost::trim(line);
    if (line.empty() || line.starts_with('#')) continue;
    const std::vector<std::string> words = fields(line);
    if (out.columns.empty()) {
      out.columns = words;
      continue;
    }
    if (words.size() != out.columns.size())
      throw DataError(fmt::format("{}: line {} has {} fields, the header {}; make them equal", file, line_number,
                                  words.size(), out.columns.size()));
    for (std::size_t i = 0; i < words.size(); ++i)
      out.values.push_back(number(words[i], file, line_number, out.columns[i]));
  }
  if (in.bad()) throw DataError(fmt::format("{}: cannot be read to its end", file));
  return out;
}

MemberList read_data_sets(const fs::path& path) {
  const std::string file = path.string();
  MemberList out;
  H5::Exception::dontPrint();
  try {
    const H5::H5File in(file, H5F_ACC_RDONLY);
    for (hsize_t i = 0; i < in.getNumObjs(); ++i) out.columns.push_back(in.getObjnameByIdx(i));
  } catch (const H5::Exception& error) {
    throw DataError(fmt::format("{}: HDF5: {}; `h5ls {}` tries it", file, error.getDetailMsg(), file));
  }
  std::vector<Eigen::MatrixXd> data;
  for (const std::string& column : out.columns) {
    data.push_back(read_hdf5(path, "/" + column));
    if (data.back().cols() != 1 || data.back().rows() != data.front().rows())
      throw DataError(fmt::format("{}: {} has {} x {} numbers, {} has {}; each needs one number for a member", file,
                                  column, data.back().rows(), data.back().cols(), out.columns[0], data[0].rows()));
    if (!data.back().allFinite()) throw DataError(fmt::format("{}: {}: not all numbers are finite", file, column));
  }
  for (Eigen::Index i = 0; !data.empty() && i < data[0].rows(); ++i)
    for (const Eigen::MatrixXd& column : data) out.values.push_back(column(i));
  return out;
}

}  // namespace

MemberList read_member_list(const Section& section) {
  const std::string name = read_key(section, member_file);
  fs::path file = fs::path(section.file()).parent_path() / name;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) file = name;
  if (!fs::is_regular_file(file, ignored))
    section.fail("file", fmt::format("{}: there is no such file; paths are seen from the sweep, or from the working "
                                     "folder",
                                     name));
  const std::string extension = file.extension().string();
  try {
    MemberList out = extension == ".h5" || extension == ".hdf5" ? read_data_sets(file) : read_csv(file);
    if (out.values.empty())
      throw DataError(
          fmt::format("{}: holds no members; give a header of keys, and a line for each member", file.string()));
    std::vector<std::string> names = out.columns;
    std::sort(names.begin(), names.end());
    if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
      throw DataError(fmt::format("{}: there are two columns {}; leave one", file.string(), *twice));
    return out;
  } catch (const DataError& error) {
    section.fail("file", error.what());
  }
}

}  // namespace lagroid::app
