#pragma once
/// First guesses: a smooth sequence of vectors continued by one.

#include <lagroid/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lagroid {

/// Newton's backward-difference extrapolation, x_{k+1} ~ sum_j nabla^j x_k over j = 0 ... degree. The degree follows
/// the sequence: as high as the differences keep falling, at most `MaxDegree`, so that neither round-off nor a kink is
/// amplified.
template <int Size, int MaxDegree> class Extrapolation {
 public:
  void clear() { known_ = 0; }

  void push(const Vector<double, Size>& x) {
    Vector<double, Size> difference = x;
    const int count = std::min(known_ + 1, MaxDegree + 1);
    for (int j = 0; j < count; ++j) {
      const Vector<double, Size> next = difference - nabla_[std::size_t(j)];
      nabla_[std::size_t(j)] = difference;
      difference = next;
    }
    known_ = count;
  }

  /// Requires at least one vector pushed.
  Vector<double, Size> next() const {
    Vector<double, Size> sum = nabla_[0];
    double last = nabla_[0].squaredNorm();
    for (int j = 1; j < known_; ++j) {
      const double size = nabla_[std::size_t(j)].squaredNorm();
      if (!(size < last)) break;
      sum += nabla_[std::size_t(j)];
      last = size;
    }
    return sum;
  }

 private:
  std::array<Vector<double, Size>, std::size_t(MaxDegree) + 1> nabla_;
  int known_ = 0;
};

}  // namespace lagroid
