#include "hw/can/slcan_client.h"

#include <array>
#include <string>
#include <utility>

#include "hw/can/poll_wait.h"
#include "hw/can/slcan.h"
#include "shared/base/error.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::hw {

SlcanClient::SlcanClient(Descriptor descriptor, std::uint32_t bitrate_bps) {
  stream_.adopt(std::move(descriptor));
  const auto digit = slcan_bitrate_digit(bitrate_bps);
  if (!digit) {
    throw InputError("slcan cannot set " + std::to_string(bitrate_bps) +
                     " bit/s; it knows 10, 20, 50, 100, 125, 250, 500, 800 and 1000 kbit/s");
  }
  const std::string open = std::string("C\rS") + *digit + "\rO\r";
  if (stream_.stage(open)) {
    stream_.flush();
  }
}

SlcanClient::~SlcanClient() {
  if (stream_.stage("C\r")) {
    stream_.flush();
  }
}

SendResult SlcanClient::send(const CanFrame& frame) noexcept {
  std::array<char, kSlcanMaxFrame> line{};
  const std::size_t size = slcan_encode(frame, line);
  if (stream_.stage({line.data(), size})) {
    ++status_.sent;
    return SendResult::kSent;
  }
  ++status_.send_failures;
  return stream_.is_open() ? SendResult::kQueueFull : SendResult::kDown;
}

bool SlcanClient::receive(ReceivedFrame& received) noexcept {
  if (!stream_.has_input()) {
    stream_.flush();
    stream_.fill();
  }
  while (const auto message = stream_.next()) {
    switch (message->kind) {
      case SlcanParser::Message::Kind::kFrame:
        received = {message->frame, monotonic_now_ns()};
        ++status_.received;
        return true;
      case SlcanParser::Message::Kind::kRefused:
        status_.error_frames += answered_ ? 1 : 0;
        answered_ = true;
        break;
      case SlcanParser::Message::Kind::kAccepted:
        answered_ = true;
        break;
      case SlcanParser::Message::Kind::kCommand:
        break;
    }
  }
  return false;
}

void SlcanClient::wait(std::int64_t at_most_ns) noexcept {
  flush();
  if (stream_.has_input() || at_most_ns <= 0) {
    return;
  }
  // A closed stream waits the whole time, so that a caller's loop does not spin.
  std::array<pollfd, 1> wanted{{{stream_.descriptor(), POLLIN, 0}}};
  poll_wait(std::span(wanted).first(stream_.is_open() ? 1 : 0), at_most_ns);
}

CanBusStatus SlcanClient::status() const noexcept {
  CanBusStatus status = status_;
  status.up = stream_.is_open();
  status.malformed = stream_.malformed();
  status.send_failures += stream_.dropped();
  return status;
}

}  // namespace tenon::hw
