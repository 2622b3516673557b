#!/usr/bin/env python3
"""Shows that each header compiles alone, with the flags of its own target.

What has compiled alone in the commit that .ci/linted names is not compiled again: a header that has not changed
since, nor any that it reads. --all compiles every header.

  headers_alone.py BUILD [--all]
"""
import concurrent.futures
import functools
import os
import re
import subprocess
import sys

from build_tree import FOLDERS, SOURCE, BuildTree

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


def changed_since_shown():
    """The headers, by their repository paths, that differ from that commit's; None where nobody can tell."""
    commit = (SOURCE / ".ci/linted").read_text(encoding="utf-8").split()[-1]
    names = set()
    for command in (["diff", "--name-only", commit], ["ls-files", "--others", "--exclude-standard"]):
        run = subprocess.run(["git", "-C", str(SOURCE), *command], text=True, capture_output=True, check=False)
        if run.returncode:
            return None
        names.update(run.stdout.split())
    return {name for name in names if name.endswith(".h")}


@functools.cache
def read_by(header):
    """A header of Tenon and all of Tenon's that it reads, directly or not."""
    path = SOURCE / (header if (SOURCE / header).exists() else f"tests/{header}")
    if not path.exists():
        return frozenset({header})  # generated: from what .lcm says
    found = {str(path.relative_to(SOURCE))}
    for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
        found |= read_by(name)
    return frozenset(found)


def main():
    tree = BuildTree(sys.argv[1])
    headers = [str(path.relative_to(SOURCE)) for folder in (*FOLDERS, "tests/support")
               for path in sorted((SOURCE / folder).rglob("*.h")) if not path.name.startswith("main_")]
    changed = None if "--all" in sys.argv else changed_since_shown()
    tests = next((tree.target_of(entry) for entry in tree.commands
                  if tree.target_of(entry).startswith("tests_")), None)

    def check(header):
        target = tests if header.startswith("tests/") else tree.room_of(header)
        if tree.flags_of(target) is None:
            target = tests
        ok, messages = tree.compiles(target, f'#include "{header}"\n', keep=header)
        return header, ok, messages

    remaining = [header for header in headers if changed is None or not changed.isdisjoint(read_by(header))]
    failures = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for header, ok, messages in pool.map(check, remaining):
            if not ok:
                failures += 1
                print(f"FAILED: {header} does not compile alone:\n{messages}")
    ok, _ = tree.compiles(tests, "#include <cstdint>\nstd::vector<int> missing_include();\n")
    if ok:
        failures += 1
        print("FAILED: a header that lacks an include was accepted")
    print(f"{len(headers)} headers: {len(headers) - len(remaining)} as they were when they did, "
          f"{len(remaining)} compiled alone, {failures} failures")
    return 1 if failures or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
