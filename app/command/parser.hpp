#pragma once
/// The parser of command lines by its name alone: CLI11 is included where options are added.

namespace CLI {
class App;
class Validator;
}  // namespace CLI
