// Headers alone: arrows compose, and the product with the inverse is a unit.
#include "spring.hpp"

#include <cstdio>

int main() {
  const PolarPairs groupoid;
  const lagroid::Vector<double, 4> g(1, 0, 1.5, 2);
  const auto unit = groupoid.compose(g, groupoid.inverse(g));
  const bool is_unit = (unit - groupoid.unit(groupoid.source(g))).norm() == 0;
  std::printf("g g^-1 is %s\n", is_unit ? "a unit" : "NO UNIT");
  return is_unit ? 0 : 1;
}
