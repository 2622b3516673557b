#include "shared/config/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "shared/base/did_you_mean.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "shared/system/descriptor.h"
#include "shared/system/new_file.h"
#include "shared/system/regular_file.h"

namespace tenon {
namespace {

constexpr std::size_t kFileMax_bytes = 16U << 20U;

/// Where a file stands that is named without its folder and its end: "gantry3".
std::string shipped_meant(const std::filesystem::path& file) {
  constexpr std::array<const char*, 3> kFolders = {"hw/cells", "planner/tasks", "sim/experiments"};
  if (file.has_parent_path()) return "";
  for (const char* folder : kFolders) {
    std::error_code error;
    std::filesystem::path meant = std::filesystem::path(folder) / file;
    if (meant.extension() != ".yaml") meant += ".yaml";
    if (std::filesystem::is_regular_file(meant, error)) {
      return "; did you mean " + meant.string() + "?";
    }
  }
  return "";
}

std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

/// A file beside the one that is not there; nothing where none has a name like its.
std::string file_meant(const std::filesystem::path& file) {
  constexpr int kFilesMax = 1000;
  if (std::string shipped = shipped_meant(file); !shipped.empty()) return shipped;
  std::error_code error;
  std::vector<std::string> names;
  std::filesystem::path folder = file.parent_path();
  if (folder.empty()) folder = ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) names.push_back(entry.path().filename().string());
    if (names.size() >= kFilesMax) break;
  }
  std::sort(names.begin(), names.end());
  const std::string written = in_small_letters(file.filename().string());
  // What people write goes before what programs have made of it.
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) {
    return std::filesystem::path(name).extension() == ".yaml";
  });
  for (const std::string& name : names) {
    const std::string small = in_small_letters(name);
    const bool lacks_its_end = std::filesystem::path(small).stem() == written;
    if (small == written || lacks_its_end) return "; did you mean " + name + "?";
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  return did_you_mean(file.filename().string(), known);
}

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw InputError(file.string() + ": cannot be read: " + std::strerror(error) +
                   (error == ENOENT ? file_meant(file) : ""));
}

}  // namespace

namespace config {

std::string read_file(const std::filesystem::path& file) {
  if (is_other_than_a_file(file)) {
    throw InputError(file.string() + ": cannot be read: " + kNoRegularFile);
  }
  const Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!descriptor.is_open()) fail(file, errno);
  std::string text;
  for (;;) {
    constexpr std::size_t kChunk_bytes = 64U << 10U;
    const std::size_t before = text.size();
    if (before > kFileMax_bytes) fail(file, EFBIG);
    text.resize(before + kChunk_bytes);
    const ssize_t got = ::read(descriptor.get(), text.data() + before, kChunk_bytes);
    if (got < 0 && errno != EINTR) fail(file, errno);
    text.resize(before + static_cast<std::size_t>(got < 0 ? 0 : got));
    if (got == 0) return text;
  }
}

}  // namespace config

void check_writable(const std::filesystem::path& file) { NewFile::check(file); }

void write_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  NewFile whole(file);
  whole.add(bytes);
  whole.finish();
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  write_file(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace tenon
