#pragma once
/// Counts every heap allocation of the program, Eigen's and the standard library's alike.

namespace lagroid {

/// Allocations so far; negative where they can not be counted (under AddressSanitizer).
long allocation_count();

}  // namespace lagroid
