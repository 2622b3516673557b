#pragma once
// Writes frames in candump's log format, which canplayer, log2asc, python-can and Wireshark read;
// some of them know it by the suffix .log alone:
//
//   (1.500000) can0 201#0F000102        11 bit      (1.500000) can0 00012345#0102   29 bit
//   (1.500000) can0 201#R6              remote, 6 bytes asked for
//
// Not real-time (files, strings): belongs to the thread that empties the ring.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "hw/can/recording_bus.h"
#include "shared/ports/can_bus.h"
#include "shared/system/record_file.h"

namespace tenon::hw {

/// One line without its end. Times are cut to microseconds.
[[nodiscard]] std::string candump_line(const ReceivedFrame& record, const std::string& interface);

class CandumpLog {
 public:
  /// The names of bus 0 and of a second one.
  using Interfaces = std::array<std::string, 2>;

  /// Throws InputError where the file cannot be written.
  /// @param unix_offset_ns what is added to a frame's time to make it one since 1970, as other
  /// tools have them; 0: times stay as they are
  explicit CandumpLog(const std::filesystem::path& file, Interfaces interfaces = {"can0", "can1"},
                      std::int64_t unix_offset_ns = 0);

  /// Writes everything that the ring holds and hands it to the system.
  void drain(CanRecordRing& ring);
  /// The last time. What the ring has lost is lost to the log.
  [[nodiscard]] RecordReport close(CanRecordRing& ring);

 private:
  RecordFile file_;
  Interfaces interfaces_;
  std::int64_t unix_offset_ns_;
};

}  // namespace tenon::hw
