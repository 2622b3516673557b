#pragma once
// Which node sends a frame, as a bus analyser would know it: by the predefined identifiers of CiA
// 301 (7.3.5), corrected by what it has overheard of a master that gives process data other
// identifiers (SDO downloads of 18xxh:1). One thread.

#include <cstdint>
#include <map>

#include "shared/canopen/constants.h"
#include "shared/ports/can_bus.h"

namespace tenon::sim {

class FrameSender {
 public:
  /// @param master_node taken as the sender of what no device sends: NMT, SYNC, RPDOs, requests
  explicit FrameSender(std::uint8_t master_node) : master_node_(master_node) {}

  [[nodiscard]] std::uint8_t node_of(const CanFrame& frame) const {
    if (frame.extended) return 0;
    const auto given = given_.find(frame.id);
    if (given != given_.end()) return given->second;
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

  /// Takes note of a frame that has passed.
  void overhear(const CanFrame& frame) {
    const auto byte = [&frame](std::size_t i) { return std::uint32_t{frame.data[i]}; };
    const std::uint32_t index = byte(2) << 8 | byte(1);
    const bool download = (byte(0) & 0xE3u) == 0x23u;  // expedited, with its size
    const bool pdo_identifier = index >= canopen::kTpdoCommunication &&
                                index < canopen::kTpdoCommunication + 0x200u && byte(3) == 1;
    if (frame.extended || frame.length != 8 || !download || !pdo_identifier ||
        (frame.id & 0x780u) != canopen::kSdoRequest) {
      return;
    }
    const std::uint32_t value = byte(7) << 24 | byte(6) << 16 | byte(5) << 8 | byte(4);
    if ((value & canopen::kPdoInvalid) == 0) {
      given_[value & 0x7FFu] = static_cast<std::uint8_t>(frame.id & 0x7Fu);
    }
  }

 private:
  std::uint8_t master_node_;
  std::map<std::uint32_t, std::uint8_t> given_;
};

}  // namespace tenon::sim
