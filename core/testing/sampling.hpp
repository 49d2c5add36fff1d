#pragma once
/// How many samples laws draw, and from which seed, for as long as an object lives.
///
///     const laws::Sampling sampling(1000, 7);                     // samples, seed
///     const laws::LawReport report = laws::groupoid_laws<SO3>();  // a thousand samples of each law
///
/// It sets an environment variable and silences std::cerr, which are the whole process's: one at a time.

#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

namespace lagroid::laws {

/// While it lives, every law draws so many samples from this seed, and failures are in the reports alone, not on
/// std::cerr.
class Sampling {
 public:
  Sampling(int samples, long seed) : errors_(std::cerr.rdstate()) {
    if (const char* before = std::getenv(variable)) before_ = before;
    ::setenv(variable, ("seed=" + std::to_string(seed) + " max_success=" + std::to_string(samples)).c_str(), 1);
    std::cerr.setstate(std::ios::failbit);
  }
  Sampling(const Sampling&) = delete;
  Sampling& operator=(const Sampling&) = delete;
  ~Sampling() {
    std::cerr.clear(errors_);
    if (before_) {
      ::setenv(variable, before_->c_str(), 1);
    } else {
      ::unsetenv(variable);
    }
  }

 private:
  static constexpr const char* variable = "RC_PARAMS";  // where RapidCheck reads its options
  std::ios::iostate errors_;
  std::optional<std::string> before_;
};

}  // namespace lagroid::laws
