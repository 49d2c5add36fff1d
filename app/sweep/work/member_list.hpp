#pragma once
/// Members of a sweep that stand in a file.

#include "../../keys/key.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

struct MemberList {
  std::vector<std::string> columns;
  std::vector<double> values;  ///< row after row, all finite
};

inline const KeyOf<Text> member_file{
    "file", {}, "", "a CSV file with the keys as header, or an HDF5 file with data sets of their names"};
/// The file that `file` of the section names, seen from the sweep, or from the working folder where it is not there.
/// CSV: a header, then a line for each member; empty lines and those that begin with # count for nothing. HDF5 (.h5,
/// .hdf5): a data set of one dimension for each column. Throws SceneError.
MemberList read_member_list(const Section& section);

}  // namespace lagroid::app
