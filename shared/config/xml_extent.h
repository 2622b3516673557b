#pragma once
// How deep an XML text's elements lie in each other and how long their tags are, told without
// recursion: its parser descends by it, which a stack bounds, and looks for each attribute among
// all others of its tag. Offline.

#include <cstddef>
#include <string_view>

namespace tenon::config {

struct XmlExtent {
  std::size_t depth = 0;
  std::size_t tag_bytes = 0;  ///< the longest tag that begins an element
};

/// Never less than what the parser would meet; the text need not be XML.
[[nodiscard]] XmlExtent xml_extent(std::string_view text);

}  // namespace tenon::config
