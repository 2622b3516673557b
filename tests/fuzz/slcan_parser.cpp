// The slcan parser on an arbitrary stream of characters, and the encoder on arbitrary frames.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "hw/can/slcan.h"
#include "shared/base/bytes.h"
#include "tests/fuzz/support/must.h"

namespace {

using namespace tenon;
using namespace tenon::hw;
using fuzz::must;

/// The last message of a line.
std::optional<SlcanParser::Message> parse(SlcanParser& parser, std::string_view line) {
  std::optional<SlcanParser::Message> message;
  for (const char character : line) message = parser.push(character);
  return message;
}

void check_frame(const CanFrame& frame) {
  must(frame.length <= 8, "a frame has at most 8 bytes");
  must(frame.id <= (frame.extended ? 0x1FFFFFFFU : 0x7FFU), "an identifier fits its kind");
  std::array<char, kSlcanMaxFrame> line{};
  const std::size_t size = slcan_encode(frame, line);
  must(size <= line.size(), "a line fits its buffer");
  SlcanParser parser;
  const auto again = parse(parser, {line.data(), size});
  must(again && again->kind == SlcanParser::Message::Kind::kFrame && again->frame == frame,
       "a frame survives encoding and parsing");
}

void check_stream(std::span<const std::uint8_t> bytes) {
  SlcanParser parser;
  std::uint64_t messages = 0;
  std::uint64_t line_ends = 0;
  std::uint64_t bells = 0;
  for (const std::uint8_t byte : bytes) {
    line_ends += byte == '\r' ? 1 : 0;
    bells += byte == '\a' ? 1 : 0;
    const auto message = parser.push(static_cast<char>(byte));
    if (!message) continue;
    ++messages;
    must(message->text.size() < kSlcanMaxFrame + 4, "a message is no longer than a line");
    if (message->kind == SlcanParser::Message::Kind::kFrame) check_frame(message->frame);
  }
  const std::uint64_t told = messages + parser.malformed();
  must(told >= line_ends && told <= line_ends + bells, "every line is a message or is counted");

  // Whatever came before, a line end puts the parser back in step.
  static_cast<void>(parser.push('\r'));
  const auto good = parse(parser, "t1232AABB\r");
  must(good && good->frame.id == 0x123 && good->frame.length == 2 && good->frame.data[0] == 0xAA &&
           good->frame.data[1] == 0xBB,
       "the parser is in step after a line end");
}

/// A frame as a transport may hand it over: unused bytes are 0.
CanFrame frame_from(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  const auto kind = in.read<std::uint8_t>();
  CanFrame frame;
  frame.extended = (kind & 0x10) != 0;
  frame.remote = (kind & 0x20) != 0;
  frame.length = static_cast<std::uint8_t>((kind & 0x0F) % 9);
  frame.id = in.read<std::uint32_t>() & (frame.extended ? 0x1FFFFFFFU : 0x7FFU);
  for (std::size_t i = 0; !frame.remote && i < frame.length; ++i) {
    frame.data[i] = in.read<std::uint8_t>();
  }
  return frame;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_stream({data, size});
  check_frame(frame_from({data, size}));
  return 0;
}
