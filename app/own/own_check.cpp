#include "own_check.hpp"

#include "../check/check.hpp"
#include "../check/laws/poisson_laws.hpp"

#include <utility>

namespace lagroid::app {

int own_check_program(int argc, char** argv, OwnSystems systems, AskLaws ask) {
  const LawsOfSystems laws(std::move(ask));
  const PoissonFamily brackets(systems.brackets);
  const PoissonFamilyLaws laws_of_brackets(brackets);
  return check_program(argc, argv, {{&systems_family(), &brackets}, std::move(systems.systems), {}},
                       {&laws, &laws_of_brackets});
}

}  // namespace lagroid::app
