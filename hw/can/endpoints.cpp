#include "hw/can/endpoints.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>

#include <cstring>
#include <memory>

#include "shared/base/error.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::hw {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

std::string name_of(const std::string& host, std::uint16_t port) {
  return host + ":" + std::to_string(port);
}

Addresses resolve(const std::string& host, std::uint16_t port, int flags) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) {
    throw InputError("CAN bus " + name_of(host, port) + ": " + ::gai_strerror(error) +
                     "; give an address such as 127.0.0.1:29536");
  }
  return {found, &::freeaddrinfo};
}

void set_non_blocking(const Descriptor& descriptor) {
  ::fcntl(descriptor.get(), F_SETFL, ::fcntl(descriptor.get(), F_GETFL) | O_NONBLOCK);
}

/// A connect() that a signal interrupts goes on by itself, and may even have been made: whoever
/// listens nearby has answered within this time.
constexpr std::int64_t kInterruptedConnect_ns = 100'000'000;

/// @return 0 or the error
int connect_once(int socket, const addrinfo& to) {
  if (::connect(socket, to.ai_addr, to.ai_addrlen) == 0) return 0;
  if (errno != EINTR) return errno;
  const std::int64_t until_ns = monotonic_now_ns() + kInterruptedConnect_ns;
  pollfd made{socket, POLLOUT, 0};
  for (std::int64_t left_ns = kInterruptedConnect_ns; left_ns > 0;
       left_ns = until_ns - monotonic_now_ns()) {
    if (::poll(&made, 1, static_cast<int>(left_ns / 1'000'000)) > 0) {
      int error = 0;
      socklen_t size = sizeof(error);
      return ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
    }
  }
  return EINTR;
}

}  // namespace

Descriptor connect_any(const addrinfo* addresses) {
  int error = EADDRNOTAVAIL;
  for (const addrinfo* to = addresses; to != nullptr; to = to->ai_next) {
    Descriptor socket(::socket(to->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    error = socket.is_open() ? connect_once(socket.get(), *to) : errno;
    if (error == 0) return socket;
    if (error == EINTR) break;  // asked to stop
  }
  errno = error;
  return {};
}

Descriptor connect_tcp(const std::string& host, std::uint16_t port) {
  Descriptor socket = connect_any(resolve(host, port, 0).get());
  if (!socket.is_open()) {
    const std::string reason = std::strerror(errno);
    throw InputError("CAN bus slcan://" + name_of(host, port) + ": cannot connect: " + reason +
                     "; start the other end first (tenon-sim --can slcan-listen://" +
                     name_of(host, port) + ")");
  }
  const int on = 1;
  ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  set_non_blocking(socket);
  return socket;
}

Descriptor listen_tcp(const std::string& host, std::uint16_t port) {
  const Addresses addresses = resolve(host, port, AI_PASSIVE);
  Descriptor socket(::socket(addresses->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  if (!socket.is_open() ||
      ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on)) != 0 ||
      ::bind(socket.get(), addresses->ai_addr, addresses->ai_addrlen) != 0 ||
      ::listen(socket.get(), 4) != 0) {
    const std::string reason = std::strerror(errno);
    throw InputError("CAN bus slcan-listen://" + name_of(host, port) +
                     ": cannot listen: " + reason + "; take another port (0 takes a free one)");
  }
  return socket;
}

Descriptor open_serial(const std::string& path) {
  Descriptor device(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!device.is_open()) {
    throw InputError("CAN bus slcan:" + path + ": cannot open: " + std::strerror(errno) +
                     "; check that the adapter is plugged in and that you may use it (group "
                     "dialout)");
  }
  termios settings{};
  if (::tcgetattr(device.get(), &settings) != 0) {
    throw InputError("CAN bus slcan:" + path + ": is no serial device; give a tty or pty");
  }
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  ::cfsetspeed(&settings, B3000000);  // USB adapters ignore it
  ::tcsetattr(device.get(), TCSANOW, &settings);
  return device;
}

}  // namespace tenon::hw
