#include <lagroid/solvers/poisson/wiener_path.hpp>

// Random123 compiles for processors that it knows, of which WebAssembly is none. What it asks of this generator is C++
// alone.
#if defined(__wasm__) && !defined(__riscv)
#define __riscv
#include <Random123/philox.h>
#undef __riscv
#else
#include <Random123/philox.h>
#endif

#include <numbers>

namespace lagroid {

std::array<double, 2> WienerPath::normals(std::int64_t step, std::uint32_t pair) const {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); };
  const std::uint64_t n(step);
  const r123::Philox4x32::ctr_type counter{{low(n), high(n), path, pair}};
  const r123::Philox4x32::key_type key{{low(seed), high(seed)}};
  const r123::Philox4x32::ctr_type bits = r123::Philox4x32()(counter, key);
  // 53 bits each: the first in (0, 1], for its logarithm, the second in [0, 1).
  const auto whole = [&](std::size_t i) { return (std::uint64_t(bits[i + 1]) << 32U | bits[i]) >> 11U; };
  constexpr double unit = 0x1p-53;
  const double radius = std::sqrt(-2 * std::log(double(whole(0) + 1) * unit));
  const double angle = 2 * std::numbers::pi * (double(whole(2)) * unit);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace lagroid
