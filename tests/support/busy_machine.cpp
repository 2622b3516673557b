#include "tests/support/busy_machine.h"

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

namespace tenon::tests {

bool Attempts::again(const nlohmann::json& result) {
  constexpr int kMost = 10;
  const std::string reason = result.value("reason", "");
  if ((reason != "overruns" && reason != "blind") || made_ == kMost) return false;
  std::printf("attempt %d: the machine was too busy: %s\n", made_,
              result.value("message", "").c_str());
  std::this_thread::sleep_for(std::chrono::seconds(made_));
  ++made_;
  return true;
}

}  // namespace tenon::tests
