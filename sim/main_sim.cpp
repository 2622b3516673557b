// tenon-sim: the virtual arm on its own clock. It answers on CAN like a real cell; what it knows
// beyond that goes to the truth file, and to who looks on from this machine (--view).

#include <sched.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hw/can/open_bus.h"
#include "hw/can/slcan_server.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/file_options.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/config/signals.h"
#include "shared/eds/device_file.h"
#include "shared/system/monotonic_clock.h"
#include "shared/task/find_start.h"
#include "sim/cell/devices/robot_devices.h"
#include "sim/cell/faults/fault_phases.h"
#include "sim/cell/faults/fault_spec.h"
#include "sim/cell/faults/faulty_bus.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "sim/cell/virtual_arm/one_client.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "sim/cell/virtual_arm/world_draw.h"
#include "sim/listener/step_listener.h"
#include "sim/view/live_view.h"
#include "sim/view/loopback.h"

namespace {

using namespace tenon;

constexpr std::int64_t kTick_ns = 1'000'000;
constexpr std::int64_t kLate_ns = 1'000'000;

std::atomic<bool> stop_requested{false};

struct CommandLine {
  std::string cell;
  std::string task;
  std::string can;
  std::string start;
  std::optional<std::uint64_t> seed;
  std::string offset;
  std::string experiment;
  std::vector<std::string> faults;
  std::vector<std::string> twins;
  std::string eds;
  std::string lcm_url;
  std::string json;
  std::string ready_file;
  std::optional<std::uint16_t> view_port;
  bool once = false;
};

struct Lateness {
  std::uint64_t wakes = 0;
  std::uint64_t late = 0;
  std::int64_t max_ns = 0;

