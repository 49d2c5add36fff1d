# Debian's emscripten. What it compiles is headers, ours and those of /usr/include, which packages.cmake finds: nothing
# that was compiled for this machine may be found.
set(EMSCRIPTEN_ROOT_PATH /usr/share/emscripten)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
# It takes options for shared libraries, of which there are none, for mistakes.
# Exceptions of WebAssembly itself: those by JavaScript cost a call out of it for every function that may throw.
# Without vectors (-msimd128): clang 14 loses numbers of them where it makes WebAssembly of optimised code, so that the
# gradient of SE(2)'s logarithm is wrong, and a sleigh's step singular.
set(CMAKE_CXX_FLAGS_INIT "-fwasm-exceptions -Wno-unused-command-line-argument")
