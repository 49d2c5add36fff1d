#pragma once
/// HDF5 files that are made in memory and then written as a whole: HDF5 itself cannot survive a disk that is full
/// (closing the file crashes, at exit at the latest).

#include <H5Cpp.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lagroid {

void set_attribute(const H5::H5Object& object, const std::string& name, const std::string& value);

/// The labels of a series' columns stand in attributes: "components", and "components 2", ... where they are many.
std::string components_attribute(std::size_t part);

/// A data set of doubles, `width` to a row; of one dimension where that is one. Without the time of day, so that equal
/// runs make equal files.
H5::DataSet add_dataset(const H5::Group& group, const std::string& name, const std::vector<double>& values,
                        std::size_t width);

/// A data set of texts, all as long as the longest of them and filled up with zeros.
H5::DataSet add_texts(const H5::Group& group, const std::string& name, const std::vector<std::string>& texts);

/// What `fill` puts into it. Throws OutputError.
void write_hdf5(const std::filesystem::path& file, const std::function<void(const H5::H5File&)>& fill);

}  // namespace lagroid
