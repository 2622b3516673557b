#!/usr/bin/env python3
"""Shows by their symbols that no physics engine and no planner is inside tenon-exec, and neither CANopen,
virtual cell nor evaluation inside tenon-plan, and of the executor nothing but the dry run and its kinematics.

Compares with what the libraries define: their strong symbols, so not the inline functions and
templates that everybody instantiates. What each must hold is asked for too, or it
proves nothing.

  symbols.py BUILD ODE_LIBRARY
"""
import pathlib
import subprocess
import sys

from build_tree import FOLDERS

STRONG = set("TDBRS")


def nm(*arguments):
    run = subprocess.run(["nm", *map(str, arguments)], text=True, capture_output=True, check=True)
    for line in run.stdout.splitlines():
        words = line.split()
        if len(words) >= 2 and len(words[-2]) == 1:
            yield words[-2], words[-1].split("@")[0]


def defined(*arguments):
    return {name for kind, name in nm("--defined-only", *arguments) if kind in STRONG}


def contained(executable):
    """Every symbol that an executable defines or asks a shared library for."""
    return {name for _, name in nm(executable)}


def main():
    build = pathlib.Path(sys.argv[1])
    ode = defined("--dynamic", sys.argv[2])
    libraries = {"ODE": {name for name in ode if name.startswith("d") or name.startswith("_Z")}}
    for room in sorted(path for folder in FOLDERS for path in (build / folder).glob("lib*.a")):
        libraries[room.stem.removeprefix("lib")] = defined(room)
    planner = [name for name in libraries if name.startswith("planner")]
    reach = ["executor_dry_run", "executor_motion"]
    executor = [name for name in libraries if name.startswith("executor") and name not in reach]
    sim = [name for name in libraries if name.startswith("sim")]
    hw = [name for name in libraries if name.startswith("hw")]
    cell_and_evaluation = [name for name in sim if name != "sim_physics"]
    # A static variable of the same name may stand in two libraries; main is in none.
    failures = 0
    for program, forbidden, expected in (
            ("tenon-exec", ["ODE", *planner, *sim], ["executor_loop"]),
            ("tenon-plan", [*executor, *cell_and_evaluation, *hw], ["ODE", "planner", "sim_physics", *reach])):
        symbols = contained(build / "bin" / program)
        for name in forbidden + expected:
            common = symbols & libraries[name]
            wrong = bool(common) != (name in expected)
            failures += wrong
            print(f"{'FAILED: ' if wrong else ''}{program} holds {len(common)} of the "
                  f"{len(libraries[name])} symbols of {name}")
            if wrong and common:
                print("  " + "\n  ".join(sorted(common)[:10]))
    needed = subprocess.run(["readelf", "--dynamic", str(build / "bin/tenon-exec")], text=True,
                            capture_output=True, check=True).stdout
    if "libode" in needed:
        failures += 1
        print("FAILED: tenon-exec loads libode")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