  void count(std::int64_t late_ns) {
    ++wakes;
    if (late_ns > kLate_ns) ++late;
    max_ns = std::max(max_ns, late_ns);
  }
};

/// @param server, steps, view null where there is none
Lateness run(sim::VirtualCell& cell, sim::FaultyBus& bus, const hw::SlcanServer* server,
             sim::StepListener* steps, sim::LiveView* view) {
  Lateness lateness;
  sim::OneClient one_client;
  std::int64_t due_ns = monotonic_now_ns();
  while (!stop_requested.load(std::memory_order_relaxed)) {
    const std::int64_t now_ns = monotonic_now_ns();
    if (now_ns >= due_ns) {
      lateness.count(now_ns - due_ns);
      due_ns += kTick_ns * ((now_ns - due_ns) / kTick_ns + 1);
    }
    if (steps != nullptr) steps->listen();
    bus.advance(now_ns);
    cell.step(now_ns, bus);
    if (view != nullptr) view->look(cell, now_ns);
    if (server != nullptr &&
        one_client.finished(server->clients() > 0, cell.at_standstill(), now_ns)) {
      break;
    }
    bus.wait(std::max<std::int64_t>(0, due_ns - monotonic_now_ns()));
  }
  return lateness;
}

/// "listening on 127.0.0.1:29536", with the port that was free where 0 was asked for; "on" what is
/// no server.
std::string place(const std::string& uri, const CanBus& bus) {
  const std::uint16_t port = hw::listening_port(bus);
  if (port == 0) return "on " + uri;
  const std::string address = uri.substr(uri.find("//") + 2);
  return "listening on " + address.substr(0, address.rfind(':')) + ":" + std::to_string(port);
}

void announce(const CommandLine& line, const hw::BusUris& uris, hw::Buses& buses,
              const sim::LiveView* view) {
  if (view != nullptr) std::printf("view: %s\n", view->url().c_str());
  std::string text = place(uris.arm, buses.arm());
  if (buses.sensor() != nullptr) {
    text = "arm: " + text + "\nsensor: " + place(uris.sensor, *buses.sensor());
  }
  text += "\n";
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
  if (!line.ready_file.empty()) write_file(line.ready_file, text);
}

/// Below an executor's priority, so that on a shared core the simulated drives wait for it. Where
/// the system refuses, the arm runs all the same, and says how late it was.
void raise_priority() {
  sched_param parameters{};
  parameters.sched_priority = 40;
  static_cast<void>(::sched_setscheduler(0, SCHED_FIFO, &parameters));
}

void write_data_sheets(const std::filesystem::path& folder, const Robot& robot) {
  for (const sim::EdsFile& file : sim::eds_files(robot)) write_file(folder / file.name, file.text);
}

/// NODE=FILE.
std::pair<std::uint8_t, DeviceFile> read_twin(const std::string& text) {
  const std::size_t equals = text.find('=');
  unsigned node = 0;
  const char* end = text.data() + std::min(equals, text.size());
  const auto [rest, error] = std::from_chars(text.data(), end, node);
  if (equals == std::string::npos || error != std::errc{} || rest != end || node < 1 ||
      node > 127) {
    throw InputError("--twin " + text + ": must be NODE=FILE, NODE in [1, 127]");
  }
  const std::string file = text.substr(equals + 1);
  DeviceFile device = parse_device_file(file, config::read_file(file));
  for (const std::string& slip : device.slips) {
    std::fprintf(stderr, "tenon-sim: %s\n", slip.c_str());
  }
  return {static_cast<std::uint8_t>(node), std::move(device)};
}

/// Null where no fault waits for a step of the plan.
std::unique_ptr<sim::StepListener> listen_for_steps(const CommandLine& line,
                                                    const std::vector<sim::Fault>& faults,
                                                    sim::FaultPhases& phases) {
  const bool wanted = std::any_of(faults.begin(), faults.end(), [](const sim::Fault& fault) {
    return fault.at_step.has_value();
  });
  if (wanted && line.lcm_url.empty()) {
    throw InputError(
        "--fault at=step: the executor alone knows the plan's step; give --lcm-url, where its "
        "telemetry goes");
  }
  if (!wanted && !line.lcm_url.empty()) {
    throw InputError("--lcm-url " + line.lcm_url +
                     ": is for a --fault with at=step:N, and there is none");
  }
  if (!wanted) return nullptr;
  return std::make_unique<sim::StepListener>(
      line.lcm_url, [&phases](int step) { phases.begin_step(step, monotonic_now_ns()); });
}

/// A fault that never struck proves nothing: that is said. @param on_ns when the cell was switched
/// on, on the clock of `phases`
void tell_who_waited_in_vain(const CommandLine& line, const std::vector<sim::Fault>& faults,
                             const sim::FaultPhases& phases, std::int64_t on_ns, double time_s) {
  const std::int64_t end_ns = on_ns + static_cast<std::int64_t>(1e9 * time_s);
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const std::optional<std::int64_t> begins_ns = sim::begin_ns(faults[i], on_ns, &phases);
    if (begins_ns && *begins_ns <= end_ns) continue;
    const std::string why =
        begins_ns           ? format("its time never came: the cell ran for %.1f s", time_s)
        : faults[i].at_step ? "that step never ran, or --lcm-url brought no word of it"
                            : "what it waits for never happened";
    std::fprintf(stderr, "tenon-sim: --fault %s: never struck: %s\n", line.faults[i].c_str(),
                 why.c_str());
  }
}

/// Where the environment stands and what is wrong in the cell, as the command line has it.
sim::VirtualCell::Options world_of(const CommandLine& line, const Task& task) {
  sim::VirtualCell::Options options;
  options.start = line.start;
  options.watched = line.view_port.has_value();
  options.seed = line.seed.value_or(0);
  if (!line.offset.empty()) options.offset = sim::parse_offset(line.offset, task.coordinates);
  if (line.seed) {
    const Start& start = start_or_first(task, line.start);
    options.offset = sim::draw_offset(task, start, *line.seed);
    std::printf("seed %llu\n", static_cast<unsigned long long>(*line.seed));
  }
  if (!line.experiment.empty()) {
    options.world = sim::draw_world(load_experiment(line.experiment), task, *line.seed);
  }
  for (const std::string& fault : line.faults) options.faults.push_back(sim::parse_fault(fault));
  for (const std::string& twin : line.twins) {
    if (!options.twins.insert(read_twin(twin)).second) {
      throw InputError("--twin " + twin + ": this node has a twin already");
    }
  }
  return options;
}

