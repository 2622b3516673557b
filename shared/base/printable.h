#pragma once
// Text that came from outside, fit for one line of a message. Allocates; not for real time.

#include <cstddef>
#include <string>
#include <string_view>

namespace tenon {

/// Control characters, separators of lines, marks of writing direction and what is not UTF-8 as \n,
/// \t, \xHH: a terminal obeys none of it, and a line stays one.
[[nodiscard]] std::string printable(std::string_view text);

/// At most about so many bytes, the middle left out: "1111... (99980 bytes) ...1111".
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most);

}  // namespace tenon
