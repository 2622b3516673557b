# The terminal library, its wide variant, found by its files.
#
#   Ncurses::ncursesw
find_path(NCURSES_INCLUDE_DIR NAMES curses.h PATH_SUFFIXES ncursesw)
find_library(NCURSES_LIBRARY NAMES ncursesw)
# Where it was built apart.
find_library(NCURSES_TINFO_LIBRARY NAMES tinfo)
mark_as_advanced(NCURSES_INCLUDE_DIR NCURSES_LIBRARY NCURSES_TINFO_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ncurses REQUIRED_VARS NCURSES_LIBRARY NCURSES_INCLUDE_DIR)

if(Ncurses_FOUND AND NOT TARGET Ncurses::ncursesw)
  add_library(Ncurses::ncursesw UNKNOWN IMPORTED)
  set_target_properties(Ncurses::ncursesw PROPERTIES
    IMPORTED_LOCATION "${NCURSES_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${NCURSES_INCLUDE_DIR}")
  if(NCURSES_TINFO_LIBRARY)
    set_property(TARGET Ncurses::ncursesw PROPERTY INTERFACE_LINK_LIBRARIES "${NCURSES_TINFO_LIBRARY}")
  endif()
endif()
