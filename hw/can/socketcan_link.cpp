#include "hw/can/socketcan_link.h"

#include <errno.h>
#include <linux/can/netlink.h>
#include <linux/if.h>
#include <linux/if_arp.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "shared/base/error.h"
#include "shared/system/descriptor.h"

namespace tenon::hw {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kAnswerMax_bytes = 65536;

/// A kernel structure off the front of `bytes`; false where they are too few.
template <typename Structure>
bool read_front(Bytes bytes, Structure& structure) {
  if (bytes.size() < sizeof(structure)) return false;
  std::memcpy(&structure, bytes.data(), sizeof(structure));
  return true;
}

/// Calls visit(type, payload) for each attribute, up to the first that does not fit.
template <typename Visit>
void for_each_attribute(Bytes bytes, Visit visit) {
  rtattr head{};
  while (read_front(bytes, head) && head.rta_len >= sizeof(head) && head.rta_len <= bytes.size()) {
    visit(head.rta_type & NLA_TYPE_MASK, bytes.subspan(sizeof(head), head.rta_len - sizeof(head)));
    bytes = bytes.subspan(std::min<std::size_t>(bytes.size(), RTA_ALIGN(head.rta_len)));
  }
}

std::string_view text_of(Bytes payload) {
  const auto end = std::find(payload.begin(), payload.end(), std::uint8_t{0});
  return {reinterpret_cast<const char*>(payload.data()),
          static_cast<std::size_t>(end - payload.begin())};
}

void take_controller(Bytes data, SocketcanLink& link) {
  for_each_attribute(data, [&link](int type, Bytes payload) {
    can_bittiming timing{};
    can_ctrlmode mode{};
    std::uint32_t state = 0;
    if (type == IFLA_CAN_BITTIMING && read_front(payload, timing) && timing.bitrate > 0) {
      link.bitrate_bps = timing.bitrate;
    } else if (type == IFLA_CAN_STATE && read_front(payload, state) && state < CAN_STATE_MAX) {
      link.state = static_cast<ControllerState>(state);
    } else if (type == IFLA_CAN_CTRLMODE && read_front(payload, mode)) {
      link.listen_only = (mode.flags & CAN_CTRLMODE_LISTENONLY) != 0;
    }
  });
}

void take_link_info(Bytes info, SocketcanLink& link) {
  bool controller = false;
  for_each_attribute(info, [&](int type, Bytes payload) {
    if (type == IFLA_INFO_KIND) controller = text_of(payload) == "can";
    if (type == IFLA_INFO_DATA && controller) take_controller(payload, link);
  });
}

[[noreturn]] void refuse(const std::string& interface, const std::string& what) {
  throw InputError("CAN bus socketcan:" + interface + ": " + what);
}

/// RTM_GETLINK of one interface.
std::vector<std::uint8_t> question(const std::string& interface) {
  const auto name_bytes = static_cast<unsigned short>(interface.size() + 1);
  nlmsghdr header{};
  ifinfomsg info{};
  rtattr name{};
  name.rta_type = IFLA_IFNAME;
  name.rta_len = static_cast<unsigned short>(RTA_LENGTH(name_bytes));
  header.nlmsg_type = RTM_GETLINK;
  header.nlmsg_flags = NLM_F_REQUEST;
  header.nlmsg_len = static_cast<std::uint32_t>(NLMSG_LENGTH(sizeof(info)) + RTA_SPACE(name_bytes));
  std::vector<std::uint8_t> bytes(header.nlmsg_len);
  std::uint8_t* to = bytes.data();
  std::memcpy(to, &header, sizeof(header));
  std::memcpy(to + NLMSG_HDRLEN, &info, sizeof(info));
  std::memcpy(to + NLMSG_LENGTH(sizeof(info)), &name, sizeof(name));
  std::memcpy(to + NLMSG_LENGTH(sizeof(info)) + RTA_LENGTH(0), interface.data(), interface.size());
  return bytes;
}

/// Empty where there is no answer.
std::vector<std::uint8_t> ask_kernel(const std::vector<std::uint8_t>& asked) {
  std::vector<std::uint8_t> answer(kAnswerMax_bytes);
  const Descriptor socket(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  ssize_t size = -1;
  if (::send(socket.get(), asked.data(), asked.size(), 0) >= 0) {
    size = ::recv(socket.get(), answer.data(), answer.size(), 0);
  }
  answer.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return answer;
}

}  // namespace

std::optional<SocketcanLink> parse_link(Bytes message) {
  nlmsghdr header{};
  ifinfomsg info{};
  if (!read_front(message, header) || header.nlmsg_type != RTM_NEWLINK ||
      header.nlmsg_len > message.size() || header.nlmsg_len < NLMSG_LENGTH(sizeof(info))) {
    return std::nullopt;
  }
  message = message.first(header.nlmsg_len).subspan(NLMSG_HDRLEN);
  if (!read_front(message, info)) return std::nullopt;

  SocketcanLink link;
  link.index = info.ifi_index;
  link.is_can = info.ifi_type == ARPHRD_CAN;
  link.up = (info.ifi_flags & IFF_UP) != 0;
  bool queues = true;
  for_each_attribute(message.subspan(NLMSG_ALIGN(sizeof(info))), [&](int type, Bytes payload) {
    std::uint32_t frames = 0;
    if (type == IFLA_TXQLEN && read_front(payload, frames)) link.transmit_queue_frames = frames;
    if (type == IFLA_QDISC) queues = text_of(payload) != "noqueue";
    if (type == IFLA_LINKINFO) take_link_info(payload, link);
  });
  if (!queues) link.transmit_queue_frames.reset();
  return link;
}

SocketcanLink read_link(const std::string& interface) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) {
    refuse(interface, "an interface has a name of 1.." + std::to_string(IFNAMSIZ - 1) +
                          " characters, such as can0");
  }
  const std::vector<std::uint8_t> answer = ask_kernel(question(interface));
  if (const auto link = parse_link(answer)) return *link;
  nlmsghdr header{};
  nlmsgerr error{};
  if (read_front(answer, header) && header.nlmsg_type == NLMSG_ERROR &&
      read_front(Bytes(answer).subspan(NLMSG_HDRLEN), error)) {
    errno = -error.error;
  }
  if (errno == ENODEV) {
    refuse(interface, "no such interface; list them with 'ip link show type can'");
  }
  refuse(interface, std::string("the kernel does not tell the interface's state (") +
                        std::strerror(errno) + ")");
}

