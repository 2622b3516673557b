#pragma once
// What a fuzz target says where a property does not hold: one line, then abort, which libFuzzer and
// ctest both take for a crash. Unlike assert() it needs no build type.

#include <cstdio>
#include <cstdlib>

namespace tenon::fuzz {

inline void must(bool holds, const char* property) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", property);
  std::abort();
}

}  // namespace tenon::fuzz
