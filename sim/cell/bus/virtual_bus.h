#pragma once
// A CAN bus in virtual time (ISO 11898-1:2015). No thread, no clock: the caller's time drives it.
//
//   VirtualBus bus({.bitrate_bps = 1'000'000});
//   CanBus& master = bus.attach();
//   CanBus& device = bus.attach();
//   (void)master.send(frame);                    // queued now
//   bus.advance(bus.next_event_ns());            // to the end of the frame
//   (void)device.receive(received);              // stamped with that instant
//
//   end A   queue ─┐ arbitration at each idle instant: the lowest identifier wins
//   end B   queue ─┴──> wire: one frame at a time ──> all other ends, at the end of the frame
//
// A frame takes as long as its bits (sim/cell/bus/frame_bits.h) and three of intermission. It gets
// through where at least one other end is there to acknowledge it; else, and where a bit was
// destroyed, an error frame follows and the frame is sent again. Error counters go by the
// standard's rules (10.11, 12.1): at 128 error passive, with a pause of eight bits after sending;
// at a transmit count of 256 bus-off until recover(). Two ends that send the same identifier at
// once are not modelled: the end attached first wins.
//
// With a bit rate of 0 frames take no time: send() delivers before it returns.
//
// All of it is deterministic; equal seeds give equal bits. One thread for the bus and all its ends;
// the bus owns its ends. After attach() nothing allocates, as long as nothing is delayed.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "shared/base/random.h"
#include "shared/ports/can_bus.h"
#include "sim/cell/bus/disturbance.h"
#include "sim/cell/bus/frame_bits.h"

namespace tenon::sim {

class VirtualBus {
 public:
  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

  struct Parameters {
    std::uint32_t bitrate_bps = 1'000'000;  ///< 0: frames take no time
    /// Above 0, data frames are FD frames that switch to this rate.
    std::uint32_t data_bitrate_bps = 0;
    double bit_error_rate = 0.0;  ///< probability that a bit is destroyed for everybody
    std::uint64_t seed = 1;       ///< of these errors
  };

  enum class Order : std::uint8_t {
    kFifo,          ///< as SocketCAN and most adapters do
    kByIdentifier,  ///< lowest first: several nodes behind one end, or a controller with mailboxes
  };

  struct EndParameters {
    Order order = Order::kFifo;
    std::uint8_t node = 0;  ///< for disturbances of one node; 0: several, or none
    std::size_t transmit_frames = 64;
    std::size_t receive_frames = 1024;
  };

  /// A frame that has been sent, for whoever measures.
  struct Transmission {
    CanFrame frame;
    std::size_t end = 0;  ///< the sender, in the order of attach()
    std::int64_t queued_ns = 0;
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;  ///< without the intermission
    FrameBits bits;
  };
  using Observer = std::function<void(const Transmission&)>;

  struct ErrorCounters {
    std::uint32_t transmit = 0;
    std::uint32_t receive = 0;
  };

  struct Statistics {
    std::uint64_t frames = 0;
    std::uint64_t error_frames = 0;
    std::int64_t busy_ns = 0;  ///< frames, error frames and intermissions
  };

  explicit VirtualBus(const Parameters& parameters);
  ~VirtualBus();
  VirtualBus(const VirtualBus&) = delete;
  VirtualBus& operator=(const VirtualBus&) = delete;

  /// A new end.
  [[nodiscard]] CanBus& attach(const EndParameters& parameters);
  [[nodiscard]] CanBus& attach() { return attach(EndParameters{}); }

  /// Time passes, frames with it. Times must not decrease.
  void advance(std::int64_t until_ns);
  /// When the next frame arrives or fails, as the queues stand; kNever_ns where nothing is going
  /// on.
  [[nodiscard]] std::int64_t next_event_ns() const;
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }

  /// Down: every send() fails, queues are emptied, status().up is false at all ends.
  void set_up(bool up);
  /// As an end's controller leaves the bus, or is back at once.
  void set_bus_off(std::size_t end, bool bus_off);
  /// An end that is bus-off comes back after 128 times eleven recessive bits.
  void recover(std::size_t end);

  /// Null: none. Must outlive its use.
  void set_disturbance(Disturbance* disturbance) { disturbance_ = disturbance; }
  /// Is told of each frame that got through, before its receivers can take it.
  void set_observer(Observer observer) { observer_ = std::move(observer); }

  /// Frames that an end has not received yet, and that it has not got rid of yet.
  [[nodiscard]] std::size_t arrived(std::size_t end) const;
  [[nodiscard]] std::size_t queued(std::size_t end) const;
  [[nodiscard]] ErrorCounters error_counters(std::size_t end) const;
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }

 private:
  class End;
  enum class Ending : std::uint8_t { kAcknowledged, kNotAcknowledged, kDestroyed };
  /// The frame on the wire, or the one that comes next.
  struct Attempt {
    std::size_t end = 0;
    std::size_t place = 0;  ///< in the end's queue
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;   ///< of the frame, or of the bit in which it fails
    std::int64_t idle_ns = 0;  ///< the bus is free again
    Ending ending = Ending::kAcknowledged;
  };
  struct Delayed {
    ReceivedFrame received;
    std::size_t from = 0;
  };

  [[nodiscard]] SendResult send(const CanFrame& frame, End& end) noexcept;
  [[nodiscard]] std::optional<Attempt> plan() const;
  void begin(Attempt attempt);
  void finish(const Attempt& attempt);
  void fail(const Attempt& attempt);
  void deliver(const CanFrame& frame, std::size_t from, std::int64_t time_ns);
  void deliver_delayed();
  void deliver_at_once();
  void update_states();
  [[nodiscard]] bool acknowledged(std::size_t from) const;
  [[nodiscard]] bool destroyed_bit(const FrameBits& bits, std::uint32_t& bit);
  [[nodiscard]] FrameBits bits_of(const CanFrame& frame) const;
  [[nodiscard]] std::int64_t duration_ns(const FrameBits& bits) const;
  [[nodiscard]] std::int64_t bits_ns(std::uint32_t bits) const;

  const Parameters parameters_;
  std::vector<std::unique_ptr<End>> ends_;
  Disturbance* disturbance_ = nullptr;
  Observer observer_;
  Random noise_;
  std::int64_t now_ns_ = 0;
  std::int64_t idle_ns_ = 0;  ///< since when, or from when on, the bus is free
  std::optional<Attempt> on_wire_;
  std::vector<Delayed> delayed_;
  Statistics statistics_;
  bool up_ = true;
  bool disturbed_ = false;  ///< a disturbance has taken it down
};

}  // namespace tenon::sim
