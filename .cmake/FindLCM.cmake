# Lightweight Communications and Marshalling, found by its files (Debian ships no CMake config).
#
#   LCM::lcm       the library
#   LCM::headers   its headers alone, which is all that a generated message type needs
#   LCM_GEN        the message compiler
find_path(LCM_INCLUDE_DIR NAMES lcm/lcm-cpp.hpp)
find_library(LCM_LIBRARY NAMES lcm)
find_program(LCM_GEN NAMES lcm-gen)
mark_as_advanced(LCM_INCLUDE_DIR LCM_LIBRARY LCM_GEN)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LCM REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR LCM_GEN)

if(LCM_FOUND AND NOT TARGET LCM::lcm)
  add_library(LCM::headers INTERFACE IMPORTED)
  set_target_properties(LCM::headers PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")
  add_library(LCM::lcm UNKNOWN IMPORTED)
  set_target_properties(LCM::lcm PROPERTIES
    IMPORTED_LOCATION "${LCM_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")
endif()
