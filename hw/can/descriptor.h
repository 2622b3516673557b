#pragma once
// Owns a file descriptor: closed once, with its owner.

#include <unistd.h>

namespace tenon::hw {

class Descriptor {
 public:
  /// @param value as the system gave it; negative where it gave none
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }

  [[nodiscard]] int get() const noexcept { return value_; }

 private:
  const int value_;
};

}  // namespace tenon::hw
