#pragma once
// Whether a device takes an entry of a PDO's mapping, by its description file (CiA 301, 7.5.2.36
// and 7.5.2.38; access and dummies: CiA 306-1). Pure.

#include <cstdint>
#include <string>

#include "shared/eds/device_file.h"

namespace tenon::hw {

/// What a device says to 607A0020h at 1600h:2, say.
struct MappingAnswer {
  enum class Kind : std::uint8_t { kTaken, kUnknown, kRefused };
  Kind kind = Kind::kTaken;
  std::string why;  ///< with the abort code that is to be expected; empty where it is taken
};

/// @param index of the mapping  @param entry index, sub-index and bits, as CiA 301 packs them; 0:
/// none
[[nodiscard]] MappingAnswer answer_to_mapping(const DeviceFile& file, std::uint16_t index,
                                              std::uint32_t entry);

}  // namespace tenon::hw
