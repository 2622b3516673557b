#pragma once
// A file that is whole or is not there: what is written goes to another one beside it, which takes
// its name once all of it is on the disk. Allocates and blocks: not for real time. One thread.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shared/system/descriptor.h"

namespace tenon {

class NewFile {
 public:
  /// @throws InputError where no file can be written of this name
  static void check(const std::filesystem::path& file);

  /// @throws InputError where it cannot be written
  explicit NewFile(std::filesystem::path file);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  /// Takes away what has not been finished.
  ~NewFile();

  /// @throws std::runtime_error that names the file where the disk takes no more
  void add(std::span<const std::uint8_t> bytes);
  void add(std::string_view text);
  /// To the disk, and to its name. @throws as add()
  void finish();

 private:
  void flush();
  [[noreturn]] void fail(int error);
  void remove();

  std::filesystem::path file_;
  std::filesystem::path temporary_;
  Descriptor descriptor_;
  std::vector<std::uint8_t> buffer_;
  bool there_ = false;  ///< the temporary file is, and is this one's
};

}  // namespace tenon
