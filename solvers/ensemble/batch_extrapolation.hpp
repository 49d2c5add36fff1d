#pragma once
/// First guesses for the members of a batch: the polynomials of extrapolation.hpp, of a degree of its own in each lane.

#include <lagroid/core/scalars/batch.hpp>
#include <lagroid/solvers/step/extrapolation.hpp>

#include <array>

namespace lagroid {

/// Sequences of vectors, one in each lane, continued by one with the polynomials of `Extrapolation`. Every lane has a
/// degree, a length and reviews of its own; their vectors arrive together.
template <int W, int Size, int MaxDegree> class BatchExtrapolation {
 public:
  using B = Batch<W>;
  using Mask = typename B::Mask;

  /// The first vector of every lane.
  void start(const Vector<B, Size>& x) {
    for (auto& past : past_) past = x;
    newest_ = 0;
    known_ = 1.0;
    until_review_ = 0.0;
    degree_ = 0.0;
    choose_weights();
  }
  /// The next vector of the lanes of the mask, the first of those that begin anew.
  void push(const Vector<B, Size>& x, const Mask& moved, const Mask& anew) {
    newest_ = (newest_ + length - 1) % length;
    auto& newest = past_[std::size_t(newest_)];
    for (int i = 0; i < Size; ++i) newest(i) = select(moved, x(i), newest(i));
    known_ = min(known_ + 1.0, B(length));
    until_review_ -= 1.0;
    if (xsimd::any(anew)) {
      for (auto& past : past_)
        for (int i = 0; i < Size; ++i) past(i) = select(anew, x(i), past(i));
      known_ = select(anew, B(1.0), known_);
    }
    const Mask due = known_ < double(length) || until_review_ <= 0.0;
    if (xsimd::any(due)) choose_degree(due);
  }

  Vector<B, Size> next() const {
    Vector<B, Size> sum;
    for (int i = 0; i < Size; ++i) sum(i) = B(0.0);
    for (int j = length - 1; j >= 0; --j) {
      const auto& x = back(j);
      for (int i = 0; i < Size; ++i) sum(i) += weight_[std::size_t(j)] * x(i);
    }
    return sum;
  }

 private:
  using One = Extrapolation<Size, MaxDegree>;
  static constexpr int length = One::length;

  const Vector<B, Size>& back(int j) const { return past_[std::size_t((newest_ + j) % length)]; }
  static B square(const Vector<B, Size>& x) {
    B sum = x(0) * x(0);
    for (int i = 1; i < Size; ++i) sum += x(i) * x(i);
    return sum;
  }

  [[gnu::noinline]] void choose_degree(const Mask& due) {
    until_review_ = select(due, B(One::review), until_review_);
    std::array<Vector<B, Size>, std::size_t(length)> difference;
    for (int j = 0; j < length; ++j) difference[std::size_t(j)] = back(j);
    B last = square(difference[0]);
    B degree = 0.0;
    Mask falling = due;
    for (int k = 1; k < length && xsimd::any(falling); ++k) {
      for (int j = 0; j + k < length; ++j) difference[std::size_t(j)] -= difference[std::size_t(j) + 1];
      const B size = square(difference[0]);
      falling = falling && known_ > double(k) && size < last;
      degree = select(falling, B(k), degree);
      last = size;
    }
    degree_ = select(due, degree, degree_);
    choose_weights();
  }
  void choose_weights() {
    for (int j = 0; j < length; ++j) {
      B w = 0.0;
      for (int degree = 0; degree < length; ++degree)
        w = select(degree_ == double(degree), B(One::weights[std::size_t(degree)][std::size_t(j)]), w);
      weight_[std::size_t(j)] = w;
    }
  }

  std::array<Vector<B, Size>, std::size_t(length)> past_;  ///< a ring
  std::array<B, std::size_t(length)> weight_;              ///< of the newest, the one before, ...
  int newest_ = 0;
  B known_;
  B until_review_;
  B degree_;
};

}  // namespace lagroid
