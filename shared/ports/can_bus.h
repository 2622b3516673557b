#pragma once
// One end of a CAN bus.

#include <array>
#include <cstdint>

namespace tenon {

struct CanFrame {
  std::uint32_t id = 0;   ///< 11 or 29 bits
  bool extended = false;  ///< 29-bit identifier
  bool remote = false;
  std::uint8_t length = 0;  ///< 0..8
  std::array<std::uint8_t, 8> data{};
  std::uint8_t bus = 0;  ///< which, where a port stands for several (shared/bus/bus_pair.h)

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

struct ReceivedFrame {
  CanFrame frame;
  std::int64_t time_ns = 0;  ///< monotonic, when the transport got it (virtual time in lockstep)
};

/// What the transport knows of the bus's health. Counters only grow.
struct CanBusStatus {
  bool up = true;
  bool bus_off = false;
  bool error_passive = false;
  std::uint8_t failed_bus = 0;  ///< the one that is down or bus-off, of several
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t send_failures = 0;  ///< queue full, interface down
  std::uint64_t malformed = 0;      ///< dropped as not a frame
  std::uint64_t error_frames = 0;
  std::uint64_t overruns = 0;
};

/// What has passed a bus's end since it was opened. Counters only grow.
struct CanBusTraffic {
  CanBusStatus status;
  std::uint64_t nominal_bits = 0;  ///< of all frames sent and received, without stuff bits
  std::uint64_t worst_bits = 0;    ///< with all stuff bits that there can be
};

enum class SendResult : std::uint8_t {
  kSent = 0,
  kQueueFull = 1,  ///< a missed cycle: a stale setpoint is never retried
  kDown = 2,       ///< the bus is gone
};

/// Real-time: send, receive, flush and wait neither allocate nor throw. One thread at a time.
class CanBus {
 public:
  CanBus() = default;
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;
  virtual ~CanBus() = default;

  [[nodiscard]] virtual SendResult send(const CanFrame& frame) noexcept = 0;
  /// The next frame of another node, without waiting. False: none now.
  [[nodiscard]] virtual bool receive(ReceivedFrame& received) noexcept = 0;
  /// What was sent leaves now, where a transport gathers frames. Waits for nothing.
  virtual void flush() noexcept = 0;
  /// Flushes, and waits until a frame may be there or the time has passed. In lockstep it returns
  /// at once.
  virtual void wait(std::int64_t at_most_ns) noexcept = 0;
  [[nodiscard]] virtual CanBusStatus status() const noexcept = 0;
  /// What is readable when a frame may be there, for whoever waits for several; -1: nothing is.
  [[nodiscard]] virtual int descriptor() const noexcept { return -1; }
};

}  // namespace tenon
