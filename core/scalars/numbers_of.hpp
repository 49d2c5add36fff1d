#pragma once
/// The numbers of a matrix of any size as a list, column after column: what a NumberArchive visits where sizes are
/// known at run time only.

#include <cstddef>
#include <span>

namespace lagroid {

/// The numbers of a matrix that owns them, of any size, column after column: what a NumberArchive visits.
template <class Matrix> std::span<typename Matrix::Scalar> numbers_of(Matrix& m) {
  return {m.data(), std::size_t(m.size())};
}

}  // namespace lagroid
