#pragma once
// What planning is at, told line by line with the seconds since it began. One thread.

#include <functional>
#include <string>
#include <utility>

#include "planner/judge/timed.h"
#include "shared/base/text.h"

namespace tenon::planner {

class Progress {
 public:
  /// @param to may be empty: then nothing is told
  Progress(std::function<void(const std::string&)> to, ClockSeconds now_s)
      : to_(std::move(to)), now_s_(std::move(now_s)), began_s_(now_s_()), told_s_(began_s_) {}

  void tell(const std::string& what) {
    if (!to_) return;
    told_s_ = now_s_();
    to_(format("%6.1f s: ", told_s_ - began_s_) + what);
  }

  /// For so long that another line is due: nothing is to be silent for 2 s.
  [[nodiscard]] bool is_silent() const { return to_ && now_s_() - told_s_ >= kSilent_s; }

  [[nodiscard]] double since_began_s() const { return now_s_() - began_s_; }

 private:
  static constexpr double kSilent_s = 1.0;

  std::function<void(const std::string&)> to_;
  ClockSeconds now_s_;
  double began_s_;
  double told_s_;
};

}  // namespace tenon::planner
