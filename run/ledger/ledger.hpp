#pragma once
/// Promises watched while a trajectory is made: for each quantity its drift |I(z_k) - I(z_0)|, the bound that its
/// promise sets, and the verdict.
///
/// A ledger distinguishes round-off from error without a tolerance of the user's: bounds follow from the size of the
/// terms and, for round-off, the number of steps.
///
///     QuantityWatch energy("energy", Promise::bounded, 1);  // of one component
///     energy.observe(&value, size);  // at every node
///     std::cout << energy.entry().verdict;
///
/// Requires at each node the size of the terms that the quantity is a sum of. Verdicts are "kept", "BROKEN", "bounded",
/// "growing", "unjudged", "watched" or "counted". Nothing throws.

#include <lagroid/run/motion/observables.hpp>
#include <lagroid/run/run_result.hpp>

#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// The Euclidean norm. Squares that would overflow or underflow do not matter; where a number is not finite, it is not.
double norm_of(const std::vector<double>& values);

/// The larger of the two; a NaN wins, so that it is never overlooked.
inline double worse(double a, double b) { return a <= b || std::isnan(b) ? b : a; }

/// Follows one quantity: its first and last values, its largest deviation, and whether that still grows.
///
/// A conserved one is held to a random walk of round-off in its terms. A bounded one is held to half of its size along
/// the motion, the geometric mean over the nodes (so that a passage near a singularity counts for no more than its
/// nodes): an energy that is farther off describes no motion, whether it still grows or not. Where only its own
/// norm is known that bound may be too narrow, and what exceeds it is unjudged.
///
/// Numbers that are none are never kept or bounded: a drift that is not finite is BROKEN; terms that are not finite, or
/// so small that their round-off is below the normal numbers, are unjudged. A power of two on all values and sizes
/// changes no verdict but to one of these.
class QuantityWatch {
 public:
  QuantityWatch(std::string name, Promise promise, std::size_t width, SizeOf size_of = SizeOf::terms);
  /// `size` is the size of the terms the quantity is made of; round-off is relative to it. `noise` is what one
  /// evaluation loses beyond that, where the quantity is evaluated anew at each point and not updated by steps.
  void observe(const double* values, double size, double noise = 0);
  /// Something changed the quantity by so much, where its terms had the size; it is held to its promise from there,
  /// with the round-off of the change.
  void shift(const double* by, double size);
  LedgerEntry entry() const;
  /// The norm of the last deviation from the first value.
  double drift() const;
  /// Visits what it has seen (archive.hpp).
  template <class Archive> void serialize(Archive& archive) {
    archive("samples", samples_);
    archive("shifts", shifts_);
    archive.list("first", first_);
    archive.list("last", last_);
    archive("envelope", envelope_);
    archive("chunk", chunk_);
    if (chunk_ < 1) throw std::out_of_range("chunk: of another computation");
    archive("first size", first_size_);
    archive("size", size_);
    archive("noise", noise_);
    archive("sized", sized_);
    archive("logarithms", logarithms_);
  }

 private:
  double typical_size() const;
  void judge_conserved(LedgerEntry& entry) const;
  void judge_bounded(LedgerEntry& entry, double first_half, double second_half) const;
  /// Whether the largest deviation of the second half, half as much again as that of the first, is more than an
  /// excursion that came back, of which chaotic motions have some: the usual one (the median of the chunks' largest)
  /// grew as much, or from the largest on it stayed there.
  bool grows(double first_half, double second_half) const;
  double round_off_walk() const;

  std::string name_;
  Promise promise_;
  SizeOf size_of_;
  long samples_ = 0;
  long shifts_ = 0;
  std::vector<double> first_;
  std::vector<double> last_;
  std::vector<double> deviation_;
  std::vector<double> envelope_;  // largest deviation in consecutive chunks of equal length
  long chunk_ = 1;
  double first_size_ = 0;
  double size_ = 0;        // the largest
  double noise_ = 0;       // the largest
  long sized_ = 0;         // samples whose size is not zero
  double logarithms_ = 0;  // the sum of those of their sizes
};

/// Whether positions still have the digits of the motion: where a step moves them by less than a thousand of their own
/// units in the last place, what is computed is rounding, however well it keeps its momenta. Tested at positions above
/// a million, for at an equilibrium near the origin nothing is lost, and at two nodes of every 64, so that it costs
/// nothing.
class PositionWatch {
 public:
  /// `positions()` gives the coordinates at a node as a span of doubles.
  template <class Positions> void observe(const Positions& positions) {
    if (const long place = nodes_++ % 64; place < 2) look(place == 1, positions());
  }
  /// Where the digits are lost, what is kept or bounded is unjudged.
  void withhold_verdicts(Ledger& ledger) const;
  template <class Archive> void serialize(Archive& archive) {
    archive("nodes", nodes_);
    archive("last", last_);
    archive("largest", largest_);
    archive("moved", moved_);
  }

 private:
  void look(bool moves, std::span<const double> positions);

  long nodes_ = 0;
  std::vector<double> last_;
  double largest_ = 0;
  double moved_ = 0;  ///< the most over a step
};

/// The entry for a constraint residual: the largest |phi| met, against round-off in its terms, which have the given
/// size.
LedgerEntry constraint_entry(double largest, double size);

/// An entry for what the method does not promise: how far it went.
LedgerEntry unpromised(LedgerEntry entry);

/// The entry for something that is counted: how often it happened, and in what share of all cases.
inline LedgerEntry counted_entry(std::string name, long count, long all) {
  LedgerEntry e;
  e.name = std::move(name);
  e.promise = "counted";
  e.drift = double(count);
  e.relative_drift = all > 0 ? double(count) / double(all) : 0;
  e.verdict = "counted";
  return e;
}

}  // namespace lagroid
