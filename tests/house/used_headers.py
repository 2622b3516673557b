#!/usr/bin/env python3
"""Holds every header that the compiler really read, directly or not, against the design.

The include roots keep Tenon's folders apart; this covers the libraries that lie in /usr/include, where
a look at the include lines would miss an indirect one.

  used_headers.py BUILD
"""
import sys

from build_tree import BuildTree

LIBRARIES = ("shared", "shared_config", "planner", "executor", "hw", "sim")

# (what, part of a header's path, targets that may use it, restriction to object files)
RULES = [
    ("ODE", "/usr/include/ode/", {"sim"}, None),
    ("LCM", "/usr/include/lcm/", {"executor", "tenon-monitor"}, "telemetry"),
    ("yaml-cpp", "/usr/include/yaml-cpp/", {"shared_config"}, None),
    ("CLI11", "/usr/include/CLI/", set(), None),
    ("nlohmann-json", "/usr/include/nlohmann/", set(LIBRARIES) - {"shared"}, None),
]


def main():
    failures = 0
    objects = 0
    seen = {rule[0]: 0 for rule in RULES}
    for target, name, files in BuildTree(sys.argv[1]).dependencies():
        if target not in LIBRARIES and not target.startswith("tenon-"):
            continue
        objects += 1
        for what, part, allowed, restriction in RULES:
            if not any(part in file for file in files):
                continue
            seen[what] += 1
            is_main = target.startswith("tenon-")
            fine = target in allowed or (is_main and what in ("CLI11", "nlohmann-json"))
            if fine and restriction and not is_main:
                fine = restriction in name
            if not fine:
                failures += 1
                print(f"FAILED: {name} reads headers of {what}")
    print(f"{objects} object files; used by: "
          + ", ".join(f"{what} {count}" for what, count in seen.items()))
    return 1 if failures or not objects or not seen["ODE"] else 0


if __name__ == "__main__":
    sys.exit(main())
