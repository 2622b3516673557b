#pragma once
// What one kind of CiA 402 drive has and lacks, as hw/drives/NAME.yaml says. Plain data: made
// without a file it is CiA 402 by the book, which is what hw/drives/cia402.yaml spells out.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shared/canopen/constants.h"

namespace tenon {

/// The objects beyond PDOs and mode that a master sets or asks for. In the order of bring-up.
enum class DriveObject : std::uint8_t {
  kSupportedModes,
  kSyncCobId,
  kSyncOverflow,
  kSyncPeriod,
  kInterpolationValue,
  kInterpolationExponent,
  kMasterWatch,
  kConnectionOption,
  kQuickStopOption,
  kShutdownOption,
  kDisableOption,
  kQuickStopDeceleration,
  kFollowingWindow,
  kFollowingTimeout,
  kTorqueMax,
  kPositionMin,
  kPositionMax,
};
inline constexpr std::size_t kDriveObjects = 17;

/// Whether the device has an object.
enum class Presence : std::uint8_t {
  kRequired,  ///< without it there is no bring-up
  kOptional,  ///< its absence is told, and no fault
  kAbsent,    ///< never asked for
};

/// What is done about its value.
enum class Treatment : std::uint8_t {
  kWrite,   ///< written, read back; must be kept
  kClamp,   ///< written; what the device makes of it is told and taken, unless it means "off"
  kCheck,   ///< never written; must be the one wanted already
  kAccept,  ///< never written; whatever it holds is told and taken
};

struct DriveObjectRow {
  DriveObject object;
  const char* key;  ///< in files and messages
  std::uint16_t index;
  std::uint8_t sub;
  std::uint8_t size_bytes;
  Presence presence;  ///< by the book, as the next
  Treatment treatment;
};

/// One row an object, in the order of the enumeration. 1006h belongs to whoever produces SYNC.
inline constexpr std::array<DriveObjectRow, kDriveObjects> kDriveObjectRows = {{
    {DriveObject::kSupportedModes, "6502h", canopen::kSupportedModes, 0, 4, Presence::kRequired,
     Treatment::kCheck},
    {DriveObject::kSyncCobId, "1005h", canopen::kSyncCobId, 0, 4, Presence::kOptional,
     Treatment::kWrite},
    {DriveObject::kSyncOverflow, "1019h", canopen::kSyncOverflow, 0, 1, Presence::kOptional,
     Treatment::kWrite},
    {DriveObject::kSyncPeriod, "1006h", canopen::kSyncPeriod, 0, 4, Presence::kOptional,
     Treatment::kWrite},
    {DriveObject::kInterpolationValue, "60C2h:1", canopen::kInterpolationPeriod, 1, 1,
     Presence::kRequired, Treatment::kWrite},
    {DriveObject::kInterpolationExponent, "60C2h:2", canopen::kInterpolationPeriod, 2, 1,
     Presence::kRequired, Treatment::kWrite},
    {DriveObject::kMasterWatch, "1016h:1", canopen::kHeartbeatConsumer, 1, 4, Presence::kRequired,
     Treatment::kWrite},
    {DriveObject::kConnectionOption, "6007h", canopen::kAbortConnectionOption, 0, 2,
     Presence::kRequired, Treatment::kWrite},
    {DriveObject::kQuickStopOption, "605Ah", canopen::kQuickStopOption, 0, 2, Presence::kRequired,
     Treatment::kWrite},
    {DriveObject::kShutdownOption, "605Bh", canopen::kShutdownOption, 0, 2, Presence::kRequired,
     Treatment::kWrite},
    {DriveObject::kDisableOption, "605Ch", canopen::kDisableOption, 0, 2, Presence::kRequired,
     Treatment::kWrite},
    {DriveObject::kQuickStopDeceleration, "6085h", canopen::kQuickStopDeceleration, 0, 4,
     Presence::kRequired, Treatment::kWrite},
    {DriveObject::kFollowingWindow, "6065h", canopen::kFollowingWindow, 0, 4, Presence::kRequired,
     Treatment::kClamp},
    {DriveObject::kFollowingTimeout, "6066h", canopen::kFollowingTimeout, 0, 2, Presence::kRequired,
     Treatment::kWrite},
    {DriveObject::kTorqueMax, "6072h", canopen::kTorqueMax, 0, 2, Presence::kOptional,
     Treatment::kClamp},
    {DriveObject::kPositionMin, "607Dh:1", canopen::kPositionLimits, 1, 4, Presence::kOptional,
     Treatment::kClamp},
    {DriveObject::kPositionMax, "607Dh:2", canopen::kPositionLimits, 2, 4, Presence::kOptional,
     Treatment::kClamp},
}};

[[nodiscard]] constexpr const DriveObjectRow& row_of(DriveObject object) {
  return kDriveObjectRows[static_cast<std::size_t>(object)];
}

struct DriveProfile {
  struct Object {
    Presence presence = Presence::kRequired;
    Treatment treatment = Treatment::kWrite;
    friend bool operator==(const Object&, const Object&) = default;
  };
  /// An object of the device's own.
  struct Extra {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint8_t size_bytes = 4;
    std::uint32_t value = 0;  ///< its low bytes; two's complement where it is signed
    Object how;
    friend bool operator==(const Extra&, const Extra&) = default;
  };
  struct CodeRange {
    std::uint16_t first = 0;
    std::uint16_t last = 0;
    friend bool operator==(const CodeRange&, const CodeRange&) = default;
  };

  static constexpr double kBootMax_s = 2.0;
  static constexpr std::array<Object, kDriveObjects> by_the_book() {
    std::array<Object, kDriveObjects> objects{};
    for (const DriveObjectRow& row : kDriveObjectRows) {
      objects[static_cast<std::size_t>(row.object)] = {row.presence, row.treatment};
    }
    return objects;
  }

  [[nodiscard]] const Object& object(DriveObject object) const {
    return objects[static_cast<std::size_t>(object)];
  }
  /// Whether an emergency with this code alone ends nothing: a drive that really stops for it shows
  /// that in its statusword.
  [[nodiscard]] bool warns(std::uint16_t code) const {
    for (const CodeRange& range : warnings) {
      if (code >= range.first && code <= range.last) return true;
    }
    return false;
  }

  friend bool operator==(const DriveProfile&, const DriveProfile&) = default;

  std::string name = "cia402";
  std::array<Object, kDriveObjects> objects = by_the_book();
  std::vector<Extra> extra;
  bool fixed_mapping = false;      ///< of PDOs: it must be the one wanted
  bool fixed_identifiers = false;  ///< PDOs keep the predefined ones
  bool fixed_transmission_types = false;
  std::vector<std::uint8_t> modes = {7, 8};  ///< that the drive has been found to follow
  double boot_s = 1.0;                       ///< longest, from NMT reset to boot-up
  std::vector<CodeRange> warnings = {{0x4210, 0x4210}, {0x4310, 0x4310}, {0xFF00, 0xFFFF}};
};

}  // namespace tenon
