#pragma once
// The keys of a joint whose motor runs in MIT mode. Offline.

#include <cstdint>
#include <set>

#include "shared/cell/robot.h"
#include "shared/config/yaml_value.h"

namespace tenon::config {

/// What motor and bus add to a joint of the URDF. @param nodes numbers that are taken; its own is
/// added  @throws InputError
void read_motor(const Value& value, std::set<std::int64_t>& nodes, Joint& joint);

}  // namespace tenon::config
