#pragma once
/// The numbers of rows that go on side by side in a register, as doubles for one row at a time (ExtrapolationTable).
///
///     using L = detail::RowRegister<RowBatch>;
///     const auto step = L::load(slot.step);             // of each lane its own
///     const double first = L::get(step, 0);
///     const auto mixed = L::choose(slot.others, x, y);  // x where the flag is set, else y
///
/// Requires lists as long as there are lanes. Nothing throws.

#ifndef __wasm__
#include <lagroid/core/scalars/batch.hpp>

#include <algorithm>
#include <cstddef>
#endif

#include <vector>

namespace lagroid {

namespace detail {

/// A double as a register of one lane.
template <class S> struct RowRegister {
  static constexpr int width = 1;
  static double load(const std::vector<double>& x) { return x[0]; }
  static double get(double x, int) { return x; }
  static double choose(const std::vector<double>& chosen, double x, double y) { return chosen[0] != 0 ? x : y; }
};

}  // namespace detail

#ifdef __wasm__

/// Debian's xsimd knows no registers of browsers.
using RowBatch = double;

#else

/// As many rows as there are lanes in the machine's registers, up to four: more would wait for the longest.
using RowBatch = Batch<std::min(4, widest_batch)>;

template <int W> struct detail::RowRegister<Batch<W>> {
  static constexpr int width = W;
  using B = Batch<W>;
  static B load(const std::vector<double>& x) { return B::load(x.data()); }
  static double get(const B& x, int lane) { return x[lane]; }
  static B choose(const std::vector<double>& chosen, const B& x, const B& y) {
    return select(load(chosen) != B(0.0), x, y);
  }
};

#endif

}  // namespace lagroid
