#include "shared/config/xml_extent.h"

#include <algorithm>

namespace tenon::config {
namespace {

/// Behind the next place where `mark` stands.
std::size_t behind(std::string_view text, std::size_t from, std::string_view mark) {
  const std::size_t at = text.find(mark, from);
  return at == std::string_view::npos ? text.size() : at + mark.size();
}

/// Where the tag that begins here ends: at its '>', which does not count within quotes.
std::size_t end_of_tag(std::string_view text, std::size_t from) {
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (quote != 0) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '>') {
      return i;
    }
  }
  return text.size();
}

bool begins_a_name(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || byte >= 127;
}

}  // namespace

XmlExtent xml_extent(std::string_view text) {
  XmlExtent most;
  std::size_t depth = 0;
  std::size_t i = 0;
  while ((i = text.find('<', i)) != std::string_view::npos) {
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("<!--")) {
      i = behind(text, i, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      i = behind(text, i, "]]>");
    } else if (rest.starts_with("</")) {
      depth -= depth > 0 ? 1 : 0;
      i = behind(text, i, ">");
    } else if (rest.size() > 1 && begins_a_name(rest[1])) {
      const std::size_t end = end_of_tag(text, i);
      most.depth = std::max(most.depth, depth + 1);
      most.tag_bytes = std::max(most.tag_bytes, end - i);
      depth += text[end - 1] == '/' ? 0 : 1;
      i = std::min(end + 1, text.size());
    } else {
      i = behind(text, i, ">");
    }
  }
  return most;
}

}  // namespace tenon::config
