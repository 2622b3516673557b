// tenon-can: looks at the nodes of a CAN bus, reads and writes their objects.

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hw/can/open_bus.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/node_scan.h"
#include "hw/canopen/object_value.h"
#include "hw/canopen/sdo.h"
#include "hw/canopen/sdo_client.h"
#include "hw/cia402/drive_state.h"
#include "hw/main_can_check.h"
#include "hw/main_can_motors.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/canopen/constants.h"
#include "shared/config/command_line.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::hw {
namespace {

using canopen::SdoClient;

constexpr std::int64_t kTransferTimeout_ns = 500'000'000;
constexpr std::int64_t kListen_ns = 1'000'000'000;

/// Carries a transfer that has been started to its end.
void complete(CanBus& bus, SdoClient& client, const CanFrame& first) {
  (void)bus.send(first);
  while (client.state() == SdoClient::State::kBusy) {
    bus.wait(1'000'000);
    ReceivedFrame received;
    while (bus.receive(received)) {
      if (const auto next = client.process(received.frame, monotonic_now_ns())) {
        (void)bus.send(*next);
      }
    }
    if (const auto abort = client.update(monotonic_now_ns())) {
      (void)bus.send(*abort);
    }
  }
  bus.flush();
}

std::optional<std::uint32_t> read_number(CanBus& bus, const canopen::SdoAddress& address,
                                         std::int64_t timeout_ns) {
  SdoClient client(timeout_ns);
  complete(bus, client, client.start_upload(address, monotonic_now_ns()));
  if (client.state() != SdoClient::State::kDone) return std::nullopt;
  return client.value();
}

int report_failure(const SdoClient& client, const canopen::SdoAddress& address) {
  const char* reason = canopen::sdo_abort_text(client.abort_code());
  if (client.state() == SdoClient::State::kTimedOut) {
    std::fprintf(stderr,
                 "node %u: no answer for %04Xh:%u within %.1f s; expected 0x%03X; check power, "
                 "wiring, bit rate, node id\n",
                 static_cast<unsigned>(address.node), static_cast<unsigned>(address.index),
                 static_cast<unsigned>(address.sub), kTransferTimeout_ns * 1e-9,
                 tenon::canopen::kSdoResponse + address.node);
  } else {
    std::fprintf(stderr, "node %u: %04Xh:%u refused: %s (abort 0x%08X)\n",
                 static_cast<unsigned>(address.node), static_cast<unsigned>(address.index),
                 static_cast<unsigned>(address.sub),
                 reason != nullptr ? reason : "for a reason of its maker's own",
                 client.abort_code());
  }
  return 1;
}

int scan(CanBus& bus) {
  canopen::NodeScan scan;
  while (!scan.done(monotonic_now_ns())) {
    scan.update(monotonic_now_ns(), bus);
    bus.wait(1'000'000);
    ReceivedFrame received;
    while (bus.receive(received)) scan.process(received.frame);
  }
  for (unsigned id = 1; id <= canopen::NodeScan::kNodes; ++id) {
    const auto node = static_cast<std::uint8_t>(id);
    const canopen::NodeScan::Found& found = scan.found(node);
    if (found.answers == 0) continue;
    const auto vendor = read_number(bus, {node, tenon::canopen::kIdentity, 1}, kTransferTimeout_ns);
    std::printf("%s\n", canopen::describe(node, found, vendor).c_str());
    if (found.answers < 2) continue;
    std::fprintf(stderr,
                 "node %u: %u devices answered to one request; give each its own node id (with one "
                 "of them connected at a time)\n",
                 id, found.answers);
  }
  std::printf("%d node%s\n", scan.count(), plural(scan.count()));
  if (scan.count() == 0) {
    std::fprintf(stderr,
                 "nobody answered within %.0f s; check power, wiring and termination, and the bit "
                 "rate (--bitrate)\n",
                 1e-9 * canopen::NodeScan::kHearOut_ns);
  }
  return scan.count() > 0 && !scan.doubled() ? 0 : 1;
}

const char* nmt_text(std::uint8_t state) {
  switch (state & 0x7F) {
    case tenon::canopen::kStateBootUp:
      return "boot-up";
    case tenon::canopen::kStateStopped:
      return "stopped";
    case tenon::canopen::kStateOperational:
      return "operational";
    case tenon::canopen::kStatePreOperational:
      return "pre-operational";
  }
  return "unknown";
}

/// Heartbeats of one second, and the statusword of whoever has one.
int state(CanBus& bus) {
  std::array<std::optional<std::uint8_t>, 128> states;
  const std::int64_t end_ns = monotonic_now_ns() + kListen_ns;
  while (monotonic_now_ns() < end_ns) {
    bus.wait(10'000'000);
    ReceivedFrame received;
    while (bus.receive(received)) {
      if (const auto heartbeat = canopen::decode_heartbeat(received.frame)) {
        states[heartbeat->node] = heartbeat->state;
      }
    }
  }
  int found = 0;
  for (unsigned id = 1; id <= 127; ++id) {
    if (!states[id]) continue;
    ++found;
    std::printf("node %3u  %s", id, nmt_text(*states[id]));
    const auto word = read_number(
        bus, {static_cast<std::uint8_t>(id), tenon::canopen::kStatusword, 0}, kTransferTimeout_ns);
    if (word) {
      const auto status = static_cast<std::uint16_t>(*word);
      std::printf("  drive: %s (0x%04X)", cia402::to_string(cia402::decode_statusword(status)),
                  *word);
    }
    std::printf("\n");
  }
  if (found == 0) {
    std::fprintf(stderr,
                 "no heartbeat within 1 s; nodes produce none before they are configured "
                 "(1017h): try scan\n");
  }
  return found > 0 ? 0 : 1;
}

int read(CanBus& bus, const canopen::SdoAddress& address) {
  SdoClient client(kTransferTimeout_ns);
  complete(bus, client, client.start_upload(address, monotonic_now_ns()));
  if (client.state() != SdoClient::State::kDone) return report_failure(client, address);
  std::printf("%s\n", canopen::object_text(client.data()).c_str());
  return 0;
}

int write(CanBus& bus, const canopen::SdoAddress& address, std::span<const std::uint8_t> bytes) {
  SdoClient client(kTransferTimeout_ns);
  complete(bus, client, client.start_download(address, bytes, monotonic_now_ns()));
  return client.state() == SdoClient::State::kDone ? 0 : report_failure(client, address);
}

/// The device keeps its settings from now on (1010h:1, "save").
int store(CanBus& bus, std::uint8_t node) {
  constexpr std::array<std::uint8_t, 4> kSave = {'s', 'a', 'v', 'e'};
  const int status = write(bus, {node, tenon::canopen::kStoreParameters, 1}, kSave);
  if (status == 0) {
    std::printf("node %u: keeps its settings without power from now on\n",
                static_cast<unsigned>(node));
  }
  return status;
}

struct Arguments {
  std::string robot;
  std::string motors;
  std::vector<std::string> eds;
  std::string uri;
  std::uint32_t bitrate_bps = 1'000'000;
  unsigned node = 0;
  std::string index;
  std::string sub;
  std::string type;
  std::string value;

