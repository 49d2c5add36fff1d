#pragma once
/// Which build this is and on which machine it runs: what the bits of a result depend on, beside what was computed.
/// Checkpoints, sweeps and studies record it.

#include <string>

namespace lagroid {

/// The first digits of a hash of the sources that enter numbers, of compiler, flags and libraries, and of what the
/// instruction set came to where it was made (machine.cmake).
const char* build_hash();

/// All that numbers depend on besides what is computed, in one line: two programs with the same line give the same
/// bits. Compiler, instruction set, the versions of lagroid and of libraries, `build_hash`, and of this machine the C
/// library with the instructions of the processor by which it chooses its functions.
std::string program();
/// The processor, and `program`.
std::string machine();

}  // namespace lagroid
