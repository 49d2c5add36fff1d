#pragma once
/// A progress bar on the terminal for runs over a second.
///
///     Progress progress("steps", 1000, true);  // enabled
///     for (long k = 1; k <= 1000; ++k) progress.update(k);

#include <chrono>
#include <string>

namespace lagroid {

/// Draws on stderr, only when that is a terminal and a second has passed; erases itself at the end.
class Progress {
 public:
  Progress(std::string what, long total, bool enabled);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  void update(long done);

 private:
  void draw(long done) const;

  std::string what_;
  long total_;
  bool enabled_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point next_ = start_ + std::chrono::seconds(1);
};

}  // namespace lagroid
