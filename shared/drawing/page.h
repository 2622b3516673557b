#pragma once
// Pages with the scripts and styles of page/: those that move, around one block of data, and those
// that stand still. Pure; any thread.

#include <string>

namespace tenon::drawing {

/// All but the JSON is HTML already.
struct LivePage {
  std::string title;    ///< of the window
  std::string heading;  ///< HTML of the page's head: what it is about, and the verdict
  std::string body;     ///< HTML; the scripts fill what has a data-part, see page/README.md
  std::string json;     ///< the page's data, see page/README.md
  bool asks_its_server = false;  ///< its scripts may ask who served it, and nobody else
};

/// One document that loads nothing else: its security policy forbids it to.
[[nodiscard]] std::string live_document(const LivePage& page);

/// The same without data and scripts: words, tables and pictures that stand still.
struct StillPage {
  std::string title;
  std::string heading;
  std::string body;
};
[[nodiscard]] std::string still_document(const StillPage& page);

}  // namespace tenon::drawing
