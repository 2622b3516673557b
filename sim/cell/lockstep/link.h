#pragma once
// What lies between a master and a virtual cell: two ends of a bus, and the time that frames take.
// One thread.

#include <cstdint>

#include "shared/ports/can_bus.h"

namespace tenon::sim {

class Link {
 public:
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  virtual ~Link() = default;

  [[nodiscard]] virtual CanBus& master() = 0;
  [[nodiscard]] virtual CanBus& devices() = 0;

  /// Lets frames travel until one arrives somewhere, at most until `until_ns`; the time it is then.
  /// Times must not decrease.
  [[nodiscard]] virtual std::int64_t advance(std::int64_t until_ns) = 0;

  /// Something waits to be received.
  [[nodiscard]] virtual bool at_master() const = 0;
  [[nodiscard]] virtual bool at_devices() const = 0;
  /// Something that the master has sent is not through yet.
  [[nodiscard]] virtual bool from_master() const = 0;
};

}  // namespace tenon::sim
