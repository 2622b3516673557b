#pragma once
// A virtual device in the likeness of a real one: its dictionary as the description file of that
// device has it.

#include <cstdint>

#include "shared/eds/device_file.h"
#include "sim/cell/canopen/object_dictionary.h"

namespace tenon::sim {

/// Objects that the file lacks leave the bus, but for those that CiA 301 and CiA 402 make mandatory
/// (1000h, 1001h, 1018h:0 and 1, 6040h, 6041h); PDOs among them are switched off. The others get
/// the file's type, access, limits, default and right to be mapped. What only the file has is
/// stored and given back, and does nothing; the maker's own objects (2000h to 5FFFh) are always
/// such. Values that the device measures stay its own. Before power-on.
/// @param node what $NODEID stands for
void make_twin(ObjectDictionary& dictionary, const DeviceFile& file, std::uint8_t node);

}  // namespace tenon::sim
