#pragma once
// Carries out faults on a bus, virtual or foreign: it decides what becomes of each frame. Faults of
// devices among them are left to the devices. Each fault draws from a source of its own, once for
// each frame that it may strike, so nobody else's draws change what it does. One thread.

#include <cstdint>
#include <span>
#include <vector>

#include "shared/base/random.h"
#include "sim/cell/bus/disturbance.h"
#include "sim/cell/faults/fault.h"
#include "sim/cell/faults/fault_phases.h"
#include "sim/cell/faults/frame_sender.h"

namespace tenon::sim {

class BusFaults final : public Disturbance {
 public:
  /// @param master_node of the robot; a fault names it to mean the master's frames
  /// @param on_ns when the cell was switched on: time 0 of the faults
  /// @param phases of the cell, for faults that wait for one; must outlive this
  BusFaults(std::span<const Fault> faults, std::uint8_t master_node, std::int64_t on_ns = 0,
            const FaultPhases* phases = nullptr);

  [[nodiscard]] SendResult admit(const CanFrame& frame, std::int64_t now_ns) noexcept override;
  [[nodiscard]] Fate fate(CanFrame& frame, std::size_t end, std::int64_t now_ns) noexcept override;
  [[nodiscard]] bool down(std::int64_t now_ns) const noexcept override;
  [[nodiscard]] bool bus_off(std::uint8_t node, std::int64_t now_ns) const noexcept override;

  /// Frames that a fault has struck so far.
  [[nodiscard]] std::uint64_t struck() const { return struck_; }

 private:
  struct Active {
    Fault fault;
    Random source;
    bool spent = false;  ///< of those that strike once
  };

  [[nodiscard]] bool lasts(const Active& active, std::int64_t now_ns) const;
  [[nodiscard]] bool means(const Fault& fault, const CanFrame& frame) const;
  [[nodiscard]] bool strikes(Active& active, const CanFrame& frame, std::int64_t now_ns);

  FrameSender sender_;
  std::int64_t on_ns_;
  const FaultPhases* phases_;
  std::vector<Active> active_;
  std::uint64_t struck_ = 0;
};

/// The faults that a cell's devices carry out themselves. A device whose controller leaves the bus
/// neither sends nor hears: to the device that is silence.
[[nodiscard]] std::vector<Fault> faults_of_devices(std::span<const Fault> faults,
                                                   std::uint8_t master_node);

}  // namespace tenon::sim
