#include "ledger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid::app {

namespace {
constexpr double round_off = std::numeric_limits<double>::epsilon();

/// The larger of the two; a NaN wins, so that it is never overlooked.
double worse(double a, double b) { return a <= b || std::isnan(b) ? b : a; }

}  // namespace

QuantityWatch::QuantityWatch(std::string name, Promise promise, std::size_t width)
    : name_(std::move(name)), promise_(promise), first_(width), last_(width) {}

void QuantityWatch::observe(const double* values, double size, double noise) {
  if (samples_ == 0) {
    std::copy_n(values, first_.size(), first_.begin());
    first_size_ = size;
  }
  std::copy_n(values, last_.size(), last_.begin());
  double square = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) square += (values[i] - first_[i]) * (values[i] - first_[i]);
  constexpr std::size_t most_chunks = 128;
  if (samples_ == chunk_ * long(envelope_.size())) {
    if (envelope_.size() == most_chunks) {
      for (std::size_t i = 0; i < most_chunks / 2; ++i) envelope_[i] = worse(envelope_[2 * i], envelope_[2 * i + 1]);
      envelope_.resize(most_chunks / 2);
      chunk_ *= 2;
    }
    envelope_.push_back(0);
  }
  envelope_.back() = worse(envelope_.back(), std::sqrt(square));
  size_ = std::max(size_, size);
  noise_ = std::max(noise_, noise);
  ++samples_;
}

LedgerEntry QuantityWatch::entry() const {
  LedgerEntry e;
  e.name = name_;
  e.initial = first_;
  e.final = last_;
  double first_half = 0;
  double second_half = 0;
  for (std::size_t i = 0; i < envelope_.size(); ++i) {
    double& half = 2 * i < envelope_.size() ? first_half : second_half;
    half = worse(half, envelope_[i]);
  }
  e.drift = worse(first_half, second_half);
  double norm = 0;
  for (const double x : first_) norm += x * x;
  norm = std::sqrt(norm);
  e.relative_drift = e.drift / (norm > 0 ? norm : 1.0);
  // A random walk of round-off errors, each a few units in the last place of the largest term, or of evaluations'
  // noise.
  const double noise =
      round_off * size_ * (200 + 20 * std::sqrt(double(samples_))) + noise_ * (3 + 3 * std::sqrt(double(samples_)));
  if (promise_ == Promise::conserved) {
    e.promise = "conserved";
    e.bound = noise;
    // Terms can outgrow the ones at the start so far that keeping to their round-off says nothing of the first value.
    const bool telling = first_size_ == 0 || noise <= first_size_;
    e.verdict = samples_ == 0 ? "unjudged" : !(e.drift <= noise) ? "BROKEN" : telling ? "kept" : "unjudged";
  } else {
    e.promise = "bounded";
    constexpr long enough = 1000;
    const bool settled = second_half <= 1.5 * first_half + noise;
    e.verdict = samples_ < enough ? "unjudged" : settled ? "bounded" : "growing";
  }
  return e;
}

LedgerEntry constraint_entry(double largest, double size) {
  LedgerEntry e;
  e.name = "constraint residual";
  e.promise = "round-off";
  e.drift = largest;
  e.relative_drift = size > 0 ? largest / size : largest;
  e.bound = 100 * round_off * size;
  e.verdict = largest <= e.bound ? "kept" : "BROKEN";
  return e;
}

LedgerEntry counted_entry(std::string name, long count, long all) {
  LedgerEntry e;
  e.name = std::move(name);
  e.promise = "counted";
  e.drift = double(count);
  e.relative_drift = all > 0 ? double(count) / double(all) : 0;
  e.verdict = "counted";
  return e;
}

}  // namespace lagroid::app
