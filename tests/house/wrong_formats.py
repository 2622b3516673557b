#!/usr/bin/env python3
"""Shows that a message whose values do not fit its pattern does not compile.

  wrong_formats.py BUILD
"""
import sys

from build_tree import BuildTree

PROLOGUE = """#include <cstdint>
#include <string>
#include "shared/base/text.h"
std::string text(double x, int i, std::size_t n, std::int64_t t, const std::string& s, const char* pattern) {
  static_cast<void>(x), static_cast<void>(i), static_cast<void>(n), static_cast<void>(t), static_cast<void>(s);
  static_cast<void>(pattern);
  return tenon::format(ARGUMENTS);
}
"""

RIGHT = ('"plain"', '"%g mm in %d of %zu, %s", x, i, n, s.c_str()', '"%*d", i, i', '"%.*f", i, x',
         'i > 0 ? "%g mm" : "%.2f deg", x', '"%lld", static_cast<long long>(t)')
WRONG = ('"%d", x', '"%g", i', '"%d", n', '"%zu", x', '"%s", i', '"%s", s', '"%g %g", x', '"%g", x, i',
         '"%g %", x', '"%f"', '"%*d", x, i', 'i > 0 ? "%g" : "%d", x', 'pattern, x', 's, x', '"%c", x')


def main():
    tree = BuildTree(sys.argv[1])
    failures = 0
    for arguments in RIGHT + WRONG:
        ok, messages = tree.compiles("shared", PROLOGUE.replace("ARGUMENTS", arguments))
        if ok != (arguments in RIGHT):
            failures += 1
            print(f"FAILED: format({arguments}) {'compiles' if ok else 'does not compile:'}\n{messages}")
    print(f"{len(WRONG)} wrong formats refused, {len(RIGHT)} right ones accepted, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
