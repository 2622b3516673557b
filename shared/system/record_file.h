#pragma once
// A file that is written record by record while something runs: a log, a trace. A disk that takes
// no more loses records of the file and never ends what is recorded; what is lost is counted, for
// whoever tells what the run left behind. Allocates and blocks: not for real time. One thread.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tenon {

/// What became of the records of a file.
struct RecordReport {
  std::string name;  ///< of the option that asked for it, as in "can_log"
  std::string file;
  std::uint64_t written = 0;  ///< the system has taken them
  std::uint64_t lost = 0;
  std::string reason;  ///< of the first loss

  [[nodiscard]] bool whole() const { return reason.empty(); }
  void lose(std::uint64_t records, const std::string& why);
};

/// "--can-log run.log: 12 of 400 records lost (No space left on device)"
[[nodiscard]] std::string loss_text(const RecordReport& report);

class RecordFile {
 public:
  /// Empties the file or makes it. @throws InputError where it cannot be written, or is no regular
  /// file
  RecordFile(std::string name, const std::filesystem::path& file);
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;
  ~RecordFile() { close(); }

  /// @param records that the bytes hold; 0 for a heading
  void add(std::string_view bytes, std::uint64_t records = 1);
  /// Hands over to the system. After the first record that it does not take, all others are lost
  /// too: a file has its end there, and no hole.
  void flush();
  /// Nothing can be added any more.
  void close();

  /// Counts what has been handed over; whole after close().
  [[nodiscard]] const RecordReport& report() const { return report_; }

 private:
  struct Pending {
    std::size_t end;  ///< in the buffer
    std::uint64_t records;
  };
  RecordReport report_;
  std::FILE* stream_;
  std::string buffer_;
  std::vector<Pending> pending_;
};

}  // namespace tenon
