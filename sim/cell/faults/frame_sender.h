#pragma once
// Which node sends a frame, and what it is, as a bus analyser would know it: by the predefined
// identifiers of CiA 301 (7.3.5), corrected by what it has overheard of a master that gives process
// data other identifiers (SDO downloads of 14xxh:1 and 18xxh:1), and of one that asks motors in MIT
// mode for theirs (register 7). One thread.

#include <cstdint>
#include <map>
#include <set>

#include "shared/canopen/constants.h"
#include "shared/mit/constants.h"
#include "shared/ports/can_bus.h"
#include "sim/cell/faults/fault.h"

namespace tenon::sim {

class FrameSender {
 public:
  /// @param master_node taken as the sender of what no device sends: NMT, SYNC, RPDOs, requests
  explicit FrameSender(std::uint8_t master_node) : master_node_(master_node) {}

  [[nodiscard]] std::uint8_t node_of(const CanFrame& frame) const {
    if (frame.extended) return 0;
    const auto given = given_.find(frame.id);
    if (given != given_.end()) return given->second;
    if (taken_.contains(frame.id)) return master_node_;
    const auto node = static_cast<std::uint8_t>(frame.id & 0x7Fu);
    const std::uint32_t function = frame.id & 0x780u;
    const bool process_data = function >= canopen::kTpdo1 && function < canopen::kSdoResponse;
    // TPDOs and RPDOs take turns: 180h, 200h, 280h, 300h, ...
    const bool from_device =
        node != 0 && (function == canopen::kEmergency || function == canopen::kSdoResponse ||
                      function == canopen::kHeartbeat ||
                      (process_data && (function - canopen::kTpdo1) % 0x100u == 0));
    return from_device ? node : master_node_;
  }

  [[nodiscard]] FrameKind kind_of(const CanFrame& frame) const {
    if (frame.extended) return FrameKind::kAny;
    if (frame.id == canopen::kSync) return FrameKind::kSync;
    if (given_.contains(frame.id)) return FrameKind::kAnswers;
    if (taken_.contains(frame.id)) return FrameKind::kSetpoints;
    const std::uint32_t function = frame.id & 0x780u;
    if (function == canopen::kEmergency) return FrameKind::kEmergency;
    if (function == canopen::kHeartbeat) return FrameKind::kHeartbeat;
    if (function == canopen::kSdoResponse || function == canopen::kSdoRequest) {
      return FrameKind::kSdo;
    }
    if (function < canopen::kTpdo1 || function > canopen::kSdoResponse) return FrameKind::kAny;
    return (function - canopen::kTpdo1) % 0x100u == 0 ? FrameKind::kAnswers : FrameKind::kSetpoints;
  }

  /// Whether these setpoints are for that node.
  [[nodiscard]] bool is_for(const CanFrame& frame, std::uint8_t node) const {
    const auto taken = taken_.find(frame.id);
    return taken == taken_.end() ? (frame.id & 0x7Fu) == node : taken->second.contains(node);
  }

  /// Takes note of a frame that has passed.
  void overhear(const CanFrame& frame) {
    if (overhear_motor(frame)) return;
    const auto byte = [&frame](std::size_t i) { return std::uint32_t{frame.data[i]}; };
    const std::uint32_t index = byte(2) << 8 | byte(1);
    const bool download = (byte(0) & 0xE3u) == 0x23u;  // expedited, with its size
    const bool sends =
        index >= canopen::kTpdoCommunication && index < canopen::kTpdoCommunication + 0x200u;
    const bool receives =
        index >= canopen::kRpdoCommunication && index < canopen::kRpdoCommunication + 0x200u;
    if (frame.extended || frame.length != 8 || !download || byte(3) != 1 || !(sends || receives) ||
        (frame.id & 0x780u) != canopen::kSdoRequest) {
      return;
    }
    const std::uint32_t value = byte(7) << 24 | byte(6) << 16 | byte(5) << 8 | byte(4);
    if ((value & canopen::kPdoInvalid) != 0) return;
    const auto node = static_cast<std::uint8_t>(frame.id & 0x7Fu);
    if (sends) {
      given_[value & 0x7FFu] = node;
    } else {
      taken_[value & 0x7FFu].insert(node);
    }
  }

 private:
  /// Of a motor in MIT mode: that it is asked for the identifier of its answers, and what it says.
  bool overhear_motor(const CanFrame& frame) {
    const bool asked = frame.data[1] == 0 && frame.data[2] == mit::kReadRegister &&
                       frame.data[3] == mit::kMasterId;
    if (frame.extended || frame.length != 8 || !asked) return false;
    const std::uint8_t number = frame.data[0];
    if (frame.id == mit::kRegisterId) {
      taken_[number].insert(number);
    } else if (frame.id == (std::uint32_t{frame.data[5]} << 8U | frame.data[4])) {
      given_[frame.id] = number;
    } else {
      return false;
    }
    return true;
  }

  std::uint8_t master_node_;
  std::map<std::uint32_t, std::uint8_t> given_;            ///< who sends that identifier
  std::map<std::uint32_t, std::set<std::uint8_t>> taken_;  ///< who listens to it
};

}  // namespace tenon::sim
