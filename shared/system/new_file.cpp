#include "shared/system/new_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "shared/base/error.h"
#include "shared/system/regular_file.h"

namespace tenon {
namespace {

constexpr std::size_t kBuffer_bytes = 256U << 10U;

/// The input was good, the disk took no more of what came of it.
bool is_disks_fault(int error) {
  return error == ENOSPC || error == EDQUOT || error == EFBIG || error == EIO;
}

std::string unwritten(const std::filesystem::path& file, const char* why) {
  return file.string() + ": cannot be written: " + why;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

}  // namespace

void NewFile::check(const std::filesystem::path& file) {
  // A device or a folder would be replaced by the rename.
  if (is_other_than_a_file(file)) throw InputError(unwritten(file, kNoRegularFile));
  if (::access(folder_of(file).c_str(), W_OK | X_OK) != 0) {
    throw InputError(unwritten(file, std::strerror(errno)));
  }
}

NewFile::NewFile(std::filesystem::path file) : file_(std::move(file)), temporary_(file_) {
  check(file_);
  temporary_ += "." + std::to_string(::getpid()) + ".tmp";
  constexpr int kNew = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
  descriptor_ = Descriptor(::open(temporary_.c_str(), kNew, 0666));
  there_ = descriptor_.is_open();
  if (!there_) fail(errno);
}

NewFile::~NewFile() { remove(); }

void NewFile::remove() {
  if (std::exchange(there_, false)) ::unlink(temporary_.c_str());
}

void NewFile::fail(int error) {
  remove();
  const std::string text = unwritten(file_, std::strerror(error));
  if (is_disks_fault(error)) throw std::runtime_error(text);
  throw InputError(text);
}

void NewFile::flush() {
  const int error = write_all(descriptor_, buffer_);
  buffer_.clear();
  if (error != 0) fail(error);
}

void NewFile::add(std::span<const std::uint8_t> bytes) {
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  if (buffer_.size() >= kBuffer_bytes) flush();
}

void NewFile::add(std::string_view text) {
  add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void NewFile::finish() {
  flush();
  if (::fsync(descriptor_.get()) != 0) fail(errno);
  if (const int error = descriptor_.close()) fail(error);
  if (::rename(temporary_.c_str(), file_.c_str()) != 0) fail(errno);
  there_ = false;
  // The new name outlives a power cut only once its folder is on the disk too.
  const Descriptor folder(::open(folder_of(file_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.is_open()) (void)::fsync(folder.get());
}

}  // namespace tenon
