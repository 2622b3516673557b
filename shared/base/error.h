#pragma once
// Errors of set-up code and offline tools. Real-time code never throws; it returns values.

#include <stdexcept>
#include <string>

namespace tenon {

/// Input that cannot be used: a file, a key, a command line. The message is one line that names
/// what is wrong, where it stands, the bound that it breaks and what to do. A main prints it and
/// exits 2. Values and names in it may come from anywhere: bytes that a terminal would obey are
/// escaped, and a message of absurd length loses its middle.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message);
};

}  // namespace tenon
