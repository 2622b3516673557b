#pragma once
// What stands in page/, as the build embeds it. Pure; any thread.

#include <string_view>

namespace tenon::drawing {

[[nodiscard]] std::string_view page_style();      ///< CSS
[[nodiscard]] std::string_view page_libraries();  ///< the bundle of page/bundle/
[[nodiscard]] std::string_view page_script();     ///< Tenon's own scripts, one after the other

}  // namespace tenon::drawing
