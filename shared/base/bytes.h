#pragma once
// Numbers to little-endian bytes and back, whatever the machine's own order. A buffer is never cast
// to a struct. Real-time: no allocation, no throw. The spans are the caller's.

#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace tenon {

template <typename T>
concept WireNumber = (std::integral<T> || std::floating_point<T>)&&sizeof(T) <= 8;

namespace wire {
/// The unsigned integer that carries the bits of a T.
template <WireNumber T>
using Bits = std::conditional_t<
    sizeof(T) == 1, std::uint8_t,
    std::conditional_t<sizeof(T) == 2, std::uint16_t,
                       std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
}  // namespace wire

/// The first sizeof(T) bytes as a T. A shorter span is a bug.
template <WireNumber T>
[[nodiscard]] constexpr T load_le(std::span<const std::uint8_t> bytes) {
  assert(bytes.size() >= sizeof(T));
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) bits |= std::uint64_t{bytes[i]} << (8 * i);
  return std::bit_cast<T>(static_cast<wire::Bits<T>>(bits));
}

/// The same, its highest byte first.
template <WireNumber T>
[[nodiscard]] constexpr T load_be(std::span<const std::uint8_t> bytes) {
  assert(bytes.size() >= sizeof(T));
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) bits = bits << 8 | bytes[i];
  return std::bit_cast<T>(static_cast<wire::Bits<T>>(bits));
}

/// A T into the first sizeof(T) bytes. A shorter span is a bug.
template <WireNumber T>
constexpr void store_le(std::span<std::uint8_t> bytes, T value) {
  assert(bytes.size() >= sizeof(T));
  const std::uint64_t bits = std::bit_cast<wire::Bits<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[i] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
}

/// Reads numbers one after the other. Once a read would pass the end, it and all later ones give 0
/// and ok() is false.
class ByteReader {
 public:
  explicit constexpr ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <WireNumber T>
  constexpr T read() {
    const std::span<const std::uint8_t> here = take(sizeof(T));
    return here.empty() ? T{} : load_le<T>(here);
  }
  /// The next `count` bytes; empty where there are fewer.
  constexpr std::span<const std::uint8_t> take(std::size_t count) {
    if (!ok_ || count > remaining()) {
      ok_ = false;
      return {};
    }
    offset_ += count;
    return bytes_.subspan(offset_ - count, count);
  }

  [[nodiscard]] constexpr bool ok() const { return ok_; }
  [[nodiscard]] constexpr std::size_t offset() const { return offset_; }
  [[nodiscard]] constexpr std::size_t remaining() const { return bytes_.size() - offset_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t offset_ = 0;
  bool ok_ = true;
};

/// Writes numbers one after the other. Once a write would pass the end, it and all later ones do
/// nothing and ok() is false.
class ByteWriter {
 public:
  explicit constexpr ByteWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  template <WireNumber T>
  constexpr void write(T value) {
    if (!ok_ || sizeof(T) > remaining()) {
      ok_ = false;
      return;
    }
    store_le(bytes_.subspan(offset_), value);
    offset_ += sizeof(T);
  }

  [[nodiscard]] constexpr bool ok() const { return ok_; }
  [[nodiscard]] constexpr std::size_t offset() const { return offset_; }
  [[nodiscard]] constexpr std::size_t remaining() const { return bytes_.size() - offset_; }

 private:
  std::span<std::uint8_t> bytes_;
  std::size_t offset_ = 0;
  bool ok_ = true;
};

}  // namespace tenon
