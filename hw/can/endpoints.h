#pragma once
// Opens what slcan runs over, non-blocking. Set-up code: every function throws InputError with one
// line that names the endpoint and what to do. The caller owns the descriptor.

#include <cstdint>
#include <string>

namespace tenon::hw {

/// A TCP connection with TCP_NODELAY.
[[nodiscard]] int connect_tcp(const std::string& host, std::uint16_t port);
/// A listening TCP socket; port 0 takes a free one.
[[nodiscard]] int listen_tcp(const std::string& host, std::uint16_t port);
/// A serial device or pty in raw mode.
[[nodiscard]] int open_serial(const std::string& path);

}  // namespace tenon::hw
