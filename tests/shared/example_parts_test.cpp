// The parts that ship are closed bodies, and those that their generator makes.

#include "tests/support/example_parts.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "shared/geometry/mesh_check.h"
#include "tests/support/meshes.h"
#include "tests/support/places.h"

namespace tenon {
namespace {

// TENON_WRITE_PARTS=1 writes them anew.
TEST(ExampleParts, AreWhatTheirGeneratorMakes) {
  for (const auto& [name, mesh] : tests::example_parts()) {
    EXPECT_NO_THROW(check_mesh(mesh)) << name;
    const std::string file = tests::in_tree("planner/tasks/parts/" + name);
    const std::string bytes = tests::binary_stl(mesh, 1e-3);
    if (std::getenv("TENON_WRITE_PARTS") != nullptr) std::ofstream(file, std::ios::binary) << bytes;
    std::ostringstream there;
    there << std::ifstream(file, std::ios::binary).rdbuf();
    EXPECT_EQ(there.str(), bytes) << file;
  }
}

}  // namespace
}  // namespace tenon