  [[nodiscard]] canopen::SdoAddress address() const {
    const auto index_bytes = canopen::object_bytes("u16", index);
    const auto sub_bytes = canopen::object_bytes("u8", sub);
    return {static_cast<std::uint8_t>(node),
            static_cast<std::uint16_t>(index_bytes[0] | index_bytes[1] << 8), sub_bytes[0]};
  }
};

constexpr const char* kFooter =
    "Exit status:\n"
    "  0  done; check: nothing is refused\n"
    "  1  nobody answered, a node refused, or two have one number; check: something is refused;\n"
    "     --robot: a motor is silent, in error, or holds other values than the file\n"
    "  2  bad input\n\n"
    "Examples:\n"
    "  tenon-can --can socketcan:can0 scan\n"
    "  tenon-can --can socketcan:can0 read 3 0x6041 0\n"
    "  tenon-can check hw/robots/lwa4p/robot.yaml --eds joint.dcf";

/// Of a subcommand. @param example what follows the program's name
std::string footer_of(const char* done, const char* failed, const char* example) {
  return format("Exit status:\n  0  %s\n  1  %s\n  2  bad input\n\nExamples:\n  tenon-can %s", done,
                failed, example);
}

void describe_node(CLI::App& command, Arguments& arguments) {
  command.add_option("NODE", arguments.node, "Its number on the bus")
      ->required()
      ->check(CLI::Range(1, 127));
}

struct Commands {
  CLI::App* scan = nullptr;
  CLI::App* state = nullptr;
  CLI::App* store = nullptr;
  CLI::App* check = nullptr;
  CLI::App* read = nullptr;
  CLI::App* write = nullptr;
};

Commands add_commands(CLI::App& app, Arguments& arguments) {
  Commands commands;
  commands.scan = app.add_subcommand("scan", "Ask all 127 nodes who they are");
  commands.state = app.add_subcommand("state", "Listen for heartbeats for a second");
  for (CLI::App* command : {commands.scan, commands.state}) {
    command->add_option("--robot", arguments.motors,
                        "Robot file of motors in MIT mode: ask these instead");
  }
  commands.store =
      app.add_subcommand("store", "Let a node keep its settings without power (1010h)");
  describe_node(*commands.store, arguments);
  commands.check =
      app.add_subcommand("check", "Without a bus: what bring-up would do to a robot's drives");
  commands.check->add_option("ROBOT", arguments.robot, "Robot file")->required();
  commands.check
      ->add_option("--eds", arguments.eds,
                   "EDS or DCF file of every joint's drive, or NODE=FILE; may be repeated")
      ->allow_extra_args(false);
  commands.read = app.add_subcommand("read", "Read an object");
  commands.write = app.add_subcommand("write", "Write an object");
  for (CLI::App* command : {commands.read, commands.write}) {
    describe_node(*command, arguments);
    command->add_option("INDEX", arguments.index, "Of the object, such as 0x6041")
        ->required()
        ->type_name("NUMBER");
    command->add_option("SUB", arguments.sub, "Its sub-index")->required()->type_name("NUMBER");
  }
  commands.write->add_option("TYPE", arguments.type, "What it is")
      ->required()
      ->type_name("TEXT:{u8,u16,u32,i8,i16,i32,str}");
  commands.write->add_option("VALUE", arguments.value, "What to write")
      ->required()
      ->type_name("WORD");
  return commands;
}

/// What each of them ends with, in place of what the whole program does.
void add_footers(const Commands& commands) {
  constexpr const char* kMotors =
      "--robot: a motor is silent, in error, or holds other values than the file";
  const std::string silent =
      std::string("nobody answered, or two have one number;\n     ") + kMotors;
  commands.scan->footer(footer_of("done", silent.c_str(), "--can socketcan:can0 scan"));
  commands.state->footer(footer_of("done",
                                   (std::string("there was no heartbeat; ") + kMotors).c_str(),
                                   "--can socketcan:can0 state"));
  constexpr const char* kRefused = "the node did not answer, or refused";
  commands.store->footer(footer_of("done", kRefused, "--can socketcan:can0 store 3"));
  commands.check->footer(footer_of("nothing is refused", "something is refused",
                                   "check hw/robots/lwa4p/robot.yaml --eds joint.dcf"));
  commands.read->footer(footer_of("done", kRefused, "--can socketcan:can0 read 3 0x6041 0"));
  commands.write->footer(
      footer_of("done", kRefused, "--can socketcan:can0 write 3 0x6083 0 u32 1000"));
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Looks at the nodes of a CAN bus, reads and writes their objects."};
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--can", arguments.uri,
                 "Bus: socketcan:IFACE, slcan:/dev/TTY or slcan://HOST:PORT; "
                 "needed by all but check");
  const auto* bitrate = app.add_option("--bitrate", arguments.bitrate_bps,
                                       "Bit rate, bit/s; set on slcan adapters, checked on "
                                       "SocketCAN; with --robot the file's")
                            ->capture_default_str();
  app.require_subcommand(1);
  const Commands commands = add_commands(app, arguments);
  add_footers(commands);
  app.footer(kFooter);  // subcommands that come after it would have it too
  parse(app, argc, argv);

