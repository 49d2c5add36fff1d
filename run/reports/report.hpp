#pragma once
/// A run in words and as JSON.
///
///     std::cout << text_report(result);  // what was run, how it ended, the ledger
///     file << json_report(result);       // the same for programs; keys: docs/scenes.md

#include <lagroid/run/run_result.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace lagroid {

/// The summary a person reads: what was run, how it ended, the ledger.
std::string text_report(const RunResult& result);

/// One JSON object; numbers read back to the same doubles. Keys: docs/scenes.md.
std::string json_report(const RunResult& result);

/// The plot panels in such a summary. Throws nlohmann::json::exception where there are none.
std::vector<Panel> panels_of(const nlohmann::ordered_json& summary);

/// A panel, and a shape, as they stand in it.
nlohmann::ordered_json panel_json(const Panel& panel);
nlohmann::ordered_json shape_json(const Shape& shape);

/// What was watched for in such a summary, without what happened; nothing where there is none. Throws as `panels_of`.
EventTable events_of(const nlohmann::ordered_json& summary);

/// The JSON object for a run that never began: status "invalid_scene" and the message.
std::string json_error(const std::string& status, const std::string& message);

}  // namespace lagroid
