#!/usr/bin/env python3
"""Runs clang-tidy over Tenon's own sources, and over each only when it has changed.

  .ci/tidy.py build/dev [-j N] [PATH...]    PATH: folders or files below the repository

A file that passed is remembered (in BUILD/tidy_passed) by a hash over its preprocessed text, comments
included, and over the configuration, so a second run costs one preprocessor call a file. A finding in
a header is shown once, however many files include it. Exit status 1 when there are findings.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
FINDING = re.compile(r"^(?P<path>[^\s:][^:]*):(?P<place>\d+:\d+): (error|warning): ", re.M)


def entries(build, wanted):
    """The compile commands of our own sources, those below `wanted` if it is not empty."""
    with open(build / "compile_commands.json", encoding="utf-8") as stream:
        commands = json.load(stream)
    roots = [(SOURCE / path).resolve() for path in wanted] or [SOURCE]
    seen = {}
    for entry in commands:
        path = pathlib.Path(entry["file"]).resolve()
        inside = any(path == root or root in path.parents for root in roots)
        if inside and build not in path.parents:
            seen.setdefault(path, entry)
    return sorted(seen.items())


def configuration(path):
    """All that decides what clang-tidy says about a file, apart from its text."""
    digest = hashlib.sha256()
    for folder in [path.parent, *path.parent.parents]:
        config = folder / ".clang-tidy"
        if config.is_file():
            digest.update(config.read_bytes())
        if folder == SOURCE:
            break
    return digest


def fingerprint(path, entry):
    arguments = shlex.split(entry["command"])
    if os.path.basename(arguments[0]) == "ccache":
        arguments = arguments[1:]
    output = arguments.index("-o")
    arguments[output : output + 2] = []
    arguments.remove("-c")
    text = subprocess.run([*arguments, "-E", "-C"], cwd=entry["directory"], capture_output=True,
                          check=False)
    digest = configuration(path)
    digest.update(" ".join(arguments).encode())
    digest.update(text.stdout)
    return None if text.returncode else digest.hexdigest()


def check(path, entry, build):
    """Returns (path, output, seconds); the output is empty when there is nothing to report."""
    begin_s = time.monotonic()
    key = fingerprint(path, entry)
    stamp = build / "tidy_passed" / key if key else None
    if stamp and stamp.exists():
        return path, "", 0.0
    # The compiler's own warnings are the build's business, and g++ and clang disagree about some.
    run = subprocess.run(
        ["clang-tidy", "-p", str(build), "--quiet", "--extra-arg=-Wno-everything", str(path)],
        capture_output=True, text=True, check=False)
    if run.returncode == 0:
        if stamp:
            stamp.touch()
        return path, "", time.monotonic() - begin_s
    return path, run.stdout or run.stderr, time.monotonic() - begin_s


def findings(output):
    """Splits clang-tidy's output into findings, their paths made relative to the repository."""
    output = re.sub(re.escape(str(SOURCE)) + r"/(build/[^/]+/roots/[a-z_]+/)?", "", output)
    output = re.sub(r"/\S*/roots/[a-z_]+/", "", output)
    starts = [match.start() for match in FINDING.finditer(output)]
    if not starts:
        return [output.strip()]
    return [output[a:b].rstrip() for a, b in zip(starts, starts[1:] + [len(output)])]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("paths", nargs="*")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_intermixed_args()
    build = arguments.build.resolve()
    (build / "tidy_passed").mkdir(exist_ok=True)

    work = entries(build, arguments.paths)
    shown = set()
    checked = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        futures = [pool.submit(check, path, entry, build) for path, entry in work]
        for future in concurrent.futures.as_completed(futures):
            path, output, seconds = future.result()
            checked += seconds > 0
            if not output:
                continue
            for finding in findings(output):
                if finding not in shown:
                    shown.add(finding)
                    print(finding, flush=True)
    print(f"clang-tidy: {len(work)} files, {checked} of them new or changed, {len(shown)} findings")
    return 1 if shown else 0


if __name__ == "__main__":
    sys.exit(main())
