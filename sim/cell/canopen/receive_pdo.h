#pragma once
// A PDO that the slave receives. A synchronous one is kept until the next SYNC and acts then; an
// event-driven one acts at once; one shorter than its mapping is ignored and reported. Where an
// event timer is set, the next one must come within it, once a first has come. One thread.

#include <cstdint>
#include <optional>

#include "shared/ports/can_bus.h"
#include "sim/cell/canopen/pdo_parameters.h"

namespace tenon::sim {

class ReceivePdo {
 public:
  enum class Result : std::uint8_t { kNotMine, kTaken, kTooShort };

  ReceivePdo(ObjectDictionary& dictionary, std::uint8_t number, const PdoDefaults& defaults)
      : parameters_(dictionary, PdoDirection::kReceive, number, defaults),
        dictionary_(dictionary) {}

  [[nodiscard]] Result receive(const CanFrame& frame, std::int64_t now_ns);
  [[nodiscard]] bool synchronous() const { return parameters_.synchronous(); }
  /// SYNC: what came since the last one acts now.
  void on_sync();
  /// Watches the deadline.
  void advance(std::int64_t now_ns);
  /// The last one was shorter than its mapping.
  [[nodiscard]] bool too_short() const { return too_short_; }
  /// The deadline has passed, and none has come since.
  [[nodiscard]] bool overdue() const { return overdue_; }
  /// Forgets what waits for a SYNC, and the deadline.
  void reset();

 private:
  void act(const CanFrame& frame);

  PdoParameters parameters_;
  ObjectDictionary& dictionary_;
  std::optional<CanFrame> waiting_;
  std::optional<std::int64_t> seen_ns_;
  bool too_short_ = false;
  bool overdue_ = false;
};

}  // namespace tenon::sim
