#pragma once
// Owns a file descriptor: closed once, with its owner. Real-time as far as close(2) is; one thread.

#include <cstdint>
#include <span>

namespace tenon {

class Descriptor {
 public:
  Descriptor() = default;
  /// @param value as the system gave it; negative where it gave none
  explicit Descriptor(int value) noexcept : value_(value) {}
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { (void)close(); }

  [[nodiscard]] int get() const noexcept { return value_; }
  [[nodiscard]] bool is_open() const noexcept { return value_ >= 0; }

  /// Now, where it is open. 0, or the error (errno) that the system found only then.
  [[nodiscard]] int close() noexcept;

 private:
  int value_ = -1;
};

/// All of the bytes, over interruptions. 0 or errno; where it failed, some may have been written.
[[nodiscard]] int write_all(const Descriptor& to, std::span<const std::uint8_t> bytes) noexcept;

}  // namespace tenon
