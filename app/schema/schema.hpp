#pragma once
/// `lagroid schema`: a JSON Schema of scenes for editors, from the declarations by which scenes are read.

#include "../command/parser.hpp"

#include <string>

namespace lagroid::app {

struct SchemaOptions {
  std::string kind;  ///< of scenes; empty: of all kinds
};

void add_schema_options(CLI::App& command, SchemaOptions& options);

/// Prints the schema. Returns the exit code.
int schema(const SchemaOptions& options);

}  // namespace lagroid::app
