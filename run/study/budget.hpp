#pragma once
/// The time that a study may take.
///
///     const Budget budget(60);  // s of wall clock, from now on
///     while (!budget.over()) measure();

#include <chrono>

namespace lagroid {

/// So many seconds of wall clock from now on.
class Budget {
 public:
  explicit Budget(double seconds) : seconds_(seconds) {}

  double seconds() const { return seconds_; }
  double spent() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  double left() const { return seconds_ - spent(); }
  bool over() const { return left() <= 0; }

 private:
  double seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace lagroid
