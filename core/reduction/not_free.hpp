#pragma once
/// Points where a symmetry does not act freely: there is nothing to reduce to.

#include <lagroid/core/morphism.hpp>

#include <sstream>
#include <stdexcept>

namespace lagroid {

/// Thrown where a run would start at an object that the symmetry leaves where it is, as rotations do the origin. A step
/// that leads to one is not admissible, and its status tells it.
struct NotFree : std::domain_error {
  using std::domain_error::domain_error;
};

/// Throws NotFree unless the symmetry of phi acts freely over m.
template <class Phi> void require_free(const Phi& phi, const ObjectOf<typename Phi::Codomain>& m) {
  if constexpr (FreeInPart<Phi>) {
    if (phi.free_at(m)) return;
    std::ostringstream message;
    message << Phi::Domain::name() << " -> " << Phi::Codomain::name()
            << ": the symmetry does not act freely at the object (" << phi.to.coordinates_of_object(m).transpose()
            << "): nothing is reduced there; start elsewhere, or run the full system";
    throw NotFree(message.str());
  }
}

}  // namespace lagroid
