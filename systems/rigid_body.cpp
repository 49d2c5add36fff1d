#include <lagroid/systems/rigid_body.hpp>

template lagroid::TwoSidedOf<lagroid::RigidBody> lagroid::automatic_two_sided(const RigidBody&, const ArrowOf<SO3>&,
                                                                              const RigidBody::Multipliers&);
