#include "poisson_laws.hpp"

namespace lagroid::app {

const FamilyLaws& poisson_laws() {
  static const PoissonFamilyLaws laws(library_brackets());
  return laws;
}

}  // namespace lagroid::app
