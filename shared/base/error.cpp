#include "shared/base/error.h"

#include "shared/base/printable.h"

namespace tenon {
namespace {

// Longer than any message of ours with a file's whole path in it.
constexpr std::size_t kMessageMax = 2000;

}  // namespace

InputError::InputError(const std::string& message)
    : std::runtime_error(shortened(printable(message), kMessageMax)) {}

}  // namespace tenon
