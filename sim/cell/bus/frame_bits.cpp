#include "sim/cell/bus/frame_bits.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace tenon::sim {
namespace {

constexpr std::uint32_t kCrcBits = 15;
constexpr std::uint32_t kCrcPolynomial = 0x4599;
constexpr std::size_t kClassicMax_bytes = 8;

/// Which stuff bits a row of bits calls for: as many as `count` more are sent.
struct Stuffing {
  std::uint8_t run = 0;  ///< of equal bits, 0 to 4
  bool last = true;      ///< the idle bus is recessive
  bool stuffed = false;  ///< the last bit called for one
  std::uint8_t count = 0;

  constexpr void push(bool bit) {
    run = static_cast<std::uint8_t>(bit == last ? run + 1 : 1);
    last = bit;
    stuffed = run == 5;
    if (!stuffed) return;
    ++count;
    last = !bit;
    run = 1;
  }
};

constexpr std::uint32_t fed(std::uint32_t crc, bool bit) {
  const bool feed = bit != ((crc >> (kCrcBits - 1) & 1u) != 0);
  return crc << 1 ^ (feed ? kCrcPolynomial : 0u);
}

constexpr std::size_t kBytes = 256;
constexpr std::size_t kRuns = 5;

using StuffingTable = std::array<std::array<std::array<Stuffing, kBytes>, kRuns>, 2>;

/// After a byte, highest bit first: by what was last sent, how long that has run, and the byte.
constexpr StuffingTable stuffing_table() {
  StuffingTable table{};
  for (std::size_t last = 0; last < table.size(); ++last) {
    for (std::size_t run = 0; run < kRuns; ++run) {
      for (std::size_t byte = 0; byte < kBytes; ++byte) {
        Stuffing& after = table[last][run][byte];
        after = {static_cast<std::uint8_t>(run), last != 0, false, 0};
        for (std::uint32_t bit = 8; bit-- > 0;) after.push((byte >> bit & 1u) != 0);
      }
    }
  }
  return table;
}

/// Of the bytes that stand in the eight highest bits.
constexpr std::array<std::uint32_t, kBytes> crc_table() {
  std::array<std::uint32_t, kBytes> table{};
  for (std::size_t byte = 0; byte < kBytes; ++byte) {
    for (std::uint32_t bit = 8; bit-- > 0;) table[byte] = fed(table[byte], (byte >> bit & 1u) != 0);
  }
  return table;
}

constexpr StuffingTable kStuffed = stuffing_table();
constexpr std::array<std::uint32_t, kBytes> kCrcs = crc_table();

/// Counts bits as they are sent, stuff bits included, and computes CRC-15 over the others.
class BitCounter {
 public:
  void push(bool bit) {
    ++count_;
    stuffing_.push(bit);
    crc_ = fed(crc_, bit);
  }
  /// The lowest `bits` bits, highest first.
  void push(std::uint32_t value, std::uint32_t bits) {
    while (bits-- > 0) push((value >> bits & 1u) != 0);
  }
  void push(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      count_ += 8;
      const std::uint32_t stuffed = stuffing_.count;
      stuffing_ = kStuffed[stuffing_.last ? 1 : 0][stuffing_.run][byte];
      stuffing_.count = static_cast<std::uint8_t>(stuffing_.count + stuffed);
      crc_ = crc_ << 8 ^ kCrcs[(crc_ >> (kCrcBits - 8) ^ byte) & 0xFFu];
    }
  }

  [[nodiscard]] std::uint32_t count() const { return count_ + stuffing_.count; }
  [[nodiscard]] std::uint32_t crc() const { return crc_ & ((1u << kCrcBits) - 1); }
  /// Without the stuff bit that the last bit called for.
  [[nodiscard]] std::uint32_t count_unended() const {
    return count() - (stuffing_.stuffed ? 1 : 0);
  }

 private:
  std::uint32_t count_ = 0;  ///< without stuff bits
  Stuffing stuffing_;
  std::uint32_t crc_ = 0;
};

/// Start of frame to the bit after the identifier's last part: RTR of classic frames, RRS of FD.
void push_header(BitCounter& bits, std::uint32_t id, bool extended, bool remote) {
  bits.push(false);
  if (extended) {
    bits.push(id >> 18 & 0x7FFu, 11);
    bits.push(0b11, 2);  // SRR, IDE
    bits.push(id & 0x3FFFFu, 18);
    bits.push(remote);
  } else {
    bits.push(id & 0x7FFu, 11);
    bits.push(remote);
    bits.push(false);  // IDE
  }
}

}  // namespace

FrameBits classic_frame_bits(const CanFrame& frame) {
  const std::size_t length = std::min<std::size_t>(frame.length, kClassicMax_bytes);
  BitCounter bits;
  push_header(bits, frame.id, frame.extended, frame.remote);
  bits.push(0, frame.extended ? 2 : 1);  // reserved
  bits.push(static_cast<std::uint32_t>(length), 4);
  if (!frame.remote) bits.push(std::span(frame.data).first(length));
  bits.push(bits.crc(), kCrcBits);
  return {bits.count() + kTailBits, 0};
}

FrameBits fd_frame_bits(std::uint32_t id, bool extended, std::span<const std::uint8_t> data,
                        bool switch_rate) {
  const int length_code = fd_length_code(data.size());
  assert(length_code >= 0);
  BitCounter bits;
  push_header(bits, id, extended, false);
  bits.push(0b10, 2);  // FDF, reserved
  bits.push(switch_rate);
  // A stuff bit that BRS itself calls for is sent after it, at the new rate.
  const std::uint32_t arbitration = bits.count_unended();
  bits.push(false);  // ESI: error active
  bits.push(static_cast<std::uint32_t>(length_code), 4);
  bits.push(data);

  const std::uint32_t checked = 4u + (data.size() <= 16 ? 17u : 21u);  // stuff count, CRC
  const std::uint32_t fixed = (checked + 3) / 4;
  const std::uint32_t phase = bits.count_unended() - arbitration + checked + fixed;
  if (!switch_rate) return {arbitration + phase + kTailBits, 0};
  return {arbitration + kTailBits, phase};
}

int fd_length_code(std::size_t data_bytes) {
  constexpr std::array<std::size_t, 7> kBeyondClassic{12, 16, 20, 24, 32, 48, 64};
  if (data_bytes <= kClassicMax_bytes) return static_cast<int>(data_bytes);
  const auto* found = std::find(kBeyondClassic.begin(), kBeyondClassic.end(), data_bytes);
  return found == kBeyondClassic.end() ? -1 : 9 + static_cast<int>(found - kBeyondClassic.begin());
}

}  // namespace tenon::sim
