#pragma once
// What runs a log holds, and how far it can be read: the first of two readings. Offline; one
// thread.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "executor/export/message_columns.h"
#include "lcmtypes/tenon/run_setup_t.hpp"

namespace tenon::executor {

/// A run, by the numbers of its events in the log.
struct LoggedRun {
  std::size_t first_event = 0;
  std::size_t end_event = 0;  ///< behind its last
  std::optional<tenon::run_setup_t> setup;
  std::size_t joint_count = 0;  ///< of the first cycle
  std::uint64_t cycles = 0;
  std::int64_t start_ns = 0;  ///< monotonic, of the first cycle
  std::int64_t start_us = 0;  ///< when it was published, since 1970
  std::int64_t last_ns = 0;   ///< monotonic, of the last cycle
  bool ended = false;         ///< its end was told

  /// Names from the setup; numbers where the log has none.
  [[nodiscard]] std::vector<JointName> joints() const;
  /// A time of the run's clock after the first cycle; 0 before.
  [[nodiscard]] std::int64_t since_ns(std::int64_t monotonic_ns) const;
};

struct LogScan {
  std::vector<LoggedRun> runs;  ///< that have a cycle
  std::uint64_t malformed = 0;  ///< messages of Tenon's channels
  bool breaks_off = false;      ///< the file ends within an event
  std::string damage;           ///< where it is no log any more, one line; empty: nowhere
  bool open = false;            ///< something of a run came, and not its end
};

/// @throws InputError where the file cannot be read, is no log, or holds no cycle of a run
[[nodiscard]] LogScan scan_log(const std::filesystem::path& file);

/// What a log lacks, for who has it played: damage, a broken end, or the end of its last run.
/// @return one line; empty where nothing is missing
/// @throws InputError where the file cannot be read, or is no log
[[nodiscard]] std::string log_lacks(const std::filesystem::path& file);

}  // namespace tenon::executor
