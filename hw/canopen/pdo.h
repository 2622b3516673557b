#pragma once
// PDO parameters as the list of settings that configures them in the order that CiA 301 (7.5.2.36)
// asks for: COB-ID with bit 31, transmission type, sub 0 = 0, entries, sub 0 = n, COB-ID without
// bit 31. The mapping is looked at before, and left alone where it is the one wanted: many a drive
// has a fixed one. Set-up code, allocates.
//
//   1400h + k, 1800h + k   sub 1: u32 COB-ID, bit 31 invalid, bit 30 no RTR; sub 2: u8 type
//   1600h + k, 1A00h + k   sub 0: u8 entries; sub 1..: u32 index << 16 | sub << 8 | bits

#include <cstdint>
#include <vector>

#include "hw/canopen/object_setting.h"

namespace tenon::hw::canopen {

inline constexpr std::uint8_t kEverySync = 1;  ///< transmission type
inline constexpr std::uint8_t kAtOnce = 255;   ///< acts when it arrives
inline constexpr std::uint16_t kDummyI32 = 4;  ///< maps to nothing: skips four bytes of an RPDO

struct PdoEntry {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint8_t bits = 0;
};

struct PdoConfiguration {
  enum class Direction : std::uint8_t { kReceive, kTransmit };  ///< as the node sees it
  Direction direction = Direction::kReceive;
  std::uint8_t number = 1;  ///< 1..4
  std::uint32_t cob_id = 0;
  std::uint8_t transmission_type = kEverySync;
  std::vector<PdoEntry> entries;
};

/// What of a PDO can be changed. Where it cannot, mapping and identifier are compared alone, and
/// so is the type of what the node sends; that of what it receives is left to the node.
struct PdoFreedom {
  bool mapping = true;
  bool identifier = true;
  bool transmission_type = true;
};

void append_pdo(std::vector<ObjectSetting>& settings, const PdoConfiguration& pdo,
                const PdoFreedom& freedom = {});

/// Of one that a node can do without: left switched off where the node refuses any of it.
void append_optional_pdo(std::vector<ObjectSetting>& settings, const PdoConfiguration& pdo);

/// Switches a PDO off that nobody asked for, where the node has it.
void append_unused_pdo(std::vector<ObjectSetting>& settings, PdoConfiguration::Direction direction,
                       std::uint8_t node, std::uint8_t number);

}  // namespace tenon::hw::canopen
