#include "tests/support/typed_input.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <utility>

namespace tenon::tests {

TypedInput::TypedInput(std::string pipe) : pipe_(std::move(pipe)) {
  EXPECT_EQ(::mkfifo(pipe_.c_str(), 0600), 0) << pipe_;
  // For both ways, so that opening waits for nobody.
  descriptor_ = ::open(pipe_.c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_GE(descriptor_, 0) << pipe_;
}

std::vector<std::string> TypedInput::read_by(const std::string& program,
                                             const std::vector<std::string>& arguments) const {
  std::vector<std::string> command{"sh", "-c", R"(exec "$0" "$@" <")" + pipe_ + '"', program};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

void TypedInput::type(const std::string& words) const {
  EXPECT_EQ(::write(descriptor_, words.data(), words.size()), static_cast<ssize_t>(words.size()));
}

void TypedInput::hang_up() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace tenon::tests
