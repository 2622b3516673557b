#include "tests/socketcan/interfaces.h"

#include <cstdint>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace tenon::socketcan {
namespace {

constexpr int kInterruptDisable = 0x400;  // PCI command register, at byte 4 of the configuration
constexpr std::streamoff kCommandRegister = 4;

constexpr std::int64_t kQuiet_ns = 300'000'000;
constexpr std::int64_t kSoon_ns = 10'000'000'000;

}  // namespace

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string run(const std::string& command_line) {
  const tests::ScratchFolder scratch;
  tests::ChildProcess process(scratch.path(), words(command_line));
  const int status = process.wait();
  if (status != 0) {
    throw std::runtime_error("'" + command_line + "' failed (" + std::to_string(status) +
                             "): " + process.err());
  }
  return process.out();
}

VirtualInterface::VirtualInterface(std::string name) : name_(std::move(name)) {
  run("ip link add " + name_ + " type vcan");
  run("ip link set " + name_ + " up");
}

VirtualInterface::~VirtualInterface() {
  try {
    run("ip link del " + name_);
  } catch (const std::runtime_error&) {  // the test has removed it
  }
}

Controllers::Controllers(unsigned bitrate_bps) {
  for (const std::string name : {"can0", "can1"}) {
    run("ip link set " + name + " txqueuelen 100");
    run("ip link set " + name + " up type can listen-only off bitrate " +
        std::to_string(bitrate_bps));
  }
}

Controllers::~Controllers() {
  for (const std::string name : {"can0", "can1"}) {
    try {
      run("ip link set " + name + " down");
    } catch (const std::runtime_error&) {  // the test has pulled it out
    }
  }
}

InterruptHeld::InterruptHeld(const std::string& interface)
    : config_("/sys/class/net/" + interface + "/device/config") {
  mask(true);
}

InterruptHeld::~InterruptHeld() { mask(false); }

void InterruptHeld::mask(bool masked) const {
  std::fstream config(config_, std::ios::in | std::ios::out | std::ios::binary);
  config.seekg(kCommandRegister);
  int command = config.get();
  command |= config.get() << 8;
  command = masked ? command | kInterruptDisable : command & ~kInterruptDisable;
  config.seekp(kCommandRegister);
  config.put(static_cast<char>(command & 0xFF)).put(static_cast<char>(command >> 8));
}

CanFrame numbered(unsigned i) {
  return {0x100 + i % 0x100, false, false, 2, {std::uint8_t(i), std::uint8_t(i >> 8)}};
}

bool receive_soon(CanBus& bus, ReceivedFrame& received) {
  if (bus.receive(received)) return true;
  bus.wait(kSoon_ns);
  return bus.receive(received);
}

std::vector<CanFrame> drain(CanBus& bus) {
  std::vector<CanFrame> frames;
  for (int quiet = 0; quiet < 2; ++quiet) {
    for (ReceivedFrame received; bus.receive(received); quiet = 0) frames.push_back(received.frame);
    bus.wait(kQuiet_ns);
  }
  return frames;
}

}  // namespace tenon::socketcan
