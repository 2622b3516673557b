#include "executor/main_monitor_export.h"

#include <cstdio>

#include "executor/export/export_log.h"
#include "shared/base/error.h"
#include "shared/config/file_options.h"

namespace tenon::executor {

int run_export(const ExportOptions& options) {
  if (options.csv.empty() && options.mcap.empty()) {
    throw InputError("export: nothing to write; give --csv FILE, --mcap FILE or both");
  }
  for (const std::string& file : {options.csv, options.mcap}) {
    if (file == "-") throw InputError("export: -: give the name of a file");
  }
  check_apart({{"--csv", options.csv}, {"--mcap", options.mcap}}, {{"the log", options.log}});
  ExportRequest request;
  request.log = options.log;
  request.csv = options.csv;
  request.mcap = options.mcap;
  request.version = TENON_VERSION;
  if (options.run > 0) request.run = options.run;
  const Exported exported = export_log(request);
  for (const std::string& line : exported.written) std::printf("%s\n", line.c_str());
  for (const std::string& line : exported.notes) std::printf("%s\n", line.c_str());
  std::fflush(stdout);
  for (const std::string& line : exported.missing) {
    std::fprintf(stderr, "tenon-monitor: %s\n", line.c_str());
  }
  return exported.missing.empty() ? 0 : 1;
}

}  // namespace tenon::executor
