#include "shared/system/lcm_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "shared/base/error.h"
#include "shared/system/descriptor.h"
#include "shared/system/regular_file.h"

namespace tenon {
namespace {

constexpr const char* kDefaultGroup = "239.255.76.67";
constexpr std::uint16_t kDefaultPort = 7667;

// PROVIDER://NETWORK?OPTIONS
struct Parts {
  std::string provider;
  std::string network;
  std::string options;
};

std::optional<Parts> parts_of(const std::string& url) {
  const std::size_t colon = url.find("://");
  if (colon == std::string::npos) return std::nullopt;
  const std::size_t network = colon + 3;
  const std::size_t query = url.find('?', network);
  return Parts{url.substr(0, colon), url.substr(network, query - network),
               query == std::string::npos ? "" : url.substr(query + 1)};
}

template <typename Number>
std::optional<Number> number_of(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return value;
}

bool is_multicast(const Parts& parts) {
  return parts.provider == "udpm" || parts.provider == "mpudpm";
}

// ADDRESS:PORT, either of which may be missing; empty where it is neither or no multicast group.
std::optional<sockaddr_in> group_of(const std::string& network) {
  const std::size_t colon = network.find(':');
  const std::string address = network.substr(0, colon);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  if (inet_pton(AF_INET, address.empty() ? kDefaultGroup : address.c_str(), &group.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(group.sin_addr.s_addr))) {
    return std::nullopt;
  }
  std::uint16_t port = kDefaultPort;
  if (colon != std::string::npos && colon + 1 < network.size()) {
    const auto read = number_of<std::uint16_t>(std::string_view(network).substr(colon + 1));
    if (!read || *read == 0) return std::nullopt;
    port = *read;
  }
  group.sin_port = htons(port);
  return group;
}

bool is_option_of_multicast(std::string_view option, std::string_view value) {
  return (option.starts_with("ttl=") && number_of<std::uint8_t>(value)) ||
         (option.starts_with("recv_buf_size=") && number_of<std::uint32_t>(value));
}

// None but those of reading: LCM takes mode=w for a log that is to be written, and empties it.
bool is_option_of_a_log(std::string_view option, std::string_view value) {
  if (option.starts_with("start_timestamp=")) return number_of<std::int64_t>(value).has_value();
  const auto speed = number_of<double>(value);
  return option.starts_with("speed=") && speed && std::isfinite(*speed) && *speed > 0.0;
}

// NAME=VALUE&... @return the first one that is none
std::optional<std::string> bad_option(std::string_view options,
                                      bool (*good)(std::string_view, std::string_view)) {
  while (!options.empty()) {
    const std::string_view option = options.substr(0, options.find('&'));
    options.remove_prefix(std::min(options.size(), option.size() + 1));
    const std::string_view value = option.substr(std::min(option.size(), option.find('=') + 1));
    if (!good(option, value)) return std::string(option);
  }
  return std::nullopt;
}

}  // namespace

void check_lcm_url(const std::string& url) {
  const std::optional<Parts> parts = parts_of(url);
  if (parts && is_multicast(*parts)) {
    if (!group_of(parts->network)) {
      throw InputError("--lcm-url " + url + ": '" + parts->network +
                       "' must be a multicast group and a port, as 239.255.76.67:7667");
    }
    const std::optional<std::string> bad = bad_option(parts->options, is_option_of_multicast);
    if (!bad) return;
    throw InputError("--lcm-url " + url + ": '" + *bad +
                     "' must be ttl=0..255 or recv_buf_size=BYTES");
  }
  if (parts && parts->provider == "file" && !parts->network.empty()) {
    const std::optional<std::string> bad = bad_option(parts->options, is_option_of_a_log);
    if (!bad) return;
    throw InputError("--lcm-url " + url + ": '" + *bad +
                     "' must be speed=N, a number above 0 (1 as it was, 1000 at once), or "
                     "start_timestamp=N, whole microseconds since 1970");
  }
  if (parts && parts->provider == "memq" && parts->network.empty()) return;
  throw InputError("--lcm-url " + url +
                   ": not an LCM URL; give udpm://ADDRESS:PORT?ttl=N, file://FILE or memq://");
}

void check_lcm_publishes(const std::string& url) {
  const std::optional<Parts> parts = parts_of(url);
  if (!parts || parts->provider != "file") return;
  throw InputError("--lcm-url " + url +
                   ": LCM does not tell what such a file lost on a full disk; write the log with "
                   "--log " +
                   parts->network);
}

void check_lcm_log(const std::string& url) {
  const std::optional<Parts> parts = parts_of(url);
  if (!parts || parts->provider != "file") return;
  std::error_code error;
  if (std::filesystem::is_regular_file(parts->network, error)) return;
  const bool other = is_other_than_a_file(parts->network);
  throw InputError("--lcm-url " + url + ": " + parts->network +
                   " cannot be read: " + (other ? kNoRegularFile : error.message()));
}

std::string lcm_log_of(const std::string& url) {
  const std::optional<Parts> parts = parts_of(url);
  return parts && parts->provider == "file" ? parts->network : "";
}

bool has_multicast_route(const std::string& url) {
  const std::optional<Parts> parts = parts_of(url);
  if (!parts || !is_multicast(*parts)) return true;
  const std::optional<sockaddr_in> group = group_of(parts->network);
  if (!group) return true;
  const Descriptor probe(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return !probe.is_open() ||
         ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&*group), sizeof(*group)) == 0;
}

}  // namespace tenon