/// Null where nobody wants to look on.
std::unique_ptr<sim::LiveView> open_view(const CommandLine& line, const Cell& cell_file,
                                         const Task& task, const sim::WorldDraw& world,
                                         const sim::VirtualCell& cell) {
  if (!line.view_port) return nullptr;
  sim::ViewedWorld viewed;
  viewed.task = sim::real_task(task, world);
  viewed.start = line.start;
  viewed.cell = cell_file.name;
  viewed.X_BT = cell_file.X_BT;
  viewed.X_BE = cell.environment();
  viewed.drives = cell_file.robot.joints.size();
  viewed.run_id = std::to_string(::getpid()) + "-" + std::to_string(monotonic_now_ns());
  return std::make_unique<sim::LiveView>(*line.view_port, viewed);
}

/// What people are told at the end, on the terminal and in the view.
void tell_the_end(const sim::Truth& truth, sim::LiveView* view) {
  std::fputs(sim::describe(truth).c_str(), stdout);
  std::printf("simulated %.1f s; woke late by more than 1 ms %llu of %llu times, worst %.2f ms\n",
              truth.time_s, static_cast<unsigned long long>(truth.wakes_late),
              static_cast<unsigned long long>(truth.wakes), truth.late_max_ms);
  if (view == nullptr) return;
  view->end(truth);
  std::fputs(view->describe().c_str(), stdout);
}

int simulate(const CommandLine& line) {
  check_apart({{"--json", line.json}, {"--ready-file", line.ready_file}},
              {{"--cell", line.cell}, {"--task", line.task}, {"--experiment", line.experiment}});
  Cell cell_file = load_cell(line.cell);
  const hw::BusUris uris = hw::parse_bus_uris(line.can);
  hw::settle_buses(uris, cell_file.robot);
  if (!line.eds.empty()) write_data_sheets(line.eds, cell_file.robot);
  const Task task = load_task(line.task);
  sim::VirtualCell::Options options = world_of(line, task);
  if (!line.json.empty()) check_writable(line.json);
  sim::FaultPhases phases;
  options.phases = &phases;
  const std::unique_ptr<sim::StepListener> steps = listen_for_steps(line, options.faults, phases);
  sim::VirtualCell cell(cell_file, task, options);

  hw::Buses buses(uris, cell_file.robot);
  // Whoever runs the arm is on the arm's bus, whatever else there is.
  const auto* server = dynamic_cast<const hw::SlcanServer*>(&buses.arm());
  if (line.once && server == nullptr) {
    throw InputError("--once: needs a bus with clients, such as --can slcan-listen://127.0.0.1:0");
  }
  // Its threads are none of the simulation's, and get nothing of its priority.
  const auto view = open_view(line, cell_file, task, options.world, cell);
  raise_priority();
  stop_on_signals(stop_requested);
  announce(line, uris, buses, view.get());
  const std::int64_t on_ns = monotonic_now_ns();
  sim::FaultyBus faulty_bus(buses.all(), options.faults, cell_file.robot.master_node, on_ns,
                            &phases);
  const Lateness lateness =
      run(cell, faulty_bus, line.once ? server : nullptr, steps.get(), view.get());

  sim::Truth truth = cell.truth();
  truth.wakes = lateness.wakes;
  truth.wakes_late = lateness.late;
  truth.late_max_ms = static_cast<double>(lateness.max_ns) * 1e-6;
  truth.frames_lost = buses.all().status().send_failures;
  tell_the_end(truth, view.get());
  tell_who_waited_in_vain(line, options.faults, phases, on_ns, truth.time_s);
  FinalFiles files;
  files.write({"--json", line.json}, sim::truth_json(truth));
  if (truth.solver_messages == 0) return files.conclude("tenon-sim", 0);
  std::fprintf(stderr, "tenon-sim: the physics solver gave up %llu times; do not trust this run\n",
               static_cast<unsigned long long>(truth.solver_messages));
  return files.conclude("tenon-sim", 1);
}

