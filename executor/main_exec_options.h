#pragma once
// The command line of tenon-exec; README.md has the options.

#include <string>

#include "executor/telemetry/telemetry.h"

namespace tenon::executor {

struct Options {
  std::string cell;
  std::string plan;
  std::string can;
  std::string rt = "prefer";
  int cpu = -1;
  bool go_to_start = false;
  bool step = false;  ///< by step
  bool keys = false;
  bool dry_run = false;
  bool identify_payload = false;
  std::string identify_contact;   ///< direction
  std::string identify_friction;  ///< file to write
  std::string lcm_url = kDefaultLcmUrl;
  std::string log;
  std::string can_log;
  std::string trace;
  std::string json;
  std::string black_box = "tenon-black-box.csv";

  [[nodiscard]] bool identifies() const {
    return identify_payload || !identify_contact.empty() || !identify_friction.empty();
  }
};

/// @throws InputError for bad usage, CommandLineAnswered after --help or --version
[[nodiscard]] Options parse_options(int argc, char** argv);

/// What must hold before any file is read or the bus is opened. @throws InputError
void check_outputs(const Options& options);

}  // namespace tenon::executor
