#pragma once
/// The version of the library, as three numbers, one number and words. CMake, packages and programs read it here;
/// docs/stability.md states what it promises.

#define LAGROID_VERSION_MAJOR 0
#define LAGROID_VERSION_MINOR 3
#define LAGROID_VERSION_PATCH 0

/// As one number, to be compared: 0.3.0 is 300, 1.2.3 is 10203.
#define LAGROID_VERSION_NUMBER (LAGROID_VERSION_MAJOR * 10000 + LAGROID_VERSION_MINOR * 100 + LAGROID_VERSION_PATCH)

#define LAGROID_DETAIL_WORD(x) #x
#define LAGROID_DETAIL_DOTTED(a, b, c) LAGROID_DETAIL_WORD(a) "." LAGROID_DETAIL_WORD(b) "." LAGROID_DETAIL_WORD(c)
/// In words: "0.3.0".
#define LAGROID_VERSION LAGROID_DETAIL_DOTTED(LAGROID_VERSION_MAJOR, LAGROID_VERSION_MINOR, LAGROID_VERSION_PATCH)
