# Writes the C++ source that holds the page's files: cmake -D OUT=FILE -D FOLDER=. -D SCRIPTS=a.js;b.js -P embed.cmake
set(script "")
foreach(name IN LISTS SCRIPTS)
  file(READ "${FOLDER}/${name}" text)
  string(APPEND script "${text}")
endforeach()
file(READ "${FOLDER}/page.css" style)
file(READ "${FOLDER}/bundle/libraries.css" libraries_style)
file(READ "${FOLDER}/bundle/libraries.min.js" libraries)

# A raw string in one piece per file: no compiler that Tenon builds with has a limit for it.
foreach(text IN ITEMS script style libraries_style libraries)
  string(FIND "${${text}}" ")tenon\"" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${text} holds what ends the raw string")
  endif()
endforeach()
file(WRITE "${OUT}" "// Made by shared/drawing/page/embed.cmake.
#include \"shared/drawing/page_assets.h\"
namespace tenon::drawing {
std::string_view page_style() { return R\"tenon(${libraries_style}${style})tenon\"; }
std::string_view page_libraries() { return R\"tenon(${libraries})tenon\"; }
std::string_view page_script() { return R\"tenon(${script})tenon\"; }
}  // namespace tenon::drawing
")
