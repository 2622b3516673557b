#include "tests/support/bad_input.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/commands.h"
#include "tests/support/places.h"

namespace tenon::tests {

void expect_refused(const ScratchFolder& folder, const BadInput& bad) {
  SCOPED_TRACE(::testing::PrintToString(bad.command));
  const Ended ended = run(folder, bad.command);
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_TRUE(ended.err.ends_with('\n'));
  const std::string program = bad.command[0].substr(bad.command[0].rfind('/') + 1);
  EXPECT_EQ(ended.err.rfind(program + ": ", 0), 0U) << ended.err;
  for (const std::string& name : bad.named) {
    EXPECT_NE(ended.err.find(name), std::string::npos) << "no '" << name << "' in: " << ended.err;
  }
}

std::string edited(const ScratchFolder& folder, const std::string& name, const std::string& source,
                   const std::string& piece, const std::string& instead) {
  std::ostringstream all;
  all << std::ifstream(source).rdbuf();
  std::string text = all.str();
  const std::size_t at = text.find(piece);
  if (at == std::string::npos) throw std::runtime_error(source + " holds no " + piece);
  text.replace(at, piece.size(), instead);
  return folder.put(name, text);
}

std::string cell_around(const ScratchFolder& folder, const std::string& name,
                        const std::string& robot_file) {
  (void)edited(folder, "gantry3.urdf", in_tree("hw/robots/gantry3/gantry3.urdf"), "", "");
  return edited(folder, name, gantry_cell_file(), "../robots/gantry3/robot.yaml", robot_file);
}

std::string robot_file() { return in_tree("hw/robots/gantry3/robot.yaml"); }

}  // namespace tenon::tests
