#pragma once
// The ASCII of slcan (Lawicel): frames as lines that end in CR. Codec without I/O; no allocation,
// no throw, any thread; a parser belongs to one byte stream.
//
//   tIIILDD..       data frame, 11 bit: 3 hex digits of identifier, length 0..8, 2 digits a byte
//   TIIIIIIIILDD..  data frame, 29 bit
//   rIIIL RIIIIIIIIL  remote frames
//   a frame may be followed by 4 hex digits of timestamp, which are ignored
//   CR alone, z, Z  accepted (answer)        BEL  refused (answer)
//   C O L Sn sxxyy V N F Z0 Z1 ...           commands, and their answers
//
// The parser never trusts its input: what is none of the above, or longer than any line can be, is
// dropped up to the next CR and counted.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

/// T, identifier, length, data, CR; and with a timestamp.
inline constexpr std::size_t kSlcanMaxFrame = 1 + 8 + 1 + 16 + 1;
inline constexpr std::size_t kSlcanMaxStamped = kSlcanMaxFrame + 4;

/// Writes a frame as a line with its CR; returns the count of characters.
[[nodiscard]] std::size_t slcan_encode(const CanFrame& frame,
                                       std::span<char, kSlcanMaxFrame> out) noexcept;

/// With a timestamp: the time modulo a minute.
[[nodiscard]] std::size_t slcan_encode_stamped(const CanFrame& frame, std::int64_t time_ms,
                                               std::span<char, kSlcanMaxStamped> out) noexcept;

/// The S command's digit for a bit rate: 0..8 for 10 k to 1 M. Empty where slcan has none.
[[nodiscard]] std::optional<char> slcan_bitrate_digit(std::uint32_t bitrate_bps) noexcept;

class SlcanParser {
 public:
  struct Message {
    enum class Kind : std::uint8_t {
      kFrame,
      kAccepted,  ///< CR alone, z, Z
      kRefused,   ///< BEL
      kCommand,   ///< see text
    };
    Kind kind = Kind::kFrame;
    CanFrame frame;
    std::string_view text;  ///< the line without CR, valid until the next push()
  };

  /// Takes in one character; a message where it completes one.
  [[nodiscard]] std::optional<Message> push(char character) noexcept;
  /// Lines dropped.
  [[nodiscard]] std::uint64_t malformed() const noexcept { return malformed_; }
  /// Forgets a line begun.
  void reset() noexcept;

 private:
  [[nodiscard]] std::optional<Message> finish_line() noexcept;

  std::array<char, kSlcanMaxStamped - 1> line_{};
  std::size_t length_ = 0;
  bool overlong_ = false;
  std::uint64_t malformed_ = 0;
};

}  // namespace tenon::hw
