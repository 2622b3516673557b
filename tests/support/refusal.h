#pragma once
// What bad input is refused with.

#include <string>

#include "shared/base/error.h"

namespace tenon::tests {

/// The line with which the work is refused, or "accepted".
template <typename Work>
[[nodiscard]] std::string refusal(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace tenon::tests
