#include "sim/view/view_request.h"

namespace tenon::sim {
namespace {

bool is_own(std::string_view authority, std::uint16_t port) {
  const std::string ending = ":" + std::to_string(port);
  return authority == "127.0.0.1" + ending || authority == "localhost" + ending;
}

bool is_own_origin(std::string_view origin, std::uint16_t port) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && is_own(origin.substr(kScheme.size()), port);
}

}  // namespace

std::optional<ViewRefusal> refuse(const ViewRequest& request, std::uint16_t port,
                                  std::size_t viewers) {
  // Who asks comes before what is asked for: a stranger learns nothing.
  if (!request.host || !is_own(*request.host, port)) {
    return ViewRefusal{403, "This view answers 127.0.0.1:" + std::to_string(port) + " alone.\n"};
  }
  if (request.origin && !is_own_origin(*request.origin, port)) {
    return ViewRefusal{403, "This view is for its own page alone.\n"};
  }
  if (request.method != "GET") return ViewRefusal{405, "A view is looked at: GET alone.\n"};
  if (request.has_body) return ViewRefusal{400, "A view is looked at: it takes no body.\n"};
  if (request.path == "/") return std::nullopt;
  if (request.path != "/events") return ViewRefusal{404, "There are / and /events.\n"};
  if (viewers >= kViewersMax) {
    return ViewRefusal{503, std::to_string(kViewersMax) + " look on already.\n"};
  }
  return std::nullopt;
}

}  // namespace tenon::sim
