#pragma once
// What the objects that bring-up touches are called by CiA 301 and CiA 402, for people. Pure.

#include <cstdint>
#include <string>

namespace tenon::hw {

/// "following error window", "RPDO 2 mapping"; empty: not one of them.
[[nodiscard]] std::string object_name(std::uint16_t index);

}  // namespace tenon::hw
