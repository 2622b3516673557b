#!/usr/bin/env python3
"""Holds every header that the compiler really read, directly or not, against the design.

The include roots keep Tenon's folders apart; this covers the libraries that lie in /usr/include, where
a look at the include lines would miss an indirect one.

  used_headers.py BUILD
"""
import sys

from build_tree import FOLDERS, BuildTree

# (what, part of a header's path, targets that may use it)
RULES = [
    ("ODE", "/usr/include/ode/", {"sim_physics", "sim_cell"}),
    ("LCM", "/usr/include/lcm/", {"executor_telemetry", "executor_monitor", "executor_recorded", "executor_export",
                                  "tenon-monitor", "sim_listener"}),
    ("ncurses", "/usr/include/curses.h", {"tenon-monitor"}),
    ("libmicrohttpd", "/usr/include/microhttpd.h", {"sim_view"}),
    ("yaml-cpp", "/usr/include/yaml-cpp/", {"shared_config"}),
    ("CLI11", "/usr/include/CLI/", {"shared_config"}),
    ("nlohmann-json", "/usr/include/nlohmann/",
     {"shared_config", "planner_report", "executor_dry_run", "executor_recorded", "executor_export", "executor_telemetry",
      "sim_cell", "sim_evaluation", "sim_view"}),
]


def main():
    failures = 0
    objects = 0
    seen = {rule[0]: 0 for rule in RULES}
    for target, name, files in BuildTree(sys.argv[1]).dependencies():
        if target.split("_")[0] not in FOLDERS and not target.startswith("tenon-"):
            continue
        objects += 1
        for what, part, allowed in RULES:
            if not any(part in file for file in files):
                continue
            seen[what] += 1
            is_main = target.startswith("tenon-")
            fine = target in allowed or (is_main and what in ("CLI11", "nlohmann-json"))
            if not fine:
                failures += 1
                print(f"FAILED: {name} reads headers of {what}")
    print(f"{objects} object files; used by: "
          + ", ".join(f"{what} {count}" for what, count in seen.items()))
    return 1 if failures or not objects or not seen["ODE"] else 0


if __name__ == "__main__":
    sys.exit(main())
