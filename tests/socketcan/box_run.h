#pragma once
// The planned box task on a virtual gantry, in lockstep over two ends of a bus of the kernel.

#include <cstdint>

#include "shared/ports/can_bus.h"
#include "sim/cell/lockstep/foreign_link.h"
#include "tests/support/whole_run.h"

namespace tenon::socketcan {

/// What its master sends at once: SYNC, three commands, the heartbeat.
inline constexpr std::uint32_t kBurst_frames = 5;

class BoxRun {
 public:
  /// @param sensor_bitrate_bps of a bus that the sensor has to itself, of which both ends know; 0:
  /// there is none
  BoxRun(CanBus& master, CanBus& devices, std::uint32_t sensor_bitrate_bps = 0);

  [[nodiscard]] tests::WholeRun& lockstep() { return lockstep_; }
  [[nodiscard]] const sim::ForeignLink& link() const { return link_; }
  /// Until a move has been under way for a while. False: the run ended before.
  [[nodiscard]] bool into_motion();

 private:
  sim::ForeignLink link_;
  tests::WholeRun lockstep_;
};

}  // namespace tenon::socketcan
