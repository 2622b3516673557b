#pragma once
// For tests whose processes run in real time: what they show must not depend on how busy the
// machine is.

#include <nlohmann/json.hpp>

namespace tenon::tests {

/// Makes a run again that ended only because the machine gave the executor or the virtual arm no
/// time.
class Attempts {
 public:
  /// Whether to try once more. Waits first, longer each time, until the machine may be quieter.
  /// @param result of tenon-exec, the contents of its --json
  [[nodiscard]] bool again(const nlohmann::json& result);

 private:
  int made_ = 1;
};

}  // namespace tenon::tests
