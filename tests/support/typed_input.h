#pragma once
// The standard input of a child process, which a test writes to and ends.

#include <string>
#include <vector>

namespace tenon::tests {

/// Must outlive the child only as far as its input is not to end.
class TypedInput {
 public:
  /// @param pipe a name that is still free; the pipe is made there
  explicit TypedInput(std::string pipe);
  TypedInput(const TypedInput&) = delete;
  TypedInput& operator=(const TypedInput&) = delete;
  ~TypedInput() { hang_up(); }

  /// The command that runs `program` with this as its standard input.
  [[nodiscard]] std::vector<std::string> read_by(const std::string& program,
                                                 const std::vector<std::string>& arguments) const;
  void type(const std::string& words) const;
  /// Standard input ends.
  void hang_up();

 private:
  std::string pipe_;
  int descriptor_ = -1;
};

}  // namespace tenon::tests
