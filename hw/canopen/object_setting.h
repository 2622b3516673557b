#pragma once
// One line of a node's configuration: what an object entry has to be.

#include <cstdint>

namespace tenon::hw::canopen {

/// index << 8 | sub, as ArmFault carries it.
[[nodiscard]] constexpr std::uint32_t object_of(std::uint16_t index, std::uint8_t sub = 0) {
  return static_cast<std::uint32_t>(index) << 8 | sub;
}

struct ObjectSetting {
  enum class Action : std::uint8_t {
    kWrite,         ///< write it, read it back and compare
    kWriteOrTake,   ///< write it; what the device makes of it is taken, unless that means "off"
    kExpect,        ///< read and compare
    kTake,          ///< read it, and take what it holds
    kAwait,         ///< read and compare until it is so, for a bounded time
    kRecord,        ///< read it where that can be, whatever it holds
    kCompare,       ///< read it and remember whether it, and those compared just before, are so
    kWriteIfOther,  ///< as kWrite, unless all that was compared last is so already
    kTry,           ///< as kWrite; a node that refuses one is spared all others of these
  };
  Action action = Action::kWrite;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint8_t size_bytes = 4;  ///< 1, 2 or 4
  std::uint32_t value = 0;
  std::uint32_t compare_mask = 0xFFFFFFFF;  ///< bits that have to agree
  bool optional = false;                    ///< a node without the object is fine too
  bool zero_is_off = false;                 ///< and so are all ones

  [[nodiscard]] constexpr std::uint32_t object() const { return object_of(index, sub); }
  [[nodiscard]] constexpr std::uint32_t size_mask() const {
    return size_bytes >= 4 ? 0xFFFFFFFFu : (1u << (8u * size_bytes)) - 1u;
  }
  [[nodiscard]] constexpr bool matches(std::uint32_t found) const {
    return ((found ^ value) & compare_mask & size_mask()) == 0;
  }
  [[nodiscard]] constexpr bool means_off(std::uint32_t found) const {
    const std::uint32_t held = found & size_mask();
    return zero_is_off && (held == 0 || held == size_mask());
  }
  friend bool operator==(const ObjectSetting&, const ObjectSetting&) = default;
};

}  // namespace tenon::hw::canopen
