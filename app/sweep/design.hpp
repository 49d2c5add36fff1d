#pragma once
/// The members of a sweep: which numbers of a scene each of them has in place of others.

#include "../keys/key.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace lagroid::app {

/// Members as rows of numbers, in the order in which they are numbered.
struct Design {
  /// A path of the scene, and the columns that its numbers stand in.
  struct Key {
    std::string path;
    std::vector<std::string> columns;
    bool equally_spaced = false;  ///< over the members of a grid
    bool logarithmic = false;
  };

  std::string kind;
  std::vector<Key> keys;
  std::vector<double> values;  ///< row after row

  std::size_t width() const;
  long count() const { return long(values.size() / width()); }
  std::vector<std::string> columns() const;
  /// What member i changes.
  std::vector<Change> member(long i) const;
};

/// The keys of [design] and [[vary]], by the kinds of designs.
std::vector<Table> design_tables();

/// [design] and [[vary]] of a sweep over `scene`. Throws SceneError, also for keys that are not numbers of the scene.
///
///   kind = "grid"             all combinations; the last key varies fastest
///   kind = "random"           `count` independent members, from `seed` (default 1)
///   kind = "latin-hypercube"  the same, but of each number's `count` equally likely strata every one is met once
///   kind = "list"             the rows of `file`: a CSV file with the keys as header, or an HDF5 file with data sets
///   of
///                             their names
Design read_design(const Section& sweep, const Section& scene);

}  // namespace lagroid::app
