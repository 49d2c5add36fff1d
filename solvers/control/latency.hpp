#pragma once
/// How long each of many solves took, in a memory that does not grow: percentiles to five percent, from a microsecond
/// to a hundred seconds.
///
///     Latency latency;
///     latency.add(0.0012);
///     const double usual = latency.percentile(50);  // s
///
/// Requires percentiles from 0 to 100. Returns the upper end of the class that holds it, the largest value itself for
/// 100, and zero of no solves; what is beyond the ends counts as these. Nothing throws.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace lagroid {

class Latency {
 public:
  void add(double seconds) {
    const double place = std::log(std::max(seconds, shortest) / shortest) / std::log(ratio);
    ++classes_[std::min(std::size_t(place), classes_.size() - 1)];
    ++count_;
    longest_ = std::max(longest_, seconds);
  }

  long count() const { return count_; }
  double longest() const { return longest_; }
  double percentile(double p) const {
    if (!(p < 100)) return longest_;
    const auto wanted = long(std::ceil(p * double(count_) / 100 - 1e-9));
    long below = 0;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      below += classes_[i];
      if (below >= wanted && below > 0) return std::min(longest_, shortest * std::pow(ratio, double(i + 1)));
    }
    return longest_;
  }

 private:
  static constexpr double shortest = 1e-6;
  static constexpr double ratio = 1.05;
  std::array<long, 378> classes_{};
  long count_ = 0;
  double longest_ = 0;
};

}  // namespace lagroid
