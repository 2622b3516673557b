#!/usr/bin/env python3
"""Shows that an include which the table of dependencies forbids does not compile.

Each probe is compiled with the flags of the target that would hold it. One probe a target is allowed
and must compile, so that a failure means the include and not the flags.

  forbidden_includes.py BUILD
"""
import sys

from build_tree import FOLDERS, SOURCE, BuildTree

# For each target, the folders that it may include. Written down a second time on purpose: this is
# what the design says, and CMake's table is what is being checked.
MAY_INCLUDE = {
    "shared": {"shared"},
    "shared_config": {"shared", "shared/config"},
    "planner": {"shared", "planner"},
    "hw": {"shared", "hw"},
    "sim": {"shared", "sim"},
    "executor": {"shared", "executor", "lcmtypes"},
    "tenon-plan": {"shared", "shared/config", "planner", "sim"},
    "tenon-inspect": {"shared", "shared/config", "planner", "sim"},
    "tenon-exec": {"shared", "shared/config", "executor", "hw"},
    "tenon-monitor": {"shared", "shared/config", "executor", "lcmtypes"},
    "tenon-sim": {"shared", "shared/config", "sim", "hw"},
    "tenon-evaluate": {"shared", "shared/config", "sim", "executor", "hw"},
    "tenon-can": {"shared", "shared/config", "hw"},
}
SOURCE_FOLDER = {"shared_config": "shared", "tenon-plan": "planner", "tenon-inspect": "planner",
                 "tenon-exec": "executor", "tenon-monitor": "executor", "tenon-sim": "sim",
                 "tenon-evaluate": "sim", "tenon-can": "hw"}


def probes(tree):
    """One existing header of each folder, by its include path."""
    found = {}
    for folder in (*FOLDERS, "shared/config"):
        headers = sorted((SOURCE / folder).rglob("*.h"))
        if folder == "shared":
            headers = [h for h in headers if SOURCE / "shared/config" not in h.parents]
        if headers:
            found[folder] = str(headers[0].relative_to(SOURCE))
    generated = tree.path / "roots/lcmtypes"
    headers = sorted(generated.rglob("*.hpp"))
    if headers:
        found["lcmtypes"] = str(headers[0].relative_to(generated))
    return found


def main():
    tree = BuildTree(sys.argv[1])
    headers = probes(tree)
    failures = 0
    refused = 0
    accepted = 0
    for target, allowed in MAY_INCLUDE.items():
        if tree.flags_of(target) is None:
            continue
        for folder, header in headers.items():
            probe = f'#include "{header}"\nint main() {{ return 0; }}\n'
            ok, messages = tree.compiles(target, probe, SOURCE_FOLDER.get(target, target))
            missing = f"fatal error: {header}: No such file" in messages
            if folder in allowed:
                accepted += ok
                problem = None if ok else "is allowed and does not compile:\n" + messages
            else:
                refused += missing
                problem = None if missing else "is forbidden and was found"
            if problem:
                failures += 1
                print(f"{target}: #include \"{header}\" {problem}")
    print(f"{refused} forbidden includes refused, {accepted} allowed includes accepted, "
          f"{failures} failures")
    return 1 if failures or not refused or not accepted else 0


if __name__ == "__main__":
    sys.exit(main())
