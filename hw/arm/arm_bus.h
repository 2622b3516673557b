#pragma once
// The bus of an arm as its parts see it, whether or not the force/torque sensor has one to itself.
// Where it has, this knows what goes where:
//
//   SYNC, the master's heartbeat      to both, where the sensor is a CANopen node
//   NMT, SDO of the sensor's node     to the sensor's bus
//   what names its bus                there: what a sensor that is no node is asked
//   everything else                   to the arm's
//
// and hears on each what belongs there: who else uses a bus may give his frames any identifier that
// the other bus knows, and is nobody's answer. Such frames count as unexpected.
//
// Real-time; one thread; the bus outlives it.

#include <bitset>
#include <cstdint>

#include "hw/arm/arm_counters.h"
#include "shared/cell/robot.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class ArmBus final : public CanBus {
 public:
  /// @param bus of a robot whose sensor has a bus to itself: both (shared/bus/bus_pair.h)
  /// @param counters outlives it
  ArmBus(const Robot& robot, CanBus& bus, ArmCounters& counters);

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void flush() noexcept override { bus_.flush(); }
  void wait(std::int64_t at_most_ns) noexcept override { bus_.wait(at_most_ns); }
  [[nodiscard]] CanBusStatus status() const noexcept override { return bus_.status(); }
  [[nodiscard]] int descriptor() const noexcept override { return bus_.descriptor(); }

 private:
  static constexpr std::size_t kIdentifiers = 0x800;
  enum class Way : std::uint8_t { kAsNamed, kSensor, kBoth };

  [[nodiscard]] Way way_of(const CanFrame& frame) const noexcept;
  [[nodiscard]] bool belongs(const CanFrame& frame) const noexcept;

  CanBus& bus_;
  ArmCounters& counters_;
  const bool apart_;
  const std::uint8_t sensor_node_;
  const std::uint8_t master_node_;
  std::bitset<kIdentifiers> sensors_;  ///< identifiers of the sensor alone, by either end
  std::bitset<kIdentifiers> common_;   ///< of the master, on both buses
};

}  // namespace tenon::hw
