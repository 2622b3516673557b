#include "hw/can/socketcan_bus.h"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "hw/can/poll_wait.h"
#include "hw/can/socketcan_errors.h"
#include "hw/can/socketcan_link.h"
#include "shared/base/error.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::hw {
namespace {

[[noreturn]] void fail(const std::string& interface, const std::string& what) {
  const std::string reason = std::strerror(errno);
  throw InputError("CAN bus socketcan:" + interface + ": " + what + " (" + reason + ")");
}

can_frame to_kernel(const CanFrame& frame) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.remote ? CAN_RTR_FLAG : 0u);
  raw.can_dlc = std::min<std::uint8_t>(frame.length, 8);
  std::copy(frame.data.begin(), frame.data.end(), raw.data);
  return raw;
}

CanFrame from_kernel(const can_frame& raw) {
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.length = std::min<std::uint8_t>(raw.can_dlc, 8);
  std::copy(std::begin(raw.data), std::end(raw.data), frame.data.begin());
  return frame;
}

/// What the kernel tells beside a frame, where it does.
struct Ancillary {
  std::optional<std::int64_t> time_ns;
  std::optional<std::uint32_t> drops;
};

Ancillary read_ancillary(msghdr& message) {
  Ancillary ancillary;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr;
       header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET) continue;
    if (header->cmsg_type == SO_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(header), sizeof(stamp));
      ancillary.time_ns =
          monotonic_of_realtime_ns(std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec);
    } else if (header->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&ancillary.drops.emplace(), CMSG_DATA(header), sizeof(std::uint32_t));
    }
  }
  return ancillary;
}

}  // namespace

SocketcanBus::SocketcanBus(const std::string& interface, std::uint32_t bitrate_bps,
                           std::uint32_t burst_frames)
    : interface_(interface),
      socket_(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)) {
  if (!socket_.is_open()) {
    fail(interface,
         "this kernel has no CAN sockets; load can-raw (modprobe can-raw), or use slcan:");
  }
  const SocketcanLink link = read_link(interface);
  check_link(link, interface, bitrate_bps, burst_frames);
  index_ = link.index;
  configure_socket();
}

void SocketcanBus::configure_socket() {
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1;
  const int off = 0;
  const int socket = socket_.get();
  if (::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof(errors)) != 0 ||
      ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof(off)) != 0 ||
      ::setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on)) != 0 ||
      ::setsockopt(socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on)) != 0) {
    fail(interface_, "cannot set the socket's options");
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index_;
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    fail(interface_, "cannot bind");
  }
}

SendResult SocketcanBus::send(const CanFrame& frame) noexcept {
  const can_frame raw = to_kernel(frame);
  if (::write(socket_.get(), &raw, sizeof(raw)) == static_cast<ssize_t>(sizeof(raw))) {
    ++status_.sent;
    if (!status_.up) take_up();
    return SendResult::kSent;
  }
  ++status_.send_failures;
  if (errno == ENOBUFS || errno == EAGAIN || errno == EINTR) {
    return SendResult::kQueueFull;
  }
  status_.up = false;
  return SendResult::kDown;
}

bool SocketcanBus::receive(ReceivedFrame& received) noexcept {
  // Error frames are taken in on the way to the next frame.
  while (true) {
    can_frame raw{};
    iovec vector{&raw, sizeof(raw)};
    alignas(cmsghdr) std::array<char, 128> control{};
    msghdr message{};
    message.msg_iov = &vector;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = ::recvmsg(socket_.get(), &message, 0);
    if (size < 0) {
      if (errno == ENETDOWN || errno == ENODEV) {
        status_.up = false;
      } else if (!status_.up && interface_is_up()) {
        take_up();
      }
      return false;
    }
    if (size != static_cast<ssize_t>(sizeof(raw))) {
      ++status_.malformed;
      continue;
    }
    const Ancillary ancillary = read_ancillary(message);
    if (ancillary.drops) {
      status_.overruns += *ancillary.drops - kernel_drops_;
      kernel_drops_ = *ancillary.drops;
    }
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
      std::array<std::uint8_t, 8> data{};
      std::copy(std::begin(raw.data), std::end(raw.data), data.begin());
      apply_error_frame(raw.can_id & CAN_ERR_MASK, data, status_);
      continue;
    }
    // Two clocks are read one after the other to convert a time: it must not step back.
    newest_ns_ = std::max(newest_ns_, ancillary.time_ns.value_or(monotonic_now_ns()));
    received = {from_kernel(raw), newest_ns_};
    ++status_.received;
    return true;
  }
}

/// Whether the very interface that the socket is bound to is up; a new one of its name is not it.
bool SocketcanBus::interface_is_up() const noexcept {
  ifreq request{};
  std::copy(interface_.begin(), interface_.end(), request.ifr_name);
  return ::ioctl(socket_.get(), SIOCGIFINDEX, &request) == 0 && request.ifr_ifindex == index_ &&
         ::ioctl(socket_.get(), SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
}

/// A controller that was taken down and up starts anew.
void SocketcanBus::take_up() noexcept {
  status_.up = true;
  status_.bus_off = false;
  status_.error_passive = false;
}

void SocketcanBus::wait(std::int64_t at_most_ns) noexcept {
  if (at_most_ns > 0) {
    std::array<pollfd, 1> wanted{{{socket_.get(), POLLIN, 0}}};
    (void)poll_wait(wanted, at_most_ns);
  }
}

}  // namespace tenon::hw
