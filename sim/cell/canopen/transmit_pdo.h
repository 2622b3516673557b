#pragma once
// A PDO that the slave sends: with every n-th SYNC (types 1 to 240), with a SYNC after a change
// (0), or on change and by its event timer, no faster than its inhibit time (254, 255); and
// whenever a remote frame asks, unless bit 30 of its COB-ID forbids it. One thread.

#include <cstdint>
#include <optional>
#include <vector>

#include "shared/ports/can_bus.h"
#include "sim/cell/canopen/pdo_parameters.h"

namespace tenon::sim {

class TransmitPdo {
 public:
  TransmitPdo(ObjectDictionary& dictionary, std::uint8_t number, const PdoDefaults& defaults)
      : parameters_(dictionary, PdoDirection::kTransmit, number, defaults) {}

  /// @param counter of the SYNC; 0: it has none
  void on_sync(std::uint8_t counter, std::int64_t now_ns, std::vector<CanFrame>& outbox);
  void on_remote(std::uint32_t id, std::int64_t now_ns, std::vector<CanFrame>& outbox);
  /// The event-driven types.
  void advance(std::int64_t now_ns, std::vector<CanFrame>& outbox);
  void reset();
  /// A fault to inject: the next synchronous one carries the data of the one before.
  void repeat_once() { repeat_ = true; }

 private:
  [[nodiscard]] CanFrame sample() const;
  void send(const CanFrame& frame, std::int64_t now_ns, std::vector<CanFrame>& outbox);

  PdoParameters parameters_;
  std::uint8_t syncs_ = 0;
  bool started_ = false;  ///< the SYNC of the start value has come
  bool repeat_ = false;
  std::optional<CanFrame> last_;
  std::int64_t last_ns_ = 0;
};

}  // namespace tenon::sim
