#pragma once
/// The files of own/templates, in the program.

#include <string_view>

namespace lagroid::app::templates {

std::string_view system();
std::string_view groupoid();
std::string_view cmake();
std::string_view scene();
std::string_view bracket();
std::string_view bracket_scene();

}  // namespace lagroid::app::templates
