#include "hw/can/slcan_server.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>

#include "hw/can/monotonic_clock.h"
#include "hw/can/poll_wait.h"
#include "hw/can/slcan.h"

namespace tenon::hw {

SlcanServer::SlcanServer(int listener) : listener_(listener) {}

SlcanServer::~SlcanServer() {
  flush();
  ::close(listener_);
}

SendResult SlcanServer::send(const CanFrame& frame) noexcept {
  std::size_t failed = 0;
  const std::size_t taken = deliver(frame, nullptr, failed);
  if (taken == 0 && failed > 0) {
    ++status_.send_failures;
    return SendResult::kQueueFull;
  }
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
    status.send_failures += client.stream.dropped();
  }
  return status;
}

std::uint16_t SlcanServer::port() const noexcept {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return 0;
  }
  return address.ss_family == AF_INET6
             ? ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port)
             : ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

std::size_t SlcanServer::clients() const noexcept {
  return static_cast<std::size_t>(std::count_if(
      clients_.begin(), clients_.end(),
      [](const Client& client) { return client.stream.is_open() && client.channel_open; }));
}

/// The next frame out of the buffers; commands on the way are obeyed.
bool SlcanServer::next_frame(ReceivedFrame& received) noexcept {
  for (Client& client : clients_) {
    while (const auto message = client.stream.next()) {
      if (message->kind == SlcanParser::Message::Kind::kCommand) {
        obey(client, message->text);
      }
      if (message->kind != SlcanParser::Message::Kind::kFrame) {
        continue;
      }
      if (!client.channel_open) {
        (void)client.stream.stage("\a");
        continue;
      }
      std::size_t failed = 0;
      (void)deliver(message->frame, &client, failed);
      received = {message->frame, monotonic_now_ns()};
      ++status_.received;
      return true;
    }
  }
  return false;
}

/// Waits for the sockets and fills the buffers; false where nothing came.
bool SlcanServer::poll(std::int64_t at_most_ns) noexcept {
  std::array<pollfd, kMaxClients + 1> wanted{};
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    wanted[i] = {clients_[i].stream.descriptor(), POLLIN, 0};  // negative ones are skipped
  }
  wanted.back() = {listener_, POLLIN, 0};
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
  std::array<char, kSlcanMaxFrame> line{};
  const std::size_t size = slcan_encode(frame, line);
  std::size_t taken = 0;
  for (Client& client : clients_) {
    if (&client != except && client.channel_open && client.stream.is_open()) {
      ++(client.stream.stage({line.data(), size}) ? taken : failed);
    }
  }
  return taken;
}

void SlcanServer::obey(Client& client, std::string_view command) noexcept {
  std::string_view answer = "\r";
  switch (command.front()) {
    case 'O':
    case 'L':
      client.channel_open = true;
      break;
    case 'C':
      client.channel_open = false;
      break;
    case 'V':
      answer = "V1013\r";
      break;
    case 'N':
      answer = "NTENO\r";
      break;
    case 'F':
      answer = "F00\r";
      break;
  }
  (void)client.stream.stage(answer);
}

void SlcanServer::accept_client() noexcept {
  const int descriptor = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (descriptor < 0) {
    return;
  }
  for (Client& client : clients_) {
    if (!client.stream.is_open() && !client.stream.has_input()) {
      const int on = 1;
      ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
      client.stream.adopt(descriptor);
      client.channel_open = false;
      return;
    }
  }
  ::close(descriptor);
}

void SlcanServer::flush() noexcept {
  for (Client& client : clients_) {
    client.stream.flush();
  }
}

}  // namespace tenon::hw
