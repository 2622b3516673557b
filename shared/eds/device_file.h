#pragma once
// What a device's electronic data sheet (EDS) or device configuration file (DCF) says of its object
// dictionary (CiA 306-1). Files of vendors have slips: those that leave no doubt are read and
// listed, the others are refused by file and line. Set-up code, allocates, pure; it opens no file.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tenon {

/// index << 8 | sub-index.
using DeviceObjectId = std::uint32_t;

/// Codes of basic data types (CiA 301, 7.4.7.1) that have a number of bits.
[[nodiscard]] constexpr unsigned data_type_bits(std::uint16_t type) {
  if (type == 0x0001) return 1;
  if (type == 0x0002 || type == 0x0005) return 8;
  if (type == 0x0003 || type == 0x0006) return 16;
  if (type == 0x0010 || type == 0x0016) return 24;
  if (type == 0x0004 || type == 0x0007 || type == 0x0008) return 32;
  if (type == 0x0011 || type == 0x0015 || type == 0x001B) return 64;
  return 0;
}

/// INTEGER8, 16, 24, 32, 64.
[[nodiscard]] constexpr bool is_signed_type(std::uint16_t type) {
  return (type >= 0x0002 && type <= 0x0004) || type == 0x0010 || type == 0x0015;
}

/// BOOLEAN, INTEGERn, UNSIGNEDn.
[[nodiscard]] constexpr bool is_integer_type(std::uint16_t type) {
  return data_type_bits(type) != 0 && type != 0x0008 && type != 0x0011;
}

struct DeviceObject {
  /// Of what can be read and written, some is process data of one direction alone: rwr is carried
  /// by TPDOs, rww by RPDOs.
  enum class Access : std::uint8_t {
    kReadOnly,
    kWriteOnly,
    kReadWrite,
    kReadWriteInput,   ///< rwr
    kReadWriteOutput,  ///< rww
    kConstant
  };
  std::string name{};
  std::uint16_t type = 0;  ///< code of CiA 301; 0Fh: DOMAIN
  Access access = Access::kReadWrite;
  bool mappable = false;
  // Of integers. Unset: the file says nothing.
  std::optional<std::int64_t> low{};
  std::optional<std::int64_t> high{};
  std::optional<std::int64_t> value{};  ///< ParameterValue of a DCF, else DefaultValue
  bool adds_node = false;               ///< $NODEID stands in it, and is to be added
  std::string text{};                   ///< the value of everything else, as it stands
  int line = 0;                         ///< of its section

  /// Whether a PDO that the device receives may set it.
  [[nodiscard]] bool goes_into_rpdo() const {
    return mappable && (access == Access::kWriteOnly || access == Access::kReadWrite ||
                        access == Access::kReadWriteOutput);
  }
  /// Whether a PDO that the device sends may tell it.
  [[nodiscard]] bool goes_into_tpdo() const {
    return mappable && access != Access::kWriteOnly && access != Access::kReadWriteOutput;
  }
};

struct DeviceFile {
  std::string name;  ///< of the file
  std::string vendor;
  std::string product;
  std::optional<std::uint8_t> node;  ///< of a DCF
  std::map<DeviceObjectId, DeviceObject> objects;
  /// Bit i: an RPDO may have a gap of data type i (0001h to 0007h). Unset: the file does not say.
  std::optional<std::uint8_t> dummies;
  std::vector<std::string> slips;  ///< "FILE:LINE: what was wrong, and how it was read"

  [[nodiscard]] const DeviceObject* find(std::uint16_t index, std::uint8_t sub) const {
    const auto found = objects.find(static_cast<DeviceObjectId>(index) << 8 | sub);
    return found == objects.end() ? nullptr : &found->second;
  }
  [[nodiscard]] bool has_index(std::uint16_t index) const {
    const auto next = objects.lower_bound(static_cast<DeviceObjectId>(index) << 8);
    return next != objects.end() && next->first >> 8 == index;
  }
};

/// @param name of the file, for messages. Throws InputError with one line.
[[nodiscard]] DeviceFile parse_device_file(const std::string& name, const std::string& text);

}  // namespace tenon
