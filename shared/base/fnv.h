#pragma once
// FNV-1a, 64 bits (Fowler, Noll, Vo): tells files and names apart, proves nothing.

#include <cstdint>
#include <string_view>

namespace tenon {

/// Of no bytes at all.
inline constexpr std::uint64_t kFnv1aOfNothing = 0xCBF29CE484222325;

/// @param hash of the bytes before these
[[nodiscard]] constexpr std::uint64_t fnv1a_64(std::string_view bytes,
                                               std::uint64_t hash = kFnv1aOfNothing) {
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<std::uint8_t>(byte)) * 0x100000001B3;
  }
  return hash;
}

}  // namespace tenon
