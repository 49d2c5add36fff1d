#pragma once
/// What there is, in words and as JSON.

#include <string>

namespace lagroid::app {

/// Every system, or the one with that name, with its groupoid, parameters, symmetries and conserved quantities. Throws
/// CLI::ValidationError for a name that no system has.
std::string text_listing(const std::string& name = "");

/// The same as an array of objects.
std::string json_listing(const std::string& name = "");

}  // namespace lagroid::app
