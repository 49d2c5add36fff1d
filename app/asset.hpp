#pragma once
/// Files built into the program.

#include <cstddef>
#include <string_view>

/// Defines `std::string_view space::name()`, the contents of a file, which the assembler reads as it is. `symbol` is
/// what the linker calls it.
#define LAGROID_ASSET(space, name, symbol, file)                                                                     \
  asm(".section .rodata\n.global " #symbol "\n" #symbol ":\n.incbin \"" file "\"\n.global " #symbol "_end\n" #symbol \
      "_end:\n.byte 0\n.previous\n");                                                                                \
  extern "C" const char symbol[];                                                                                    \
  extern "C" const char symbol##_end[];                                                                              \
  namespace space {                                                                                                  \
  std::string_view name() { return {symbol, std::size_t(symbol##_end - symbol)}; }                                   \
  }
