/// The program lagroid, with everything that there is.

#include "own/run_source.hpp"
#include "program.hpp"
#include "whole_program.hpp"

int main(int argc, char** argv) {
  using namespace lagroid::app;
  return names_a_source(argc, argv) ? run_source(argc, argv) : program(argc, argv, whole_program());
}
