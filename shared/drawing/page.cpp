#include "shared/drawing/page.h"

#include <string>
#include <string_view>

#include "shared/drawing/page_assets.h"

namespace tenon::drawing {
namespace {

/// JSON that cannot end the script element that it stands in.
std::string inside_script(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

std::string live_document(const LivePage& page) {
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>\n"
      "<meta name='viewport' content='width=device-width,initial-scale=1'>\n"
      "<meta name='color-scheme' content='light dark'>\n"
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:\">\n"
      "<title>" +
      page.title + "</title>\n<style>";
  html += page_style();
  html += "</style></head>\n<body>\n<header>" + page.heading + "</header>\n<main>\n" + page.body +
          "</main>\n<script type='application/json' id='page-data'>" + inside_script(page.json) +
          "</script>\n<script>";
  html += page_libraries();
  html += "</script>\n<script>";
  html += page_script();
  return html + "</script>\n</body></html>\n";
}

}  // namespace tenon::drawing
