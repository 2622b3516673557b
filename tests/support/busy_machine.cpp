#include "tests/support/busy_machine.h"

#include <chrono>
#include <cstdio>
#include <set>
#include <string>
#include <thread>

namespace tenon::tests {

bool Attempts::again(const nlohmann::json& result) {
  constexpr int kMost = 10;
  // Where the virtual arm got none, the executor hears nobody.
  const std::set<std::string> excuses = {"overruns", "blind", "bus_silent", "feedback_missing",
                                         "feedback_poor"};
  const std::string reason = result.value("arm_fault", result.value("reason", ""));
  if (!excuses.contains(reason) || made_ == kMost) return false;
  std::printf("attempt %d: the machine was too busy: %s\n", made_,
              result.value("message", "").c_str());
  std::this_thread::sleep_for(std::chrono::seconds(made_));
  ++made_;
  return true;
}

}  // namespace tenon::tests