void check_link(const SocketcanLink& link, const std::string& interface, std::uint32_t bitrate_bps,
                std::uint32_t burst_frames) {
  if (!link.is_can)
    refuse(interface, "is no CAN interface; list them with 'ip link show type can'");
  const std::string set_up =
      "'ip link set " + interface + " up" +
      (link.state ? " type can bitrate " + std::to_string(bitrate_bps) : std::string()) + "'";
  const std::string set_again = "'ip link set " + interface + " down', then " + set_up;
  if (!link.up) refuse(interface, "the interface is down; " + set_up);
  if (link.state == ControllerState::kBusOff) {
    refuse(interface,
           "the controller is bus-off; check wiring, termination and every node's bit "
           "rate, then " +
               set_again);
  }
  if (link.listen_only) {
    refuse(interface, "the controller only listens, nothing would be sent; 'ip link set " +
                          interface + " down', then 'ip link set " + interface +
                          " up type can listen-only off'");
  }
  if (link.bitrate_bps) {
    const std::int64_t off_bps = std::int64_t{*link.bitrate_bps} - std::int64_t{bitrate_bps};
    if (200 * std::abs(off_bps) > std::int64_t{bitrate_bps}) {
      refuse(interface, "runs at " + std::to_string(*link.bitrate_bps) + " bit/s, wanted are " +
                            std::to_string(bitrate_bps) + " (robot file, or --bitrate); " +
                            set_again);
    }
  }
  if (link.transmit_queue_frames && *link.transmit_queue_frames < burst_frames) {
    refuse(interface, "the transmit queue holds " + std::to_string(*link.transmit_queue_frames) +
                          " frames, a cycle sends " + std::to_string(burst_frames) +
                          " at once; 'ip link set " + interface + " txqueuelen 100'");
  }
}

}  // namespace tenon::hw
