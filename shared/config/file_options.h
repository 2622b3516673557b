#pragma once
// The files that a command line names. Offline.

#include <string>
#include <vector>

namespace tenon {

struct FileOption {
  std::string option;  ///< as the user gave it, such as "--json"
  std::string file;    ///< empty: not given; "-": standard output
};

/// What is written must be a file of its own, whatever links lead to it.
/// @throws InputError where a written file is another written one, or one that is read
void check_apart(const std::vector<FileOption>& written, const std::vector<FileOption>& read);

/// Files that tell what came of a program's work. Each is tried, whatever became of the others: a
/// disk that takes no more costs that one file.
class FinalFiles {
 public:
  void write(const FileOption& file, const std::string& text);
  void add_loss(const std::string& text);
  /// Says what was lost, as the program's last line. @return `status`, but no success without all
  [[nodiscard]] int conclude(const char* program, int status) const;

 private:
  std::string losses_;
};

}  // namespace tenon
