#pragma once
// A run's log as files for other tools: CSV and MCAP, each whole or not there. Offline; one thread.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tenon::executor {

struct ExportRequest {
  std::filesystem::path log;
  std::filesystem::path csv;       ///< empty: none
  std::filesystem::path mcap;      ///< empty: none
  std::optional<std::size_t> run;  ///< from 1; unset: the last of the log
  std::string version;             ///< of Tenon, for the files
};

struct Exported {
  std::vector<std::string> written;  ///< a line each
  std::vector<std::string> missing;  ///< what of the log is not in them, a line each
  std::vector<std::string> notes;    ///< what the log itself does not have, a line each
};

/// Reads the log twice, message by message: of a long run no more than one is held.
/// @throws InputError where the log cannot be read, holds no such run, or a file cannot be written;
/// std::runtime_error where the disk takes no more
[[nodiscard]] Exported export_log(const ExportRequest& request);

}  // namespace tenon::executor
