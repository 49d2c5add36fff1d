#pragma once
/// The scene that another file refers to: `scene = "FILE"`, or the table [scene].
///
///     const Section scene = read_its_scene(read_scene("sweep.toml", {}));

#include "scene_reader.hpp"

namespace lagroid::app {

/// `scene = "FILE"`, seen from the file that names it, or from the working folder where it is not there; or the table
/// [scene], which is the scene itself, or `file` and what is to differ from it. Throws SceneError.
Section read_its_scene(const Section& whole);

}  // namespace lagroid::app
