#pragma once
// How many documents a YAML text holds. Offline.

#include <string>

namespace tenon::config {

/// 0, 1, or 2 for more: the parser finds documents without end in some texts that are none, and a
/// reader that waited for the last would wait for ever. Throws what the parser throws.
[[nodiscard]] int yaml_documents(const std::string& text);

}  // namespace tenon::config
