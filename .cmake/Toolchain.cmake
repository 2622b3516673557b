# How every file of Tenon is compiled.
#
# Release is -O2 (INNERMOST libraries -O3) with line numbers, and keeps assertions: an executor
# whose invariant is broken must stop (the drives then stop by themselves on the lost heartbeat),
# not carry on. So what is tested is what ships. Dev adds the standard library's own checks.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

set(CMAKE_CXX_FLAGS_RELEASE "-O2 -g1")
set(CMAKE_CXX_FLAGS_DEV "-O2 -g1 -D_GLIBCXX_ASSERTIONS")
set(CMAKE_CXX_FLAGS_SANITIZE "-O1 -g1 -D_GLIBCXX_ASSERTIONS -fno-omit-frame-pointer")
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Dev or Sanitize" FORCE)
endif()

# Contracting a*b+c into one rounding would make a result depend on the machine that compiled it.
add_compile_options(-ffp-contract=off)
# -Wformat=2: a pattern that is not written out where it is used cannot be checked, and is refused.
add_compile_options(-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wswitch-enum -Wformat=2)
if(TENON_WERROR)
  add_compile_options(-Werror)
endif()

if(TENON_SANITIZERS)
  add_compile_options(-fsanitize=${TENON_SANITIZERS} -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${TENON_SANITIZERS})
  # GCC's checks of every pointer double the time of compiling. What they find, AddressSanitizer sees when
  # the pointer is used; the fuzzers (clang) keep both checks, for what reads bytes from outside.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND TENON_SANITIZERS MATCHES "undefined")
    add_compile_options(-fno-sanitize=null,alignment)
  endif()
  # Instrumented code makes GCC take an empty std::optional for an uninitialised value; the builds
  # without sanitizers keep this warning.
  add_compile_options(-Wno-maybe-uninitialized)
endif()

# Several files of a target compiled as one take a quarter of the time, and a header that all read is read less
# often. Linters and editors want a command for each file: the preset lint says them and builds nothing.
option(TENON_UNITY "Compile several files of a target as one" ON)
set(CMAKE_UNITY_BUILD ${TENON_UNITY})
if(TENON_UNITY)
  # A local name may then be one that another of the files has at namespace scope.
  add_compile_options(-Wno-shadow)
endif()

# ccache, where there is one: .ci/setup.sh installs it before the first configure. Paths below the
# repository are relative to it and debug information has none of its own, so that what one clone has
# compiled serves every other; the sloppiness is what precompiled headers need. env(1) is there because
# settings on ccache's own command line came after Debian 12's version.
find_program(CCACHE ccache)
mark_as_advanced(CCACHE)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
