#pragma once
/// The next vector of a smooth sequence, by the polynomial through the last m + 1:
///
///     x_{k+1} ~ sum_{j=0..m} (-1)^j binomial(m + 1, j + 1) x_{k-j}.
///
/// The unknowns of the steps of a trajectory are such a sequence, and this is their first guess (StepPredictor).
///
///     Extrapolation<1, 3> sequence;
///     for (double t : {0.0, 0.1, 0.2}) sequence.push(Vector<double, 1>(std::sin(t)));
///     const double near_sine = sequence.next()(0);  // sin(0.3), nearly
///
/// `next` requires one vector at least. The degree m follows the sequence, up to MaxDegree.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lagroid {

/// The value at k + 1 of the polynomial through the last degree + 1 vectors of a sequence,
/// x_{k+1} ~ sum_j (-1)^j binomial(degree + 1, j + 1) x_{k-j}. The degree follows the sequence: where the next backward
/// difference is no smaller than the last, it stops, so that neither round-off nor a kink is amplified.
template <int Size, int MaxDegree> class Extrapolation {
 public:
  static constexpr int length = MaxDegree + 1;  ///< vectors that are remembered
  static constexpr int review = 16;             ///< steps from one choice of the degree to the next

  using Weights = std::array<double, std::size_t(length)>;
  /// Of the newest vector, the one before, ..., by degree.
  static constexpr std::array<Weights, std::size_t(length)> weights = [] {
    std::array<Weights, std::size_t(length)> w{};
    for (std::size_t degree = 0; degree < std::size_t(length); ++degree) {
      double binomial = 1;
      for (std::size_t j = 0; j <= degree; ++j) {
        binomial = binomial * double(degree + 1 - j) / double(j + 1);
        w[degree][j] = j % 2 == 0 ? binomial : -binomial;
      }
    }
    return w;
  }();

  void clear() { known_ = 0; }
  bool empty() const { return known_ == 0; }

  void push(const Vector<double, Size>& x) {
    newest_ = newest_ == 0 ? length - 1 : newest_ - 1;
    past_[std::size_t(newest_)] = past_[std::size_t(newest_ + length)] = x;
    known_ = std::min(known_ + 1, length);
    if (known_ < length || --until_review_ <= 0) choose_degree();
  }

  /// Requires at least one vector pushed.
  Vector<double, Size> next() const {
    // The newest last: it is the one that is not known early.
    const auto& weight = weights[std::size_t(degree_)];
    Vector<double, Size> sum = Vector<double, Size>::Zero();
    for (int j = degree_; j >= 0; --j) sum += weight[std::size_t(j)] * back(j);
    return sum;
  }

  /// Visits all that it goes on from.
  void serialize(NumberArchive& archive) {
    archive(newest_, known_, degree_, until_review_);
    for (int j = 0; j < known_; ++j) {
      auto& x = past_[std::size_t(newest_ + j)];
      archive(x);
      past_[std::size_t((newest_ + j + length) % (2 * length))] = x;
    }
  }

 private:
  const Vector<double, Size>& back(int j) const { return past_[std::size_t(newest_ + j)]; }

  void choose_degree() {
    until_review_ = review;
    std::array<Vector<double, Size>, std::size_t(length)> difference;
    for (int j = 0; j < known_; ++j) difference[std::size_t(j)] = back(j);
    double last = difference[0].squaredNorm();
    for (degree_ = 0; degree_ + 1 < known_; ++degree_) {
      for (int j = 0; j + degree_ + 1 < known_; ++j) difference[std::size_t(j)] -= difference[std::size_t(j) + 1];
      const double size = difference[0].squaredNorm();
      if (!(size < last)) break;
      last = size;
    }
  }

  std::array<Vector<double, Size>, 2 * std::size_t(length)> past_;  ///< a ring, twice over: a window lies in one piece
  int newest_ = 0;
  int known_ = 0;
  int degree_ = 0;
  int until_review_ = 0;
};

}  // namespace lagroid
