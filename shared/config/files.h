#pragma once
// Whole files as bytes. Offline; throws InputError that names the file.

#include <filesystem>
#include <string>

namespace tenon::config {

/// At most 16 MiB: nothing that Tenon reads is larger.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

}  // namespace tenon::config
