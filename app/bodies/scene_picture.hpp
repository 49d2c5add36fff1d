#pragma once
/// What is shown of a scene of bodies.

#include "scene_bodies.hpp"

#include <lagroid/run/run_result.hpp>

#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// Labels of columns: "body.x".
std::string column(const std::string& body, std::string_view what);
std::vector<std::string> columns(const std::string& body, std::initializer_list<std::string_view> what);
std::vector<std::string> attitude_of(const std::string& body);
/// Of the end, "from" or "to", of a line.
std::string end_column(std::size_t line, const char* end);

/// The shapes of bodies and lines, in the columns that are recorded: those of the `chosen` bodies, or of all.
std::vector<Shape> shapes_of(const SceneBodies& bodies, const std::set<std::string>& chosen);

/// Places of the bodies whose centres move, the turning of those that turn, in space and in the plane, and their
/// momenta.
std::vector<Panel> panels_of(const SceneBodies& bodies, const std::set<std::string>& chosen);

}  // namespace lagroid::app
