#include "hw/can/slcan_server.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <utility>

#include "hw/can/poll_wait.h"
#include "hw/can/slcan.h"
#include "shared/base/time_units.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::hw {
namespace {

constexpr std::string_view kAccepted = "\r";
constexpr std::string_view kRefused = "\a";

}  // namespace

SlcanServer::SlcanServer(Descriptor listener)
    : listener_(std::move(listener)), sockets_(::epoll_create1(EPOLL_CLOEXEC)) {
  watch(listener_);
}

SlcanServer::~SlcanServer() { flush(); }

SendResult SlcanServer::send(const CanFrame& frame) noexcept {
  std::size_t failed = 0;
  const std::size_t taken = deliver(frame, nullptr, failed);
  if (taken == 0 && failed > 0) return SendResult::kQueueFull;
  ++status_.sent;
  return SendResult::kSent;
}

bool SlcanServer::receive(ReceivedFrame& received) noexcept {
  if (next_frame(received)) {
    return true;
  }
  flush();
  return poll(0) && next_frame(received);
}

void SlcanServer::wait(std::int64_t at_most_ns) noexcept {
  flush();
  const bool waiting = std::any_of(clients_.begin(), clients_.end(),
                                   [](const Client& client) { return client.stream.has_input(); });
  if (!waiting && at_most_ns > 0) {
    (void)poll(at_most_ns);
  }
}

CanBusStatus SlcanServer::status() const noexcept {
  CanBusStatus status = status_;
  for (const Client& client : clients_) {
    status.malformed += client.stream.malformed();
    status.send_failures += client.lost + client.stream.dropped();
  }
  return status;
}

std::uint16_t SlcanServer::port() const noexcept {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return 0;
  }
  return address.ss_family == AF_INET6
             ? ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port)
             : ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

std::size_t SlcanServer::clients() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(clients_.begin(), clients_.end(), [](const Client& c) { return c.hears(); }));
}

/// The next frame out of the buffers; commands on the way are obeyed.
bool SlcanServer::next_frame(ReceivedFrame& received) noexcept {
  for (Client& client : clients_) {
    while (const auto message = client.stream.next()) {
      refuse_malformed(client);
      if (message->kind == SlcanParser::Message::Kind::kCommand) {
        (void)client.stream.stage(obey(client, message->text));
      } else if (message->kind == SlcanParser::Message::Kind::kFrame &&
                 take_frame(client, message->frame)) {
        received = {message->frame, monotonic_now_ns()};
        ++status_.received;
        return true;
      }
    }
    refuse_malformed(client);
  }
  return false;
}

/// To the other clients, where the channel is open.
bool SlcanServer::take_frame(Client& client, const CanFrame& frame) noexcept {
  if (client.channel != Client::Channel::kOpen) {
    (void)client.stream.stage(kRefused);
    return false;
  }
  std::size_t failed = 0;
  (void)deliver(frame, &client, failed);
  (void)client.stream.stage(frame.extended ? "Z\r" : "z\r");
  return true;
}

/// Lines that were none, before whatever came after them.
void SlcanServer::refuse_malformed(Client& client) noexcept {
  for (; client.malformed_answered < client.stream.malformed(); ++client.malformed_answered) {
    (void)client.stream.stage(kRefused);
  }
}

/// Waits for the sockets and fills the buffers; false where nothing came.
bool SlcanServer::poll(std::int64_t at_most_ns) noexcept {
  std::array<pollfd, kMaxClients + 1> wanted{};
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    wanted[i] = {clients_[i].stream.descriptor(), POLLIN, 0};  // negative ones are skipped
  }
  wanted.back() = {listener_.get(), POLLIN, 0};
  if (!poll_wait(wanted, at_most_ns)) {
    return false;
  }
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    if (wanted[i].revents != 0) {
      clients_[i].stream.fill();
    }
  }
  if (wanted.back().revents != 0) {
    accept_client();
  }
  return true;
}

std::size_t SlcanServer::deliver(const CanFrame& frame, const Client* except,
                                 std::size_t& failed) noexcept {
  std::array<char, kSlcanMaxFrame> plain{};
  std::array<char, kSlcanMaxStamped> stamped{};
  const std::size_t size = slcan_encode(frame, plain);
  std::size_t taken = 0;
  for (Client& client : clients_) {
    if (&client == except || !client.hears()) continue;
    std::string_view line(plain.data(), size);
    if (client.stamps) {
      const auto time_ms = monotonic_now_ns() / kNanosecondsPerMillisecond;
      line = {stamped.data(), slcan_encode_stamped(frame, time_ms, stamped)};
    }
    const bool fits = client.stream.stage(line);
    ++(fits ? taken : failed);
    client.lost += fits ? 0 : 1;
  }
  return taken;
}

std::string_view SlcanServer::obey(Client& client, std::string_view command) noexcept {
  using Channel = Client::Channel;
  const bool open = client.channel != Channel::kClosed;
  const bool bare = command.size() == 1;
  switch (command.front()) {
    case 'O':
    case 'L':
      if (open || !bare) return kRefused;
      client.channel = command.front() == 'O' ? Channel::kOpen : Channel::kListening;
      return kAccepted;
    case 'C':
      if (!open || !bare) return kRefused;
      client.channel = Channel::kClosed;
      return kAccepted;
    case 'S':
      return open || command.size() != 2 || command[1] < '0' || command[1] > '8' ? kRefused
                                                                                 : kAccepted;
    case 's':
      return open || command.size() != 5 ? kRefused : kAccepted;
    case 'Z':
      if (open || (command != "Z0" && command != "Z1")) return kRefused;
      client.stamps = command == "Z1";
      return kAccepted;
    case 'V':
      return bare ? "V1013\r" : kRefused;
    case 'N':
      return bare ? "NTENO\r" : kRefused;
    case 'F': {
      if (!open || !bare) return kRefused;
      const std::uint64_t lost = client.lost + client.stream.dropped();
      const bool overrun = lost > client.lost_told;
      client.lost_told = lost;
      return overrun ? "F08\r" : "F00\r";
    }
  }
  return kRefused;
}

/// Until it is closed.
void SlcanServer::watch(const Descriptor& socket) noexcept {
  epoll_event wanted{};
  wanted.events = EPOLLIN;
  (void)::epoll_ctl(sockets_.get(), EPOLL_CTL_ADD, socket.get(), &wanted);
}

void SlcanServer::accept_client() noexcept {
  Descriptor accepted(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!accepted.is_open()) {
    return;
  }
  for (Client& client : clients_) {
    if (!client.stream.is_open() && !client.stream.has_input()) {
      const int on = 1;
      ::setsockopt(accepted.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
      watch(accepted);
      client.stream.adopt(std::move(accepted));
      client.channel = Client::Channel::kClosed;
      client.stamps = false;
      client.malformed_answered = client.stream.malformed();
      client.lost_told = client.lost + client.stream.dropped();
      return;
    }
  }
}

void SlcanServer::flush() noexcept {
  for (Client& client : clients_) {
    client.stream.flush();
  }
}

}  // namespace tenon::hw
