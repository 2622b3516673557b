#pragma once
// A CAN bus inside the process, for lockstep and tests: what one end sends, all other ends receive,
// in order, stamped with virtual time. No thread, no clock. Queues are bounded: a frame that does
// not fit is lost for that end and counted there as an overrun.
//
//   InProcessBus bus;
//   CanBus& master = bus.attach();
//   CanBus& devices = bus.attach();
//
// One thread at a time for the bus and all its ends. The bus owns its ends. attach() and the set_
// functions are set-up code; the ends' port functions neither allocate nor throw (as long as the
// filter does not).

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

class InProcessBus {
 public:
  /// Sees each frame once before it is delivered; may alter it. False: the frame is lost on the
  /// wire. `from` is the sending end in the order of attach().
  using Filter = std::function<bool(CanFrame& frame, std::size_t from)>;

  /// @param queue_frames capacity of each end's receive queue, > 0
  explicit InProcessBus(std::size_t queue_frames = 1024);
  ~InProcessBus();
  InProcessBus(const InProcessBus&) = delete;
  InProcessBus& operator=(const InProcessBus&) = delete;

  /// A new end.
  [[nodiscard]] CanBus& attach();
  /// The time that frames sent from now on carry.
  void set_time(std::int64_t now_ns) { now_ns_ = now_ns; }
  void set_filter(Filter filter) { filter_ = std::move(filter); }
  /// Down: every send() fails and status().up is false at all ends.
  void set_up(bool up) { up_ = up; }
  /// An end's controller has left the bus: it neither sends nor receives.
  void set_bus_off(std::size_t end, bool bus_off);

 private:
  class End;
  [[nodiscard]] SendResult deliver(const CanFrame& frame, std::size_t from) noexcept;

  const std::size_t queue_frames_;
  std::vector<std::unique_ptr<End>> ends_;
  Filter filter_;
  std::int64_t now_ns_ = 0;
  bool up_ = true;
};

}  // namespace tenon::hw
