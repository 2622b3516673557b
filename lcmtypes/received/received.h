#pragma once
// Messages that came over LCM from anyone on the network, or out of a file: the one place where
// they are decoded. Not for real time.

#include <cstdint>
#include <optional>
#include <span>

namespace tenon {
class cycle_state_t;
class run_setup_t;
class run_summary_t;

inline constexpr std::size_t kMessageMax_bytes = 1U << 20U;

/// Whether the lengths within a message are such as its bytes can have. The generated decoders
/// check fixed sizes only: a negative length overflows there, or asks for all memory.
template <typename Message>
[[nodiscard]] bool lengths_fit(std::span<const std::uint8_t> /*bytes*/) {
  return true;
}
template <>
[[nodiscard]] bool lengths_fit<cycle_state_t>(std::span<const std::uint8_t> bytes);
template <>
[[nodiscard]] bool lengths_fit<run_summary_t>(std::span<const std::uint8_t> bytes);
template <>
[[nodiscard]] bool lengths_fit<run_setup_t>(std::span<const std::uint8_t> bytes);

/// Empty unless the bytes are one such message from their first to their last.
template <typename Message>
[[nodiscard]] std::optional<Message> decoded(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMessageMax_bytes || !lengths_fit<Message>(bytes)) return std::nullopt;
  Message message{};
  const auto size = static_cast<int>(bytes.size());
  if (message.decode(bytes.data(), 0, size) != size) return std::nullopt;
  return message;
}

}  // namespace tenon
