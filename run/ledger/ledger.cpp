#include <lagroid/run/ledger/ledger.hpp>

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

namespace {
constexpr double round_off = std::numeric_limits<double>::epsilon();

void judge(LedgerEntry& e, const char* verdict, std::string reason = {}) {
  e.verdict = verdict;
  e.reason = std::move(reason);
}

/// Whether drift and terms are no numbers to judge by; says so in the entry.
bool judged_as_no_number(LedgerEntry& e, double size) {
  constexpr double least = std::numeric_limits<double>::min() / round_off;
  if (!std::isfinite(e.drift))
    judge(e, "BROKEN", "not a finite number");
  else if (!std::isfinite(size))
    judge(e, "unjudged", "its terms are no finite numbers: choose other units");
  else if (const double largest = std::max(size, e.drift); largest > 0 && largest < least)
    judge(e, "unjudged",
          fmt::format("its terms are below {:.0e}, where numbers lose digits: choose other units", least));
  else
    return false;
  return true;
}

}  // namespace

double norm_of(const std::vector<double>& values) {
  const Eigen::Map<const Eigen::VectorXd> v(values.data(), Eigen::Index(values.size()));
  const double square = v.squaredNorm();
  if (square > 1e-200 && square < 1e200) return std::sqrt(square);  // nearly always, and much faster
  return v.allFinite() ? v.stableNorm() : v.lpNorm<1>();
}

static double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

QuantityWatch::QuantityWatch(std::string name, Promise promise, std::size_t width, SizeOf size_of)
    : name_(std::move(name)), promise_(promise), size_of_(size_of), first_(width), last_(width), deviation_(width) {}

void QuantityWatch::observe(const double* values, double size, double noise) {
  if (samples_ == 0) {
    std::copy_n(values, first_.size(), first_.begin());
    first_size_ = size;
  }
  std::copy_n(values, last_.size(), last_.begin());
  for (std::size_t i = 0; i < first_.size(); ++i) deviation_[i] = values[i] - first_[i];
  constexpr std::size_t most_chunks = 128;
  if (samples_ == chunk_ * long(envelope_.size())) {
    if (envelope_.size() == most_chunks) {
      for (std::size_t i = 0; i < most_chunks / 2; ++i) envelope_[i] = worse(envelope_[2 * i], envelope_[2 * i + 1]);
      envelope_.resize(most_chunks / 2);
      chunk_ *= 2;
    }
    envelope_.push_back(0);
  }
  envelope_.back() = worse(envelope_.back(), norm_of(deviation_));
  size_ = worse(size_, size);
  noise_ = worse(noise_, noise);
  if (size != 0) {
    ++sized_;
    logarithms_ += std::log(size);
  }
  ++samples_;
}

void QuantityWatch::shift(const double* by, double size) {
  double square = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    first_[i] += by[i];
    square += by[i] * by[i];
  }
  ++shifts_;
  size_ = worse(size_, worse(size, std::sqrt(square)));
}

double QuantityWatch::drift() const {
  std::vector<double> deviation = last_;
  for (std::size_t i = 0; i < deviation.size(); ++i) deviation[i] -= first_[i];
  return norm_of(deviation);
}

double QuantityWatch::typical_size() const { return sized_ > 0 ? std::exp(logarithms_ / double(sized_)) : 0; }

/// A random walk of round-off errors, each a few units in the last place of the largest term, or of evaluations'
/// noise.
double QuantityWatch::round_off_walk() const {
  const double steps = std::sqrt(double(samples_ + shifts_));
  return round_off * size_ * (200 + 20 * steps) + noise_ * (3 + 3 * steps);
}

LedgerEntry QuantityWatch::entry() const {
  LedgerEntry e;
  e.name = name_;
  e.promise = promise_ == Promise::conserved ? "conserved" : "bounded";
  e.initial = first_;
  e.final = last_;
  double first_half = 0;
  double second_half = 0;
  for (std::size_t i = 0; i < envelope_.size(); ++i) {
    double& half = 2 * i < envelope_.size() ? first_half : second_half;
    half = worse(half, envelope_[i]);
  }
  e.drift = worse(first_half, second_half);
  const double norm = norm_of(first_);
  // A first value that is round-off of its terms is no measure.
  const bool is_rounding = norm > 0 && norm <= 100 * round_off * first_size_;
  e.relative_drift = e.drift / (is_rounding ? first_size_ : norm > 0 ? norm : 1.0);
  if (samples_ == 0) {
    judge(e, "unjudged", "no node was seen");
  } else if (promise_ == Promise::conserved) {
    judge_conserved(e);
  } else {
    judge_bounded(e, first_half, second_half);
  }
  return e;
}

