// A program that knows no effect at all: bare STEPS.
#include "base_scene.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  effects::Base base;
  return effects::integrate(std::move(base.scene), std::atol(argv[1]));
}
