#pragma once
/// `lagroid run SYSTEM.cpp`: a system of one's own from its source.

namespace lagroid::app {

/// Whether the command line is one: run, and a file that ends in .cpp, .cc or .cxx.
bool names_a_source(int argc, char** argv);

/// Builds the program and runs it: `lagroid run dido.cpp` as `dido run dido.toml`, the scene beside the source;
/// `lagroid run dido.cpp circle.toml --out out/circle` as `dido run circle.toml --out out/circle`; `lagroid run
/// dido.cpp study dido.toml` as `dido study dido.toml`. Where there is no such scene, with no words. Returns the exit
/// code.
int run_source(int argc, char** argv);

}  // namespace lagroid::app