  if (commands.check->parsed()) return check_robot_file(arguments.robot, arguments.eds);
  if (arguments.uri.empty()) throw InputError("--can: is required; see tenon-can --help");
  // Everything that was typed is checked before anything is opened.
  const bool with_object = commands.read->parsed() || commands.write->parsed();
  const canopen::SdoAddress address = with_object ? arguments.address() : canopen::SdoAddress{};
  const std::vector<std::uint8_t> bytes =
      commands.write->parsed() ? canopen::object_bytes(arguments.type, arguments.value)
                               : std::vector<std::uint8_t>{};
  std::optional<Robot> motors;
  if (!arguments.motors.empty()) motors = load_motors(arguments.motors);
  if (motors && bitrate->count() == 0) arguments.bitrate_bps = motors->bitrate_bps;
  const std::unique_ptr<CanBus> bus = open_bus(arguments.uri, arguments.bitrate_bps);
  if (motors) return look_at_motors(*bus, *motors, commands.state->parsed());
  if (commands.scan->parsed()) return scan(*bus);
  if (commands.store->parsed()) return store(*bus, static_cast<std::uint8_t>(arguments.node));
  if (commands.state->parsed()) return state(*bus);
  return commands.read->parsed() ? read(*bus, address) : write(*bus, address, bytes);
}

}  // namespace
}  // namespace tenon::hw

int main(int argc, char** argv) {
  return tenon::run_main("tenon-can", [&] { return tenon::hw::run(argc, argv); });
}
