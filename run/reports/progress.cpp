#include <lagroid/run/reports/progress.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace lagroid {

Progress::Progress(std::string what, long total, bool enabled)
    : what_(visible(what)), total_(total), enabled_(enabled && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::update(long done) {
  if (!enabled_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  drawn_ = true;
  draw(done);
}

void Progress::draw(long done) const {
  constexpr int width = 32;
  const double fraction = total_ > 0 ? double(done) / double(total_) : 0;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
  const int filled = int(fraction * width);
  const std::string line = fmt::format("\r\033[K{} [{:#<{}}{:.<{}}] {:3.0f} %, {:.0f} s left", what_, "", filled, "",
                                       width - filled, 100 * fraction, left);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace lagroid
