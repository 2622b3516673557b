#pragma once
// The contact signature: which directions the environment pushes the tool in.

#include <array>
#include <bit>
#include <cstdint>
#include <string>

namespace tenon {

/// A set of bits over the six axes of the task frame, two an axis. Bit 2a says that the environment
/// pushes the tool towards + on axis a (x y z force, then x y z torque), bit 2a + 1 towards -. A
/// wall in front of a tool that moves along +x therefore sets "-x".
struct ContactSignature {
  static constexpr int kBits = 12;
  std::uint16_t bits = 0;

  /// @param axis 0..5  @param sign +1 or -1, the direction of the environment's push.
  [[nodiscard]] static constexpr std::uint16_t bit(int axis, int sign) {
    return static_cast<std::uint16_t>(1U << (2 * axis + (sign > 0 ? 0 : 1)));
  }
  [[nodiscard]] constexpr bool has(int axis, int sign) const {
    return (bits & bit(axis, sign)) != 0;
  }
  /// +1, -1, or 0 where neither bit of the axis is set.
  [[nodiscard]] constexpr int sign(int axis) const {
    return (has(axis, +1) ? 1 : 0) - (has(axis, -1) ? 1 : 0);
  }
  [[nodiscard]] constexpr int count() const { return std::popcount(bits); }

  friend constexpr bool operator==(ContactSignature, ContactSignature) = default;
};

/// Every bit set: the trigger mask that watches everything.
inline constexpr ContactSignature kAllContacts{0x0FFF};

/// "none", or the bits by name, as "-x +z +rx". Allocates; not for real time.
[[nodiscard]] inline std::string to_string(ContactSignature signature) {
  static constexpr std::array<const char*, ContactSignature::kBits> kNames = {
      "+x", "-x", "+y", "-y", "+z", "-z", "+rx", "-rx", "+ry", "-ry", "+rz", "-rz"};
  std::string text;
  for (int i = 0; i < ContactSignature::kBits; ++i) {
    if ((signature.bits >> i & 1U) == 0) continue;
    if (!text.empty()) text += ' ';
    text += kNames[static_cast<std::size_t>(i)];
  }
  return text.empty() ? "none" : text;
}

}  // namespace tenon
