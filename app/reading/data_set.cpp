#include "data_set.hpp"

#include <H5Cpp.h>
#include <fmt/format.h>

namespace lagroid::app {

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
    if (set.getTypeClass() != H5T_FLOAT && set.getTypeClass() != H5T_INTEGER)
      throw DataError(fmt::format("{}:{} holds no numbers", file.string(), dataset));
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

}  // namespace lagroid::app
