#pragma once
// Pipes, devices and folders where a file is meant: opening or reading one may wait for ever, and a
// device keeps nothing that is written to it. Set-up code.

#include <filesystem>
#include <system_error>

namespace tenon {

inline constexpr const char* kNoRegularFile = "it is not a regular file";

/// False also where there is nothing of this name.
[[nodiscard]] inline bool is_other_than_a_file(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

}  // namespace tenon
