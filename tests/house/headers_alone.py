#!/usr/bin/env python3
"""Shows that each header compiles alone.

Where x.cpp includes x.h before anything else, its compilation has shown it already; the remaining
headers are compiled here, each by itself, with the flags of its own target.

  headers_alone.py BUILD
"""
import concurrent.futures
import os
import re
import sys

from build_tree import FOLDERS, SOURCE, BuildTree

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)


def shown_by_the_build(tree):
    """The headers that are the first include of a source of the build."""
    shown = set()
    for entry in tree.commands:
        if "cmake_pch" in entry["command"]:
            continue  # what its precompiled header holds, it need not include
        with open(entry["file"], encoding="utf-8") as stream:
            first = INCLUDE.search(stream.read())
        if first:
            shown.add(first.group(1))
    return shown


def main():
    tree = BuildTree(sys.argv[1])
    headers = [str(path.relative_to(SOURCE)) for folder in (*FOLDERS, "tests/support")
               for path in sorted((SOURCE / folder).rglob("*.h")) if not path.name.startswith("main_")]
    shown = shown_by_the_build(tree)
    tests = next((tree.target_of(entry) for entry in tree.commands
                  if tree.target_of(entry).startswith("tests_")), None)

    def check(header):
        target = tests if header.startswith("tests/") else tree.room_of(header)
        if tree.flags_of(target) is None:
            target = tests
        ok, messages = tree.compiles(target, f'#include "{header}"\n', keep=header)
        return header, ok, messages

    remaining = [header for header in headers if header not in shown]
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
    print(f"{len(headers)} headers: {len(headers) - len(remaining)} shown by the build, "
          f"{len(remaining)} compiled alone, {failures} failures")
    return 1 if failures or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
