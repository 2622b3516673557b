#pragma once
// What the kernel knows of a CAN interface before anything is sent: up or down, the transmit queue,
// and of a real controller its bit rate, state and mode (rtnetlink; linux/can/netlink.h). Set-up
// code: allocates, waits for the kernel's answer, any thread.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace tenon::hw {

/// In the kernel's order (enum can_state).
enum class ControllerState : std::uint8_t {
  kErrorActive = 0,
  kErrorWarning = 1,  ///< an error counter is at 96 or more
  kErrorPassive = 2,  ///< at 128 or more
  kBusOff = 3,        ///< has left the bus
  kStopped = 4,
  kSleeping = 5,
};

struct SocketcanLink {
  int index = 0;
  bool is_can = false;
  bool up = false;
  std::optional<std::uint32_t> transmit_queue_frames;  ///< unset: frames are taken at once
  std::optional<std::uint32_t> bitrate_bps;            ///< unset: a virtual interface
  std::optional<ControllerState> state;                ///< unset: a virtual interface
  bool listen_only = false;
};

/// The interface out of an RTM_NEWLINK message, its netlink header included. Pure. Unset where the
/// bytes are none.
[[nodiscard]] std::optional<SocketcanLink> parse_link(std::span<const std::uint8_t> message);

/// Asks the kernel. Throws InputError where it does not know the interface or does not answer.
[[nodiscard]] SocketcanLink read_link(const std::string& interface);

/// Throws InputError with one line that says what to do where the interface cannot serve: no CAN,
/// down, bus-off, listen-only, another bit rate (beyond 0.5 %, what a controller's clock may not
/// divide into), or a transmit queue that holds fewer than `burst_frames`.
void check_link(const SocketcanLink& link, const std::string& interface, std::uint32_t bitrate_bps,
                std::uint32_t burst_frames);

}  // namespace tenon::hw
