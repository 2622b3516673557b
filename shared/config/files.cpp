#include "shared/config/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "shared/base/did_you_mean.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "shared/system/descriptor.h"
#include "shared/system/regular_file.h"

namespace tenon {
namespace {

constexpr std::size_t kFileMax_bytes = 16U << 20U;

/// A file beside the one that is not there; nothing where none has a name like its.
std::string file_meant(const std::filesystem::path& file) {
  constexpr int kFilesMax = 1000;
  std::error_code error;
  std::vector<std::string> names;
  std::filesystem::path folder = file.parent_path();
  if (folder.empty()) folder = ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) names.push_back(entry.path().filename().string());
    if (names.size() >= kFilesMax) break;
  }
  std::sort(names.begin(), names.end());
  const std::vector<std::string_view> known(names.begin(), names.end());
  return did_you_mean(file.filename().string(), known);
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what, int error) {
  throw InputError(file.string() + ": cannot be " + what + ": " + std::strerror(error) +
                   (error == ENOENT ? file_meant(file) : ""));
}

/// The input was good, the disk took no more of what came of it.
bool is_disks_fault(int error) {
  return error == ENOSPC || error == EDQUOT || error == EFBIG || error == EIO;
}

/// A new file with these bytes on the disk. 0 or errno.
int write_new(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  Descriptor descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!descriptor.is_open()) return errno;
  if (const int error = write_all(descriptor, bytes)) return error;
  if (::fsync(descriptor.get()) != 0) return errno;
  return descriptor.close();
}

}  // namespace

namespace config {

std::string read_file(const std::filesystem::path& file) {
  if (is_other_than_a_file(file)) {
    throw InputError(file.string() + ": cannot be read: " + kNoRegularFile);
  }
  const Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!descriptor.is_open()) fail(file, "read", errno);
  std::string text;
  for (;;) {
    constexpr std::size_t kChunk_bytes = 64U << 10U;
    const std::size_t before = text.size();
    if (before > kFileMax_bytes) fail(file, "read", EFBIG);
    text.resize(before + kChunk_bytes);
    const ssize_t got = ::read(descriptor.get(), text.data() + before, kChunk_bytes);
    if (got < 0 && errno != EINTR) fail(file, "read", errno);
    text.resize(before + static_cast<std::size_t>(got < 0 ? 0 : got));
    if (got == 0) return text;
  }
}

}  // namespace config

void check_writable(const std::filesystem::path& file) {
  // A device or a folder would be replaced by the rename.
  if (is_other_than_a_file(file)) {
    throw InputError(file.string() + ": cannot be written: " + kNoRegularFile);
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(file, "written", errno);
}

void write_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  check_writable(file);
  std::filesystem::path temporary = file;
  temporary += "." + std::to_string(::getpid()) + ".tmp";
  int error = write_new(temporary, bytes);
  if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) {
    if (error != EEXIST) ::unlink(temporary.c_str());
    if (is_disks_fault(error)) {
      throw std::runtime_error(file.string() + ": cannot be written: " + std::strerror(error));
    }
    fail(file, "written", error);
  }
  // The new name outlives a power cut only once its folder is on the disk too.
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.is_open()) (void)::fsync(directory.get());
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  write_file(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace tenon
