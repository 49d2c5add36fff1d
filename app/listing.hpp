#pragma once
/// What there is, in words and as JSON.

#include <string>

namespace lagroid::app {

/// Every system with its groupoid, parameters, symmetries and conserved quantities.
std::string text_listing();

/// The same as an array of objects.
std::string json_listing();

}  // namespace lagroid::app
