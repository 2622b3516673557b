#pragma once
// What an arm counts. Only grow; for telemetry.

#include <cstdint>

namespace tenon::hw {

struct ArmCounters {
  std::uint64_t cycles = 0;
  std::uint64_t joint_frames_missing = 0;  ///< joint cycles that closed without feedback
  std::uint64_t wrenches_missing = 0;      ///< cycles that closed without a new wrench
  std::uint64_t wrench_halves_torn = 0;
  std::uint64_t late_frames = 0;       ///< process data that came after its cycle had closed
  std::uint64_t malformed_frames = 0;  ///< known identifier, wrong length
  std::uint64_t unexpected_frames = 0;
  std::uint64_t emergencies = 0;
  std::uint64_t send_failures = 0;
  std::uint64_t invalid_setpoints = 0;  ///< not finite: they were not sent
  std::uint64_t unbraked_axes = 0;      ///< told to stop they ran on, and lost their voltage
};

}  // namespace tenon::hw
