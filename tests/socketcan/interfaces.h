#pragma once
// CAN interfaces of the kernel, set up and taken down by the tests themselves with the system's own
// programs. Needs root, or a user and network namespace of one's own.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "shared/ports/can_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/scratch_folder.h"

namespace tenon::socketcan {

inline constexpr std::uint32_t kMbit_bps = 1'000'000;

/// The words of a line; none contains a space.
[[nodiscard]] std::vector<std::string> words(const std::string& line);

/// Runs a program of the system to its end and gives back what it printed.
/// @throws std::runtime_error with what it complained of where it fails
std::string run(const std::string& command_line);

/// A virtual interface that is there and up while this is.
class VirtualInterface {
 public:
  explicit VirtualInterface(std::string name);
  VirtualInterface(const VirtualInterface&) = delete;
  VirtualInterface& operator=(const VirtualInterface&) = delete;
  ~VirtualInterface();

 private:
  std::string name_;
};

/// The two controllers of the guest, can0 and can1, up while this is there.
class Controllers {
 public:
  explicit Controllers(std::uint32_t bitrate_bps = kMbit_bps);
  Controllers(const Controllers&) = delete;
  Controllers& operator=(const Controllers&) = delete;
  ~Controllers();
};

/// A controller's PCI interrupt is masked while this is there: the kernel hears of nothing that
/// happens on its bus, neither that a frame has left nor that one has come.
class InterruptHeld {
 public:
  explicit InterruptHeld(const std::string& interface);
  InterruptHeld(const InterruptHeld&) = delete;
  InterruptHeld& operator=(const InterruptHeld&) = delete;
  ~InterruptHeld();

 private:
  void mask(bool masked) const;

  std::filesystem::path config_;
};

/// A program that runs beside the test and is ended with it. Its output is in a file.
class Beside {
 public:
  explicit Beside(const std::string& command_line)
      : process_(scratch_.path(), words(command_line)) {}

  [[nodiscard]] tests::ChildProcess& process() { return process_; }

 private:
  tests::ScratchFolder scratch_;
  tests::ChildProcess process_;
};

/// A frame of two bytes that tells which it is.
[[nodiscard]] CanFrame numbered(unsigned i);

/// Waits for a frame, for a bounded time that no test comes near.
[[nodiscard]] bool receive_soon(CanBus& bus, ReceivedFrame& received);

/// Everything that comes until the bus has been quiet for a while.
[[nodiscard]] std::vector<CanFrame> drain(CanBus& bus);

}  // namespace tenon::socketcan
