#pragma once
// An LCM log, which lcm-logplayer, lcm-spy and tenon-monitor read. Written here and not by LCM,
// which does not tell of a full disk. Not for real time.
//
//   | Bytes | Name       | Type   | Meaning                                |
//   | 0-3   | sync       | u32 be | EDA1DA01h                              |
//   | 4-11  | number     | i64 be | events before this one                 |
//   | 12-19 | time       | i64 be | us since 1970                          |
//   | 20-23 | name_size  | i32 be | bytes of the channel's name            |
//   | 24-27 | data_size  | i32 be | bytes of the message                   |
//   | 28-   | name, data |        |                                        |

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "shared/system/record_file.h"

namespace tenon::executor {

class EventLog {
 public:
  /// @throws InputError where the file cannot be written
  explicit EventLog(const std::filesystem::path& file) : file_("log", file) {}

  void add(std::int64_t time_us, std::string_view channel, std::span<const std::uint8_t> message);
  void close() { file_.close(); }
  [[nodiscard]] const RecordReport& report() const { return file_.report(); }

 private:
  RecordFile file_;
  std::int64_t events_ = 0;
};

}  // namespace tenon::executor
