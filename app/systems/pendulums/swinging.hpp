#pragma once
/// What reports say of a bob on a rod that swings in a plane.

#include <lagroid/run/motion/presentation.hpp>

namespace lagroid::app {

template <class Sys> void dress_swinging(Presentation<Sys>& p, const Sys& system) {
  p.position = {"q"};
  p.position_unit = "rad";
  p.momentum = {"p"};
  p.momentum_unit = "kg m^2/s";
  p.conventions = {{"state", "object q and momentum p at the nodes"}};
  p.panels = {{"angle", "t", "q", "t", {"q"}}, {"phase plane", "q", "p", "q", {"p"}}};
  p.shapes = hanging(system.length, "q");
}

}  // namespace lagroid::app
