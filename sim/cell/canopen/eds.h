#pragma once
// The electronic data sheet of a device (CiA 306, version 4.0), written from its object dictionary.

#include <string>

#include "sim/cell/canopen/object_dictionary.h"

namespace tenon::sim {

struct EdsInfo {
  std::string file_name;
  std::string product_name;
  std::uint8_t node = 1;  ///< what $NODEID stands for in the dictionary's defaults
};

/// Every object with name, type, rights, default, limits and whether a PDO may carry it. Lines end
/// with CR LF. It has no dates: the same device gives the same bytes.
[[nodiscard]] std::string eds_text(const ObjectDictionary& dictionary, const EdsInfo& info);

}  // namespace tenon::sim
