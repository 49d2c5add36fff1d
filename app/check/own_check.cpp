#include "own_check.hpp"

#include "check.hpp"

#include <utility>

namespace lagroid::app {

int own_check_program(int argc, char** argv, std::vector<const SystemModule*> systems, AskLaws ask) {
  const LawsOfSystems laws(std::move(ask));
  return check_program(argc, argv, {{&systems_family()}, std::move(systems), {}}, {&laws});
}

}  // namespace lagroid::app
