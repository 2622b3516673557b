#pragma once
// The example parts, both meshes: a peg with a key along it above the mouth of its socket.

#include <memory>
#include <string>

#include "shared/geometry/solid.h"
#include "shared/task/task.h"
#include "tests/support/example_parts.h"

namespace tenon::sim {

inline Task keyed_peg() {
  const auto shape = [](const char* name, const std::string& file) {
    const auto solid = std::make_shared<const Solid>(tests::example_parts().at(file));
    return Shape{name,
                 Shape::Kind::kSolid,
                 solid->size_m(),
                 {solid->centre_m(), Eigen::Quaterniond::Identity()},
                 solid};
  };
  Task task;
  task.held = {shape("peg", "keyed_peg.stl")};
  task.environment = {shape("socket", "keyed_socket.stl")};
  return task;
}

}  // namespace tenon::sim
