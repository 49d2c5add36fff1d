#include "data_set.hpp"

#include <lagroid/run/files/hdf5_file.hpp>

#include <H5Cpp.h>
#include <fmt/format.h>

#include <limits>
#include <new>

namespace lagroid::app {

namespace {

bool holds_numbers(const H5::DataSet& set) {
  return set.getTypeClass() == H5T_FLOAT || set.getTypeClass() == H5T_INTEGER;
}

std::vector<double> numbers(const H5::DataSet& set) {
  std::vector<double> values(std::size_t(set.getSpace().getSimpleExtentNpoints()));
  if (!values.empty()) set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
  return values;
}

std::string text_attribute(const H5::H5Object& object, const std::string& name) {
  std::string text;
  const H5::Attribute attribute = object.openAttribute(name);
  attribute.read(attribute.getStrType(), text);
  return text;
}

/// Files of runs say so. (To ask whether there is an attribute crashes HDF5 where the file is damaged.)
bool is_of_a_run(const H5::H5File& file) {
  try {
    text_attribute(file, "generator");
    return true;
  } catch (const H5::AttributeIException&) {
    return false;
  }
}

/// From the name and the number of columns.
std::vector<std::string> numbered_columns(const H5::DataSet& set, const std::string& name, std::size_t rows) {
  if (set.getSpace().getSimpleExtentNdims() == 1) return {name};
  std::vector<std::string> out;
  const std::size_t count = rows == 0 ? 0 : std::size_t(set.getSpace().getSimpleExtentNpoints()) / rows;
  for (std::size_t i = 0; i < count; ++i) out.push_back(fmt::format("{}.{}", name, i));
  return out;
}

/// Those of a run, joined by ", " in attributes.
std::vector<std::string> columns_of_run(const H5::DataSet& set) {
  std::vector<std::string> out;
  for (std::size_t part = 0; part == 0 || set.attrExists(components_attribute(part)); ++part) {
    const std::string joined = text_attribute(set, components_attribute(part));
    for (std::size_t from = 0; from <= joined.size();) {
      const std::size_t to = std::min(joined.find(", ", from), joined.size());
      out.push_back(joined.substr(from, to - from));
      from = to + 2;
    }
  }
  return out;
}

}  // namespace

Eigen::MatrixXd read_hdf5(const std::filesystem::path& file, const std::string& dataset) {
  H5::Exception::dontPrint();
  try {
    const H5::H5File in(file.string(), H5F_ACC_RDONLY);
    const H5::DataSet set = in.openDataSet(dataset);
    const H5::DataSpace space = set.getSpace();
    const int dimensions = space.getSimpleExtentNdims();
    if (dimensions < 1 || dimensions > 2)
      throw DataError(
          fmt::format("{}:{} has {} dimensions; a matrix has one or two", file.string(), dataset, dimensions));
    if (!holds_numbers(set)) throw DataError(fmt::format("{}:{} holds no numbers", file.string(), dataset));
    hsize_t size[2] = {1, 1};
    space.getSimpleExtentDims(size);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> out(size[0], size[1]);
    if (out.size() > 0) set.read(out.data(), H5::PredType::NATIVE_DOUBLE);
    return out;
  } catch (const H5::Exception& error) {
    throw DataError(fmt::format("{}: no data set {}: {}; `h5ls -r {}` lists them", file.string(), dataset,
                                error.getDetailMsg(), file.string()));
  }
}

bool is_hdf5(const std::filesystem::path& file) {
  H5::Exception::dontPrint();
  try {
    return H5::H5File::isHdf5(file.string());
  } catch (const H5::Exception&) {  // no file that can be read
    return false;
  }
}

double RecordedSeries::at(std::size_t row, std::size_t column) const {
  return row < first ? std::numeric_limits<double>::quiet_NaN() : values[(row - first) * columns.size() + column];
}

void read_series(const std::filesystem::path& path,
                 const std::function<void(const std::vector<double>&, const RecordedSeries&)>& use) {
  H5::Exception::dontPrint();
  const std::string file = path.string();
  try {
    const H5::H5File in(file, H5F_ACC_RDONLY);
    const bool of_a_run = is_of_a_run(in);
    const std::string time_name = !in.nameExists("time") && in.nameExists("t") ? "t" : "time";
    if (!in.nameExists(time_name))
      throw DataError(fmt::format("{}: no data set time, or t; it has those of rows", file));
    const std::vector<double> time = numbers(in.openDataSet(time_name));
    for (hsize_t i = 0; i < in.getNumObjs(); ++i) {
      const std::string name = in.getObjnameByIdx(i);
      if (name == time_name || in.childObjType(name) != H5O_TYPE_DATASET) continue;
      const H5::DataSet set = in.openDataSet(name);
      if (!holds_numbers(set)) continue;
      RecordedSeries series;
      series.first = of_a_run && text_attribute(set, "rows") == "one per recorded arrow" ? 1 : 0;
      const std::size_t rows = time.size() - std::min(series.first, time.size());
      series.columns = of_a_run ? columns_of_run(set) : numbered_columns(set, name, rows);
      series.values = numbers(set);
      if (series.values.size() != rows * series.columns.size())
        throw DataError(fmt::format("{}: \"{}\" has another number of rows than {}", file, name, time_name));
      use(time, series);
    }
  } catch (const std::length_error&) {  // more rows than any memory holds
    throw DataError(fmt::format("{}: is damaged", file));
  } catch (const std::bad_alloc&) {
    throw DataError(fmt::format("{}: does not fit into the memory, or is damaged", file));
  } catch (const H5::Exception& error) {
    throw DataError(fmt::format("{}: HDF5: {}", file, error.getDetailMsg()));
  }
}

}  // namespace lagroid::app
