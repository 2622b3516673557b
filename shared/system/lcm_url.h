#pragma once
// What can be told of an LCM URL before LCM sees it, whose own answers are many lines long and
// blame the network for a slip of the pen. Set-up code; one system call.

#include <string>

namespace tenon {

/// @throws InputError unless it is udpm:// or mpudpm:// with a multicast address and a port (either
/// may be left out) and options that LCM has, file://PATH with those of reading a log, or
/// memq://
void check_lcm_url(const std::string& url);

/// A log file is no place to publish to.
/// @throws InputError for file://
void check_lcm_publishes(const std::string& url);

/// What is to be replayed must be a log: LCM would look for one in a pipe or a device for ever.
/// @throws InputError where such a URL names no regular file
void check_lcm_log(const std::string& url);

/// The log that such a URL has replayed; empty where it is of another kind.
[[nodiscard]] std::string lcm_log_of(const std::string& url);

/// Whether the kernel knows a way to the multicast group of such a URL; true where it needs none.
[[nodiscard]] bool has_multicast_route(const std::string& url);

/// What to do where it does not.
inline constexpr const char* kSetMulticastRoute =
    "set one with 'ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo'";

}  // namespace tenon
