#pragma once
// tenon-monitor export: a log as files for other tools.

#include <cstddef>
#include <string>

namespace tenon::executor {

struct ExportOptions {
  std::string log;
  std::string csv;
  std::string mcap;
  std::size_t run = 0;  ///< 0: the last
};

/// @return the exit status: 1 where something of the log is not in the files
int run_export(const ExportOptions& options);

}  // namespace tenon::executor
