#include "sim/cell/bus/frame_bits.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace tenon::sim {
namespace {

constexpr std::uint32_t kCrcBits = 15;
constexpr std::uint32_t kCrcPolynomial = 0x4599;
constexpr std::size_t kClassicMax_bytes = 8;

/// Counts bits as they are sent, stuff bits included, and computes CRC-15 over the others.
class BitCounter {
 public:
  void push(bool bit) {
    ++count_;
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    stuffed_ = run_ == 5;
    if (stuffed_) {
      ++count_;
      last_ = !bit;
      run_ = 1;
    }
    const bool feed = bit != ((crc_ >> (kCrcBits - 1) & 1u) != 0);
    crc_ = crc_ << 1 ^ (feed ? kCrcPolynomial : 0u);
  }
  /// The lowest `bits` bits, highest first.
  void push(std::uint32_t value, std::uint32_t bits) {
    while (bits-- > 0) push((value >> bits & 1u) != 0);
  }
  void push(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) push(byte, 8);
  }

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t crc() const { return crc_ & ((1u << kCrcBits) - 1); }
  /// Without the stuff bit that the last bit called for.
  [[nodiscard]] std::uint32_t count_unended() const { return count_ - (stuffed_ ? 1 : 0); }

 private:
  std::uint32_t count_ = 0;
  std::uint32_t run_ = 0;
  bool last_ = true;  // the idle bus is recessive
  bool stuffed_ = false;
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
