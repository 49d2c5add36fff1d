/// The program lagroid-check, with the laws of everything that there is.

#include "../whole_program.hpp"
#include "check.hpp"

int main(int argc, char** argv) {
  using namespace lagroid::app;
  return check_program(
      argc, argv, whole_program(),
      {&systems_laws(), &spheres_laws(), &poisson_laws(), &formula_laws(), &bodies_laws(), &control_laws()});
}
