/// The program lagroid, with everything that there is.

#include "program.hpp"
#include "whole_program.hpp"

int main(int argc, char** argv) { return lagroid::app::program(argc, argv, lagroid::app::whole_program()); }
