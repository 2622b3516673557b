#pragma once
// The runs that have been made, on the disk: a line that says which evaluation they belong to, then
// one line a run, appended and flushed as each one ends. Whatever ends the program, it loses the
// runs in flight and no other. Offline; one thread at a time.

#include <filesystem>
#include <string>
#include <vector>

#include "shared/system/descriptor.h"

namespace tenon::sim {

class RunLog {
 public:
  /// Opens the file or makes it, and keeps it to itself. A last line that a kill tore is cut off.
  /// @param identity one line: only runs of the same are taken up
  /// @throws InputError where it cannot, the file is another evaluation's, or another process has
  /// it
  RunLog(const std::filesystem::path& file, const std::string& identity);

  /// What it held when it was opened, without the first line.
  [[nodiscard]] const std::vector<std::string>& found() const { return found_; }
  [[nodiscard]] bool was_torn() const { return was_torn_; }

  /// On the disk when it returns. @throws std::runtime_error where it cannot be
  void append(const std::string& line);

 private:
  std::filesystem::path file_;
  Descriptor descriptor_;
  std::vector<std::string> found_;
  bool was_torn_ = false;
};

/// The runs of a log that is left as it is, such as another shard's; a torn last line is left out.
/// @throws InputError where it cannot be read, or is another evaluation's
[[nodiscard]] std::vector<std::string> read_run_log(const std::filesystem::path& file,
                                                    const std::string& identity);

}  // namespace tenon::sim
