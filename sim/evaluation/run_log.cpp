#include "sim/evaluation/run_log.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "shared/base/error.h"
#include "shared/system/regular_file.h"

namespace tenon::sim {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file.string() + ": " + what);
}

std::string text_of(const std::filesystem::path& file) {
  if (is_other_than_a_file(file)) fail(file, std::string("cannot be read: ") + kNoRegularFile);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, std::string("cannot be read: ") + std::strerror(errno));
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct Lines {
  std::vector<std::string> whole;
  std::size_t bytes = 0;  ///< of them
};

/// A line is whole once its end is there: it is written in one piece, and the end is its last byte.
Lines lines_of(std::string_view text) {
  Lines lines;
  for (std::size_t end = 0; (end = text.find('\n', lines.bytes)) != std::string_view::npos;) {
    lines.whole.emplace_back(text.substr(lines.bytes, end - lines.bytes));
    lines.bytes = end + 1;
  }
  return lines;
}

/// The lines after the first, which must be the identity.
std::vector<std::string> runs_of(const std::filesystem::path& file, const Lines& lines,
                                 const std::string& identity) {
  if (lines.whole.front() != identity) {
    fail(file, "holds runs of another evaluation (" + lines.whole.front().substr(0, 200) +
                   "), not of this one (" + identity + "); give another file or remove it");
  }
  return {lines.whole.begin() + 1, lines.whole.end()};
}

}  // namespace

RunLog::RunLog(const std::filesystem::path& file, const std::string& identity)
    : file_(file),
      descriptor_(
          ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666)) {
  if (is_other_than_a_file(file)) fail(file, std::string("cannot be opened: ") + kNoRegularFile);
  if (!descriptor_.is_open()) fail(file, std::string("cannot be opened: ") + std::strerror(errno));
  if (::flock(descriptor_.get(), LOCK_EX | LOCK_NB) != 0) {
    fail(file, "another tenon-evaluate is writing to it; wait for it or give another file");
  }
  const std::string text = text_of(file);
  const Lines lines = lines_of(text);
  if (!lines.whole.empty()) found_ = runs_of(file, lines, identity);
  was_torn_ = lines.bytes < text.size();
  // A log that tore in its first line holds the beginning of that, and nothing else does.
  if (lines.whole.empty() && !identity.starts_with(text)) {
    fail(file, "is no run log; give another file or remove it");
  }
  if (was_torn_ && ::ftruncate(descriptor_.get(), static_cast<off_t>(lines.bytes)) != 0) {
    fail(file, std::string("cannot be cut: ") + std::strerror(errno));
  }
  if (lines.whole.empty()) append(identity);
}

void RunLog::append(const std::string& line) {
  const std::string text = line + "\n";
  int error =
      write_all(descriptor_, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (error == 0 && ::fsync(descriptor_.get()) != 0) error = errno;
  if (error != 0) {
    throw std::runtime_error(file_.string() + ": cannot be written: " + std::strerror(error));
  }
}

std::vector<std::string> read_run_log(const std::filesystem::path& file,
                                      const std::string& identity) {
  const Lines lines = lines_of(text_of(file));
  if (lines.whole.empty()) fail(file, "is no run log: it has no whole line");
  return runs_of(file, lines, identity);
}

}  // namespace tenon::sim
