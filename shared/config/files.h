#pragma once
// Whole files as bytes. Offline; throws InputError that names the file.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace tenon::config {

/// At most 16 MiB: nothing that Tenon reads is larger.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// FNV-1a, 64 bits: tells files apart, proves nothing.
[[nodiscard]] constexpr std::uint64_t fnv1a_64(std::span<const char> bytes) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<std::uint8_t>(byte)) * 0x100000001B3;
  }
  return hash;
}

}  // namespace tenon::config
