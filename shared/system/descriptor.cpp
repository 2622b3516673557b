#include "shared/system/descriptor.h"

#include <errno.h>
#include <unistd.h>

#include <utility>

namespace tenon {

Descriptor::Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    (void)close();
    value_ = std::exchange(other.value_, -1);
  }
  return *this;
}

int Descriptor::close() noexcept {
  if (!is_open()) return 0;
  return ::close(std::exchange(value_, -1)) == 0 ? 0 : errno;
}

int write_all(const Descriptor& to, std::span<const std::uint8_t> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace tenon
