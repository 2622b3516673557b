#pragma once
// How long each frame of an arm takes from its sender's queue to its end on the bus: nominal
// (alone, without stuffing) and worst case. Set-up code.
//
// The worst case follows the analysis of CAN with FIFO transmit queues (Davis, Kollmann, Pollex,
// Slomka: "Controller Area Network (CAN) Schedulability Analysis with FIFO Queues", ECRTS 2011),
// because SocketCAN queues in a FIFO: a frame waits for all that its sender may have queued before
// it, and these arbitrate with the least urgent identifier among them. With M the frames of the
// sender's queue, L the least urgent of these, C a frame's longest time, T its period:
//
//   w = B + sum of C over M - min C over M
//         + sum over k more urgent than L, not in M, of ceil((w + f_k + tau) / T_k) C_k
//   R = w + min C over M          f = R - min C over M, how long a frame may wait for its turn
//
// B is the longest frame less urgent than L, tau a bit. The parts of a cycle follow one another, so
// frames of different parts never compete (heartbeats of devices do, with all), and frames of one
// part compete once; the assumption is that a cycle's frames are through before the next SYNC,
// which is what leaves_room() is about.

#include <cstdint>
#include <string>
#include <vector>

#include "hw/arm/frame_set.h"
#include "shared/cell/robot.h"

namespace tenon::hw {

struct ResponseTime {
  BusFrame frame;
  double nominal_us = 0.0;
  double worst_us = 0.0;
};

struct ResponseTimes {
  std::vector<ResponseTime> frames;
  double cycle_us = 0.0;
  /// From queueing SYNC to the end of the last feedback.
  double feedback_nominal_us = 0.0;
  double feedback_worst_us = 0.0;
  /// The setpoints after that, as a burst.
  double command_nominal_us = 0.0;
  double command_worst_us = 0.0;

  /// What is left of a cycle for deciding, setpoints and a late wake-up.
  [[nodiscard]] double room_us() const { return cycle_us - feedback_worst_us; }
  [[nodiscard]] bool leaves_room() const { return room_us() > 0.0; }
};

/// @throws InputError where the frames' worst case does not fit the bus at all
[[nodiscard]] ResponseTimes response_times(const Robot& robot, std::uint8_t bus = kArmBus);

/// Throws InputError with the numbers where the last feedback may come after the next SYNC.
void check_response_times(const Robot& robot);

/// A table for people, a line a frame.
[[nodiscard]] std::string describe(const ResponseTimes& times);

}  // namespace tenon::hw
