#pragma once
// What a view's server answers, and what it refuses. Pure; any thread.
//
//   GET /        the page                  405 any other method
//   GET /events  the moments, as a stream  404 any other path
//
//   400  a body; no page of this server sends one
//   403  a Host that is not this machine's own address (a page elsewhere whose name was made to
//   point
//        here: DNS rebinding), or an Origin that is not this server
//   503  more viewers than kViewersMax

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tenon::sim {

inline constexpr std::size_t kViewersMax = 16;

struct ViewRequest {
  std::string_view method;
  std::string_view path;
  std::optional<std::string_view> host;
  std::optional<std::string_view> origin;
  bool has_body = false;
};

struct ViewRefusal {
  unsigned status = 0;
  std::string words;  ///< a line
};

/// Unset: it is answered. @param port that the server listens on  @param viewers present
[[nodiscard]] std::optional<ViewRefusal> refuse(const ViewRequest& request, std::uint16_t port,
                                                std::size_t viewers);

}  // namespace tenon::sim
