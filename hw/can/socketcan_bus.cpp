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

#include "hw/can/monotonic_clock.h"
#include "hw/can/poll_wait.h"
#include "hw/can/socketcan_errors.h"
#include "shared/base/error.h"

namespace tenon::hw {
namespace {

[[noreturn]] void refuse(int socket, const std::string& interface, const std::string& what) {
  const std::string reason = std::strerror(errno);
  if (socket >= 0) ::close(socket);
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

/// What the kernel tells beside a frame.
struct Ancillary {
  std::int64_t time_ns = 0;  ///< 0 where it gives none
  std::uint32_t drops = 0;
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
      std::memcpy(&ancillary.drops, CMSG_DATA(header), sizeof(ancillary.drops));
    }
  }
  return ancillary;
}

}  // namespace

SocketcanBus::SocketcanBus(const std::string& interface) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) {
    throw InputError("CAN bus socketcan:" + interface + ": an interface has a name of 1.." +
                     std::to_string(IFNAMSIZ - 1) + " characters, such as can0");
  }
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor < 0) {
    refuse(descriptor, interface,
           "this kernel has no CAN sockets; load can-raw (modprobe can-raw), or use slcan:");
  }
  ifreq request{};
  std::copy(interface.begin(), interface.end(), request.ifr_name);
  if (::ioctl(descriptor, SIOCGIFINDEX, &request) != 0) {
    refuse(descriptor, interface, "no such interface; list them with 'ip link show type can'");
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (::ioctl(descriptor, SIOCGIFFLAGS, &request) != 0 || (request.ifr_flags & IFF_UP) == 0) {
    errno = ENETDOWN;
    refuse(descriptor, interface,
           "the interface is down; 'ip link set " + interface + " up type can bitrate 1000000'");
  }
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1;
  const int off = 0;
  if (::setsockopt(descriptor, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof(errors)) != 0 ||
      ::setsockopt(descriptor, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof(off)) != 0 ||
      ::setsockopt(descriptor, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on)) != 0 ||
      ::setsockopt(descriptor, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on)) != 0) {
    refuse(descriptor, interface, "cannot set the socket's options");
  }
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    refuse(descriptor, interface, "cannot bind");
  }
  socket_ = descriptor;
}

SocketcanBus::~SocketcanBus() { ::close(socket_); }

SendResult SocketcanBus::send(const CanFrame& frame) noexcept {
  const can_frame raw = to_kernel(frame);
  if (::write(socket_, &raw, sizeof(raw)) == static_cast<ssize_t>(sizeof(raw))) {
    ++status_.sent;
    status_.up = true;
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
    const ssize_t size = ::recvmsg(socket_, &message, 0);
    if (size < 0) {
      if (errno == ENETDOWN || errno == ENODEV) status_.up = false;
      return false;
    }
    if (size != static_cast<ssize_t>(sizeof(raw))) {
      ++status_.malformed;
      continue;
    }
    const Ancillary ancillary = read_ancillary(message);
    status_.overruns += ancillary.drops - kernel_drops_;
    kernel_drops_ = ancillary.drops;
    status_.up = true;
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
      std::array<std::uint8_t, 8> data{};
      std::copy(std::begin(raw.data), std::end(raw.data), data.begin());
      apply_error_frame(raw.can_id & CAN_ERR_MASK, data, status_);
      continue;
    }
    received = {from_kernel(raw), ancillary.time_ns != 0 ? ancillary.time_ns : monotonic_now_ns()};
    ++status_.received;
    return true;
  }
}

void SocketcanBus::wait(std::int64_t at_most_ns) noexcept {
  if (at_most_ns > 0) {
    std::array<pollfd, 1> wanted{{{socket_, POLLIN, 0}}};
    (void)poll_wait(wanted, at_most_ns);
  }
}

}  // namespace tenon::hw
