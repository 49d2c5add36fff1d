#pragma once
/// Watching promises while a trajectory is made.

#include "run_result.hpp"

#include <lagroid/core/quantity.hpp>

#include <string>
#include <vector>

namespace lagroid::app {

/// Follows one quantity: its first and last values, its largest deviation, and whether that still grows.
class QuantityWatch {
 public:
  QuantityWatch(std::string name, Promise promise, std::size_t width);
  /// `size` is the size of the terms the quantity is made of; round-off is relative to it. `noise` is what one
  /// evaluation loses beyond that, where the quantity is evaluated anew at each point and not carried along.
  void observe(const double* values, double size, double noise = 0);
  LedgerEntry entry() const;
  /// Visits what it has seen (app/archive.hpp).
  template <class Archive> void persist(Archive& archive) {
    archive("samples", samples_);
    archive("first", first_);
    archive("last", last_);
    archive("envelope", envelope_);
    archive("chunk", chunk_);
    archive("first size", first_size_);
    archive("size", size_);
    archive("noise", noise_);
  }

 private:
  std::string name_;
  Promise promise_;
  long samples_ = 0;
  std::vector<double> first_;
  std::vector<double> last_;
  std::vector<double> envelope_;  // largest deviation in consecutive chunks of equal length
  long chunk_ = 1;
  double first_size_ = 0;
  double size_ = 0;   // the largest
  double noise_ = 0;  // the largest
};

/// The entry for a constraint residual: the largest |phi| met, against round-off in its terms, which have the given
/// size.
LedgerEntry constraint_entry(double largest, double size);

/// The entry for something that is counted: how often it happened, and in what share of all cases.
LedgerEntry counted_entry(std::string name, long count, long all);

}  // namespace lagroid::app