void QuantityWatch::judge_conserved(LedgerEntry& e) const {
  e.bound = round_off_walk();
  if (judged_as_no_number(e, size_)) return;
  // Terms can outgrow the ones at the start so far that keeping to their round-off says nothing of the first value.
  const bool telling = first_size_ == 0 || e.bound <= first_size_;
  if (!(e.drift <= e.bound)) {
    judge(e, "BROKEN");
  } else if (telling) {
    judge(e, "kept");
  } else {
    judge(e, "unjudged", "round-off in its terms, which have grown, exceeds those of the first value");
  }
}

bool QuantityWatch::grows(double first_half, double second_half) const {
  const double noise = round_off_walk();
  const auto exceeds = [&](double later, double earlier) { return !(later <= 1.5 * earlier + noise); };
  if (!exceeds(second_half, first_half)) return false;
  const auto middle = envelope_.begin() + std::ptrdiff_t(envelope_.size() + 1) / 2;
  const auto largest = std::max_element(middle, envelope_.end());
  return exceeds(median({middle, envelope_.end()}), median({envelope_.begin(), middle})) ||
         exceeds(median({largest, envelope_.end()}), first_half);
}

void QuantityWatch::judge_bounded(LedgerEntry& e, double first_half, double second_half) const {
  e.bound = 0.5 * typical_size();
  if (judged_as_no_number(e, size_)) return;
  constexpr long enough = 1000;
  const double noise = round_off_walk();
  if (size_ == 0) {
    judge(e, "unjudged", "it is zero at every node");
  } else if (!(noise <= e.bound)) {
    judge(e, "unjudged", "round-off in its largest terms exceeds half of its usual size");
  } else if (e.drift > e.bound && size_of_ == SizeOf::value) {
    judge(e, "unjudged", "it is off by more than half of its own size, and that of its terms is not known");
  } else if (e.drift > e.bound) {
    judge(e, "BROKEN", "off by more than half of the size of its terms: use a smaller step");
  } else if (samples_ < enough) {
    judge(e, "unjudged", fmt::format("{} of the {} nodes that tell drift from oscillation", samples_, enough));
  } else {
    judge(e, grows(first_half, second_half) ? "growing" : "bounded");
  }
}

void PositionWatch::look(bool moves, std::span<const double> positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    largest_ = std::max(largest_, std::abs(positions[i]));
    if (moves && last_.size() == positions.size()) moved_ = std::max(moved_, std::abs(positions[i] - last_[i]));
  }
  last_.assign(positions.begin(), positions.end());
}

void PositionWatch::withhold_verdicts(Ledger& ledger) const {
  constexpr double large = 1e6;
  constexpr double digits = 1e3;
  if (nodes_ < 2 || largest_ < large || moved_ >= digits * round_off * largest_) return;
  for (LedgerEntry& entry : ledger.entries)
    if (entry.verdict == "kept" || entry.verdict == "bounded")
      judge(entry, "unjudged",
            fmt::format("a step moves positions of {:.1e} by {:.1e} at most, less than their digits tell: "
                        "choose an origin near the motion",
                        largest_, moved_));
}

LedgerEntry constraint_entry(double largest, double size) {
  LedgerEntry e;
  e.name = "constraint residual";
  e.promise = "round-off";
  e.drift = largest;
  e.relative_drift = size > 0 ? largest / size : largest;
  e.bound = 100 * round_off * size;
  if (!judged_as_no_number(e, size)) judge(e, largest <= e.bound ? "kept" : "BROKEN");
  return e;
}

LedgerEntry unpromised(LedgerEntry entry) {
  entry.promise = "none";
  entry.bound = 0;
  entry.verdict = "watched";
  entry.reason.clear();
  return entry;
}

}  // namespace lagroid
