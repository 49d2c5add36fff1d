/// toml++, compiled once: Debian has it as headers, and as a library for its own machines alone.

#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
