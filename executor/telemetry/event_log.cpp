#include "executor/telemetry/event_log.h"

#include <string>
#include <type_traits>

namespace tenon::executor {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;

template <typename Integer>
void put_be(std::string& bytes, Integer value) {
  const auto number = static_cast<std::make_unsigned_t<Integer>>(value);
  for (int shift = 8 * (static_cast<int>(sizeof(Integer)) - 1); shift >= 0; shift -= 8) {
    bytes += static_cast<char>(number >> shift & 0xFFU);
  }
}

}  // namespace

void EventLog::add(std::int64_t time_us, std::string_view channel,
                   std::span<const std::uint8_t> message) {
  std::string event;
  put_be(event, kSync);
  put_be(event, events_++);
  put_be(event, time_us);
  put_be(event, static_cast<std::int32_t>(channel.size()));
  put_be(event, static_cast<std::int32_t>(message.size()));
  event += channel;
  event.append(message.begin(), message.end());
  file_.add(event);
}

}  // namespace tenon::executor
