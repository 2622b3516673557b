#pragma once
// Opens what slcan runs over, non-blocking. Set-up code: every function throws InputError with one
// line that names the endpoint and what to do.

#include <cstdint>
#include <string>

#include "shared/system/descriptor.h"

struct addrinfo;

namespace tenon::hw {

/// A blocking TCP connection to the first of the addresses that takes it. Where none does it is not
/// open, and errno says why the last one did not.
[[nodiscard]] Descriptor connect_any(const addrinfo* addresses);
/// A TCP connection with TCP_NODELAY, to any of the host's addresses.
[[nodiscard]] Descriptor connect_tcp(const std::string& host, std::uint16_t port);
/// A listening TCP socket; port 0 takes a free one.
[[nodiscard]] Descriptor listen_tcp(const std::string& host, std::uint16_t port);
/// A serial device or pty in raw mode.
[[nodiscard]] Descriptor open_serial(const std::string& path);

}  // namespace tenon::hw
