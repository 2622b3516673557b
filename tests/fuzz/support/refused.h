#pragma once
// For targets that read files: the input as a file, and what a reader may do with it.

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "shared/base/error.h"
#include "tests/fuzz/support/must.h"

namespace tenon::fuzz {

/// A folder of this process's own; in memory where the system has one there.
class InputFolder {
 public:
  InputFolder() : path_(parent() / ("tenon_fuzz_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;
  ~InputFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] std::filesystem::path put(const std::string& name, std::string_view text) const {
    std::filesystem::path file = path_ / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  static std::filesystem::path parent() {
    const std::filesystem::path memory = "/dev/shm";
    return std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
  }

  std::filesystem::path path_;
};

[[nodiscard]] inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Whether a line holds no control byte, which a terminal would obey.
[[nodiscard]] inline bool obeys_nothing(std::string_view text) {
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
}

/// True where the work accepts its input. Anything but an InputError of one printable line is a
/// crash.
template <typename Work>
bool accepted(const Work& work) {
  try {
    work();
    return true;
  } catch (const InputError& error) {
    const std::string line = error.what();
    must(!line.empty() && line.size() < 2200, "a refusal is a line of some length");
    must(obeys_nothing(line), "a refusal holds no control byte");
    return false;
  }
}

}  // namespace tenon::fuzz
