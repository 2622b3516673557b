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

// A browser asks a server for an icon, too, unless it has one.
constexpr const char* kOfServedPage =
    "script-src 'unsafe-inline'; connect-src 'self'; img-src data:\">\n"
    "<link rel='icon' href='data:,'>";
constexpr const char* kOfLivePage = "script-src 'unsafe-inline'; img-src data:\">";

/// @param policy the rest of the page's policy, to the end of its element
std::string head(const std::string& title, const char* policy) {
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>\n"
      "<meta name='viewport' content='width=device-width,initial-scale=1'>\n"
      "<meta name='color-scheme' content='light dark'>\n"
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; ";
  html.append(policy).append("\n<title>").append(title);
  html += "</title>\n<style>";
  html += page_style();
  return html + "</style></head>\n<body>\n";
}

std::string content(const std::string& heading, const std::string& body) {
  return "<header>" + heading + "</header>\n<main>\n" + body + "</main>\n";
}

}  // namespace

std::string live_document(const LivePage& page) {
  std::string html = head(page.title, page.asks_its_server ? kOfServedPage : kOfLivePage) +
                     content(page.heading, page.body) +
                     "<script type='application/json' id='page-data'>" + inside_script(page.json) +
                     "</script>\n<script>";
  html += page_libraries();
  html += "</script>\n<script>";
  html += page_script();
  return html + "</script>\n</body></html>\n";
}

std::string still_document(const StillPage& page) {
  return head(page.title, "img-src data:\">") + content(page.heading, page.body) +
         "</body></html>\n";
}

}  // namespace tenon::drawing
