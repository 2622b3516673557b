#include "hw/can/slcan.h"

#include <algorithm>

namespace tenon::hw {
namespace {

constexpr char kBell = '\a';
constexpr std::string_view kHexDigits = "0123456789ABCDEF";
constexpr std::string_view kCommandLetters = "COLSsVvNFZzXMmWPAU";

std::optional<std::uint32_t> digit(char character) {
  if (character >= '0' && character <= '9') return static_cast<std::uint32_t>(character - '0');
  if (character >= 'A' && character <= 'F') return static_cast<std::uint32_t>(character - 'A') + 10;
  if (character >= 'a' && character <= 'f') return static_cast<std::uint32_t>(character - 'a') + 10;
  return std::nullopt;
}

/// Takes `count` hex digits off the front; empty where they are not there.
std::optional<std::uint32_t> take_number(std::string_view& text, std::size_t count) {
  if (text.size() < count) return std::nullopt;
  std::uint32_t number = 0;
  for (const char character : text.substr(0, count)) {
    const auto value = digit(character);
    if (!value) return std::nullopt;
    number = number << 4 | *value;
  }
  text.remove_prefix(count);
  return number;
}

std::optional<CanFrame> decode(std::string_view text) {
  CanFrame frame;
  const char type = text.front();
  frame.extended = type == 'T' || type == 'R';
  frame.remote = type == 'r' || type == 'R';
  text.remove_prefix(1);
  const auto id = take_number(text, frame.extended ? 8 : 3);
  const auto length = take_number(text, 1);
  if (!id || !length || *length > 8 || *id > (frame.extended ? 0x1FFFFFFFu : 0x7FFu)) {
    return std::nullopt;
  }
  frame.id = *id;
  frame.length = static_cast<std::uint8_t>(*length);
  for (std::size_t i = 0; !frame.remote && i < *length; ++i) {
    const auto byte = take_number(text, 2);
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  const bool stamped = text.size() == 4 && take_number(text, 4).has_value();
  return text.empty() || stamped ? std::optional(frame) : std::nullopt;
}

}  // namespace

std::size_t slcan_encode(const CanFrame& frame, std::span<char, kSlcanMaxFrame> out) noexcept {
  std::size_t size = 0;
  out[size++] = frame.remote ? (frame.extended ? 'R' : 'r') : (frame.extended ? 'T' : 't');
  for (int shift = frame.extended ? 28 : 8; shift >= 0; shift -= 4) {
    out[size++] = kHexDigits[frame.id >> shift & 0xF];
  }
  const std::size_t length = std::min<std::size_t>(frame.length, 8);
  out[size++] = kHexDigits[length];
  for (std::size_t i = 0; !frame.remote && i < length; ++i) {
    out[size++] = kHexDigits[frame.data[i] >> 4];
    out[size++] = kHexDigits[frame.data[i] & 0xF];
  }
  out[size++] = '\r';
  return size;
}

std::size_t slcan_encode_stamped(const CanFrame& frame, std::int64_t time_ms,
                                 std::span<char, kSlcanMaxStamped> out) noexcept {
  constexpr std::int64_t kMinute_ms = 60'000;
  std::size_t size = slcan_encode(frame, out.first<kSlcanMaxFrame>()) - 1;
  const auto stamp = static_cast<std::uint32_t>(time_ms % kMinute_ms);
  for (int shift = 12; shift >= 0; shift -= 4) out[size++] = kHexDigits[stamp >> shift & 0xF];
  out[size++] = '\r';
  return size;
}

std::optional<char> slcan_bitrate_digit(std::uint32_t bitrate_bps) noexcept {
  constexpr std::array<std::uint32_t, 9> kBitrates{10'000,  20'000,  50'000,  100'000,  125'000,
                                                   250'000, 500'000, 800'000, 1'000'000};
  const auto* found = std::find(kBitrates.begin(), kBitrates.end(), bitrate_bps);
  if (found == kBitrates.end()) return std::nullopt;
  return static_cast<char>('0' + (found - kBitrates.begin()));
}

std::optional<SlcanParser::Message> SlcanParser::push(char character) noexcept {
  if (character == '\r') {
    return finish_line();
  }
  if (character == kBell && length_ == 0 && !overlong_) {
    return Message{Message::Kind::kRefused, {}, {}};
  }
  if (character == '\n' && length_ == 0) {
    return std::nullopt;  // a terminal's CR LF
  }
  if (length_ == line_.size()) {
    overlong_ = true;
  } else {
    line_[length_++] = character;
  }
  return std::nullopt;
}

std::optional<SlcanParser::Message> SlcanParser::finish_line() noexcept {
  const std::string_view line(line_.data(), length_);
  const bool overlong = overlong_;
  reset();
  if (overlong) {
    ++malformed_;
    return std::nullopt;
  }
  if (line.empty() || line == "z" || line == "Z") {
    return Message{Message::Kind::kAccepted, {}, line};
  }
  if (std::string_view("tTrR").find(line.front()) != std::string_view::npos) {
    if (const auto frame = decode(line)) {
      return Message{Message::Kind::kFrame, *frame, line};
    }
  } else if (kCommandLetters.find(line.front()) != std::string_view::npos) {
    return Message{Message::Kind::kCommand, {}, line};
  }
  ++malformed_;
  return std::nullopt;
}

void SlcanParser::reset() noexcept {
  length_ = 0;
  overlong_ = false;
}

}  // namespace tenon::hw
