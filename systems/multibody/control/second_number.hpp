#pragma once
/// The scalar of a scene's second derivatives: x + a.v + b.w + v^T C w, v along three directions and w along three
/// others, or the same ones.
///
///     BasicScene<SecondNumber> scene;  // the same bodies, joints and effects as a Scene
///
/// Every factor of a scene's groupoid has three directions, so that one evaluation gives a block of the Hessian. Scenes
/// over it have the constructors and functions of BasicScene, BasicModel and `assemble`. Nothing throws.

#include <lagroid/core/scalars/hyper_dual.hpp>

namespace lagroid::multibody {

using SecondNumber = HyperDual<double, 3, 3>;

}  // namespace lagroid::multibody
