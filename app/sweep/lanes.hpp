#pragma once
/// Members in the lanes of registers.

#include "members.hpp"

#include <memory>
#include <string>

namespace lagroid::app {

/// Why the members cannot be integrated together in lanes; empty where they can: initial values of a system of which
/// ensembles are compiled (systems/ensembles.hpp), by plain steps, of which nothing but [initial] varies and of which
/// no ledger is kept.
std::string why_no_lanes(const Section& scene, const Design& design, const KeptColumns& keep);

/// The same results as `scene_runner`, but for round-off, and without counts of iterations; null where there are none.
std::unique_ptr<MemberRunner> lane_runner(const Section& scene, const Design& design, const KeptColumns& keep);

}  // namespace lagroid::app
