#include "executor/main_exec_options.h"

#include <CLI/CLI.hpp>
#include <vector>

#include "shared/base/error.h"
#include "shared/config/command_line.h"
#include "shared/config/file_options.h"
#include "shared/config/load.h"
#include "shared/system/lcm_url.h"

namespace tenon::executor {
namespace {

// What is run; the two are exclusive.
void add_work(CLI::App& app, Options& options) {
  std::vector<CLI::Option*> of_a_plan = {
      app.add_option("--plan", options.plan, "Plan file (.tnp)"),
      app.add_flag("--dry-run", options.dry_run,
                   "Only go through the plan with the cell's arm in mind; needs no --can"),
      app.add_flag("--step", options.step, "Wait for Enter before every step of the plan"),
      app.add_flag("--keys", options.keys,
                   "While it runs, p and Enter pauses the move, r and Enter goes on"),
      app.add_flag("--go-to-start", options.go_to_start, "Move to the plan's start first"),
      app.add_option("--trace", options.trace, "Inputs of every guarded move, to replay")};
  app.add_option(
      "--can", options.can,
      "Bus: socketcan:can0, slcan:/dev/ttyACM0 or slcan://HOST:PORT; arm=URI,sensor=URI where the "
      "force/torque sensor has a bus of its own");
  app.add_option("--rt", options.rt, "Ask for real time, and start without it or not")
      ->check(CLI::IsMember({"require", "prefer", "off"}))
      ->capture_default_str();
  app.add_option("--cpu", options.cpu, "Processor for the control loop")
      ->check(CLI::Range(0, 1023));
  CLI::Option* payload = app.add_flag("--identify-payload", options.identify_payload,
                                      "Instead of a plan: payload and sensor bias, in some poses");
  CLI::Option* contact =
      app.add_option("--identify-contact", options.identify_contact,
                     "Instead of a plan: stiffness and lag at what stands along this way, in the "
                     "task frame")
          ->type_name("TEXT:{x,-x,y,-y,z,-z}");
  CLI::Option* friction = app.add_option(
      "--identify-friction", options.identify_friction,
      "Instead of a plan: friction of each joint, into the file that a cell's joint_torque names");
  contact->excludes(payload)->excludes(friction);
  payload->excludes(friction);
  for (CLI::Option* option : of_a_plan) {
    option->excludes(payload)->excludes(contact)->excludes(friction);
  }
}

void add_outputs(CLI::App& app, Options& options) {
  app.add_option("--lcm-url", options.lcm_url, "Where telemetry goes, or none")
      ->type_name("URL")
      ->capture_default_str();
  app.add_option("--log", options.log,
                 "Telemetry of every cycle, for tenon-monitor, tenon-inspect and lcm-logplayer");
  app.add_option("--can-log", options.can_log, "Frames in candump's format, FILE.log");
  app.add_option("--json", options.json, "Result, - for standard output");
  app.add_option("--black-box", options.black_box, "The last second as CSV, after a fault")
      ->capture_default_str();
}

}  // namespace

Options parse_options(int argc, char** argv) {
  Options options;
  CLI::App app{"Executes a plan of guarded moves on an arm over CAN."};
  app.footer(
      "Exit status:\n"
      "  0  the plan is done, or something was identified, and the drives are off;\n"
      "     --dry-run: it can be done\n"
      "  1  it failed, faulted or was stopped, or a file that was asked for is not whole\n"
      "  2  bad input, a plan that this cell cannot execute, or a place that nothing can be "
      "written to\n\n"
      "Examples:\n"
      "  tenon-exec --cell hw/cells/gantry3.yaml --plan plan.tnp --dry-run\n"
      "  tenon-exec --cell hw/cells/gantry3.yaml --plan plan.tnp \\\n"
      "             --can slcan://127.0.0.1:29536 --log run.lcmlog --json result.json");
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--cell", options.cell, "Cell file (YAML)")->required();
  add_work(app, options);
  add_outputs(app, options);
  parse(app, argc, argv);
  return options;
}

void check_outputs(const Options& options) {
  std::vector<FileOption> written = {{"--json", options.json},
                                     {"--identify-friction", options.identify_friction}};
  if (!options.dry_run) {
    written.insert(written.end(), {{"--log", options.log},
                                   {"--can-log", options.can_log},
                                   {"--trace", options.trace},
                                   {"--black-box", options.black_box}});
  }
  check_apart(written, {{"--cell", options.cell}, {"--plan", options.plan}});
  if (!options.dry_run) {
    if (options.can.empty()) throw InputError("--can is required, but for --dry-run; see --help");
    if (options.can.find("slcan-listen:") != std::string::npos) {
      throw InputError("--can " + options.can +
                       ": listens for an arm that would have to call; give slcan://HOST:PORT");
    }
    if (options.lcm_url != "none") {
      check_lcm_publishes(options.lcm_url);
      check_lcm_url(options.lcm_url);
    }
    check_writable(options.black_box);
  }
  if (!options.identify_friction.empty()) check_writable(options.identify_friction);
  if (!options.json.empty() && options.json != "-") check_writable(options.json);
}

}  // namespace tenon::executor
