#include "sim/view/loopback.h"

#include <errno.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <charconv>
#include <cstring>
#include <string_view>

#include "shared/base/error.h"

namespace tenon::sim {
namespace {

constexpr std::string_view kLoopback = "127.0.0.1";
constexpr int kBacklog = 16;
// What a viewer that reads nothing is behind by before it is noticed: some seconds of moments.
constexpr int kSendBuffer = 128 * 1024;

}  // namespace

std::uint16_t parse_view_port(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string host = colon == std::string::npos ? std::string() : text.substr(0, colon);
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (colon != std::string::npos && host != kLoopback) {
    throw InputError("--view " + text +
                     ": is for this machine alone; give a port, or 127.0.0.1:PORT (from another "
                     "machine: ssh -L PORT:127.0.0.1:PORT)");
  }
  if (port.empty() && host.empty()) return 0;
  std::uint16_t number = 0;
  const auto [rest, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc{} || rest != port.data() + port.size()) {
    throw InputError("--view " + text + ": must be a port in [0, 65535]; 0 takes a free one");
  }
  return number;
}

Descriptor listen_on_loopback(std::uint16_t port) {
  Descriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  const auto* any = reinterpret_cast<const sockaddr*>(&address);
  // Connections inherit the buffer.
  if (!listener.is_open() ||
      ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on)) != 0 ||
      ::setsockopt(listener.get(), SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof(kSendBuffer)) != 0 ||
      ::bind(listener.get(), any, sizeof(address)) != 0 ||
      ::listen(listener.get(), kBacklog) != 0) {
    const std::string reason = std::strerror(errno);
    throw InputError("--view " + std::to_string(port) +
                     ": cannot listen on 127.0.0.1:" + std::to_string(port) + ": " + reason +
                     "; take another port (0 takes a free "
                     "one)");
  }
  return listener;
}

std::uint16_t port_of(const Descriptor& listener) {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  if (::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  return ntohs(address.sin_port);
}

}  // namespace tenon::sim
