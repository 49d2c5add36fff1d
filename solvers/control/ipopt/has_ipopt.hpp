#pragma once
/// Whether this build of the library has IPOPT.
///
///     if (!has_ipopt()) std::cerr << "install coinor-libipopt-dev\n";
///
/// Nothing is required, and nothing throws.

namespace lagroid {

bool has_ipopt();

}  // namespace lagroid
