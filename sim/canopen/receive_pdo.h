#pragma once
// A PDO that the slave receives. A synchronous one is kept until the next SYNC and acts then; an
// event-driven one acts at once; one shorter than its mapping is ignored and reported. One thread.

#include <optional>

#include "shared/ports/can_bus.h"
#include "sim/canopen/pdo_parameters.h"

namespace tenon::sim {

class ReceivePdo {
 public:
  enum class Result : std::uint8_t { kNotMine, kTaken, kTooShort };

  ReceivePdo(ObjectDictionary& dictionary, std::uint8_t number, const PdoDefaults& defaults)
      : parameters_(dictionary, PdoDirection::kReceive, number, defaults),
        dictionary_(dictionary) {}

  [[nodiscard]] Result receive(const CanFrame& frame);
  /// SYNC: what came since the last one acts now.
  void on_sync();
  /// Forgets what waits for a SYNC.
  void reset() { waiting_.reset(); }

 private:
  void act(const CanFrame& frame);

  PdoParameters parameters_;
  ObjectDictionary& dictionary_;
  std::optional<CanFrame> waiting_;
};

}  // namespace tenon::sim
