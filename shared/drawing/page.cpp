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

std::string head(const std::string& title, const char* scripts) {
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>\n"
      "<meta name='viewport' content='width=device-width,initial-scale=1'>\n"
      "<meta name='color-scheme' content='light dark'>\n"
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; ";
  html.append(scripts).append("img-src data:\">\n<title>").append(title);
  html += "</title>\n<style>";
  html += page_style();
  return html + "</style></head>\n<body>\n";
}

std::string content(const std::string& heading, const std::string& body) {
  return "<header>" + heading + "</header>\n<main>\n" + body + "</main>\n";
}

}  // namespace

std::string live_document(const LivePage& page) {
  std::string html = head(page.title, "script-src 'unsafe-inline'; ") +
                     content(page.heading, page.body) +
                     "<script type='application/json' id='page-data'>" + inside_script(page.json) +
                     "</script>\n<script>";
  html += page_libraries();
  html += "</script>\n<script>";
  html += page_script();
  return html + "</script>\n</body></html>\n";
}

std::string still_document(const StillPage& page) {
  return head(page.title, "") + content(page.heading, page.body) + "</body></html>\n";
}

}  // namespace tenon::drawing
