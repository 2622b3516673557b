#pragma once
// Errors of set-up code and offline tools. Real-time code never throws; it returns values.

#include <stdexcept>
#include <string>

namespace tenon {

/// Input that cannot be used: a file, a key, a command line. The message is one line that names
/// what is wrong, where it stands, the bound that it breaks and what to do. A main prints it and
/// exits 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tenon
