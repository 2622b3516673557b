#pragma once
// The loop around an identification's motion, as CycleRunner is the loop around a controller:
// begin() and finish() without a clock, run() on it. It keeps no statistics and no black box; a
// loop that comes late skips whole periods, which stretches the motion. Real-time after
// construction, one thread; refers to arm and motion, which must outlive it.

#include <atomic>
#include <cstdint>

#include "executor/identification/identification_motion.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class IdentificationRunner {
 public:
  IdentificationRunner(Arm& arm, IdentificationMotion& motion);

  void begin(std::int64_t now_ns) noexcept;
  /// False once it is over.
  bool finish(std::int64_t now_ns) noexcept;

  /// Runs to the end on the clock. @param stop set by anyone to end it in good order
  void run(const std::atomic<bool>& stop) noexcept;

 private:
  void decide(std::int64_t now_ns) noexcept;

  Arm& arm_;
  IdentificationMotion& motion_;
  std::int64_t cycle_ns_;
  ArmFeedback feedback_;
};

}  // namespace tenon::executor
