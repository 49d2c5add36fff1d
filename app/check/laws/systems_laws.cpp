#include "../certify_system.hpp"
#include "../family_laws.hpp"

namespace lagroid::app {

const FamilyLaws& systems_laws() {
  static const LawsOfSystems laws(certify_system);
  return laws;
}

}  // namespace lagroid::app
