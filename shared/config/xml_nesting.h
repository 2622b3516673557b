#pragma once
// How deep an XML text's elements lie in each other, told without recursion: its parser has none of
// a bound, and a stack has one. Offline.

#include <cstddef>
#include <string_view>

namespace tenon::config {

/// Never less than what the parser would descend to; the text need not be XML.
[[nodiscard]] std::size_t xml_nesting(std::string_view text);

}  // namespace tenon::config
