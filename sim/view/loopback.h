#pragma once
// Where a view is served: on this machine's own address and nowhere else. Set-up code.

#include <cstdint>
#include <string>

#include "shared/system/descriptor.h"

namespace tenon::sim {

/// What --view takes: a port, alone or behind 127.0.0.1; nothing and 0 are a free one.
/// @throws InputError for anything else, other machines' addresses before all
[[nodiscard]] std::uint16_t parse_view_port(const std::string& text);

/// A listening TCP socket of 127.0.0.1. @throws InputError where the port is not to be had
[[nodiscard]] Descriptor listen_on_loopback(std::uint16_t port);

/// That it really listens on, also where 0 was asked for.
[[nodiscard]] std::uint16_t port_of(const Descriptor& listener);

}  // namespace tenon::sim
