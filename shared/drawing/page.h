#pragma once
// Pages that move: the scripts and styles of page/ around one block of data. Pure; any thread.

#include <string>

namespace tenon::drawing {

/// All but the JSON is HTML already.
struct LivePage {
  std::string title;    ///< of the window
  std::string heading;  ///< HTML of the page's head: what it is about, and the verdict
  std::string body;     ///< HTML; the scripts fill what has a data-part, see page/README.md
  std::string json;     ///< the page's data, see page/README.md
};

/// One document that loads nothing: its security policy forbids it to.
[[nodiscard]] std::string live_document(const LivePage& page);

}  // namespace tenon::drawing