void answer_help(const std::string& fault) {
  if (fault != "help") return;
  std::fputs(sim::fault_help().c_str(), stdout);
  throw CommandLineAnswered{};
}

/// Where the environment and the tool stand.
void add_world(CLI::App& app, CommandLine& line) {
  app.add_option("--start", line.start, "Where the tool stands; default: the task's first start")
      ->type_name("NAME");
  CLI::Option* seed = app.add_option(
      "--seed", line.seed, "How far the environment is off is drawn by it, and the sensor's noise");
  constexpr std::uint64_t kSeedMax = std::uint64_t{1} << 53U;  // what a JSON reader keeps exactly
  seed->check(CLI::Range(std::uint64_t{0}, kSeedMax).description("[0, 2^53]"));
  app.add_option("--offset", line.offset, "How far the environment is off: x_m=0.02,y_m=-0.01")
      ->type_name("ERRORS")
      ->excludes(seed);
  app.add_option("--experiment", line.experiment,
                 "Ranges to draw from how the world differs from what task and cell file say")
      ->needs(seed);
}

int parse_and_simulate(int argc, char** argv) {
  CommandLine line;
  CLI::App app{"The virtual arm: drives, sensor and physics behind a CAN bus, on their own clock.",
               "tenon-sim"};
  app.footer(
      "Exit status:\n"
      "  0  it ran until it was ended\n"
      "  1  physics gave up, and the run means nothing; or the truth could not be written\n"
      "  2  bad input, or a place that nothing can be written to\n\n"
      "Examples:\n"
      "  tenon-sim --cell hw/cells/gantry3.yaml --task planner/tasks/box_on_table_2d.yaml \\\n"
      "            --start 7 --seed 1 --can slcan-listen://127.0.0.1:29536 --json truth.json");
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--cell", line.cell, "Cell file")->required();
  app.add_option("--task", line.task, "Task file: held part, environment, starts")->required();
  app.add_option(
         "--can", line.can,
         "Bus; slcan-listen://HOST:PORT serves it, port 0: a free one; arm=URI,sensor=URI for a "
         "force/torque sensor with a bus of its own")
      ->required();
  add_world(app, line);
  app.add_option("--fault", line.faults,
                 "A fault of the bus or a device, as drop:node=3,time_s=2; may be repeated; "
                 "--fault help lists them")
      ->type_name("FAULT")
      ->allow_extra_args(false)
      ->each(answer_help);
  app.add_option("--lcm-url", line.lcm_url,
                 "Where the executor's telemetry comes from: a fault with at=step:N hears from it "
                 "which step runs")
      ->type_name("URL");
  app.add_option("--twin", line.twins,
                 "NODE=FILE: that joint's drive answers with the objects, limits and access types "
                 "of an EDS or DCF file; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--eds", line.eds, "Folder for an EDS file of every node, written at the start")
      ->check(CLI::ExistingDirectory);
  app.add_option("--json", line.json, "File for the truth, written whole at the end");
  app.add_option("--ready-file", line.ready_file, "File that appears when the bus is open");
  app.add_option_function<std::string>(
         "--view",
         [&line](const std::string& text) { line.view_port = sim::parse_view_port(text); },
         "Shows the cell as it really is, live, in a browser on this machine: at "
         "http://127.0.0.1:PORT/, or at a free port")
      ->expected(0, 1)
      ->type_name("PORT")
      ->option_text("[PORT]");
  app.add_flag("--once", line.once, "End when the client has gone and the arm is at rest");
  parse(app, argc, argv);
  return simulate(line);
}

}  // namespace

int main(int argc, char** argv) {
  return run_main("tenon-sim", [&] { return parse_and_simulate(argc, argv); });
}
