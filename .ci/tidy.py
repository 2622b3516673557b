#!/usr/bin/env python3
"""Runs clang-tidy over Tenon's own sources: over those that have changed, or over all.

  .ci/tidy.py build/lint [-j N] [--all] [PATH...]    PATH: folders or files below the repository
  .ci/tidy.py build/lint --list                      only says which have changed

Changed means: neither this text (but for its include lines, so that moving a file changes nothing) stood
anywhere in the commit that .ci/linted names, nor has this file passed before on this machine. For a changed
header one source that includes it is checked, the one of its own name if there is one. --all checks every
source, and the product's with the static analyzer too, which takes four fifths of the time (tests are run, under
sanitizers too). What has passed before on this machine is remembered all the same, by a hash over the preprocessed
text, comments included, and over the configuration, in the user's cache folder: it outlives a clone.

A finding in a header is shown once, however many files include it. Exit status 1 when there are findings.
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
LINTED = SOURCE / ".ci/linted"
FINDING = re.compile(r"^(?P<path>[^\s:][^:]*):(?P<place>\d+:\d+): (error|warning): ", re.M)
INCLUDE_LINE = re.compile(rb"^\s*#\s*include\b[^\n]*\n", re.M)
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
KEPT_DAYS = 60


def memory():
    """The folder of stamps, one for every text that has passed; old ones are dropped."""
    cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
    folder = cache / "tenon/tidy"
    folder.mkdir(parents=True, exist_ok=True)
    for stamp in folder.iterdir():
        if time.time() - stamp.stat().st_mtime > KEPT_DAYS * 86400:
            stamp.unlink(missing_ok=True)
    return folder


def compiler_words(entry):
    """The compiler and its flags, without launcher, precompiled header, input and output."""
    words = shlex.split(entry["command"])
    while not re.search(r"(\+\+|cc)(-\d+)?$", words[0]):
        words.pop(0)
    kept = []
    skip = False
    for word, following in zip(words, [*words[1:], ""]):
        if skip:
            skip = False
        elif word in ("-o", "-c") or (word == "-include" and "cmake_pch" in following):
            skip = True
        elif word != "-Winvalid-pch":
            kept.append(word)
    return kept


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
    return dict(sorted(seen.items()))


def text_key(text):
    return hashlib.sha256(INCLUDE_LINE.sub(b"", text)).digest()


def rules_key(text):
    """Of .clang-tidy without comments, and without saying whose headers are ours: other rules, other findings."""
    return text_key(re.sub(rb"^(#|HeaderFilterRegex)[^\n]*\n", b"", text, flags=re.M))


def git(*arguments, **options):
    return subprocess.run(["git", "-C", str(SOURCE), *arguments], capture_output=True, check=False,
                          **options)


def linted_texts():
    """What stood in the commit that .ci/linted names, by key; None where nobody can tell."""
    commit = LINTED.read_text(encoding="utf-8").split()[-1]
    listing = git("ls-tree", "-r", commit)
    if listing.returncode:
        return None
    blobs = [line.split()[2] for line in listing.stdout.splitlines()
             if line.endswith((b".cpp", b".h", b".clang-tidy", b".suppressions"))]
    out = git("cat-file", "--batch", input=b"\n".join(blobs) + b"\n").stdout
    keys = set()
    position = 0
    for _ in blobs:
        header_end = out.index(b"\n", position)
        size = int(out[position:header_end].split()[2])
        text = out[header_end + 1 : header_end + 1 + size]
        keys |= {text_key(text), rules_key(text)}
        position = header_end + size + 2
    return keys


def changed(work, linted):
    """The part of `work` that must be looked at: changed sources, and one source a changed header."""
    headers = {}
    for folder in ("shared", "planner", "executor", "hw", "sim", "tests"):
        for path in (SOURCE / folder).rglob("*.h"):
            headers[str(path.relative_to(SOURCE))] = text_key(path.read_bytes()) not in linted
    chosen = {path for path in work if text_key(path.read_bytes()) not in linted}
    includes = {path: set(INCLUDE.findall(path.read_text(encoding="utf-8"))) for path in work}
    for header in (name for name, is_changed in headers.items() if is_changed):
        own = SOURCE / header.replace(".h", ".cpp")
        readers = [path for path in work if header in includes[path]]
        if own in work or readers:
            chosen.add(own if own in work else next((r for r in readers if r in chosen), readers[0]))
    return {path: work[path] for path in sorted(chosen)}


def configuration(path, without):
    """All that decides what clang-tidy says about a file, apart from its text."""
    digest = hashlib.sha256(subprocess.run(["clang-tidy", "--version"], capture_output=True,
                                           check=True).stdout)
    digest.update(" ".join(without).encode())
    for folder in [path.parent, *path.parent.parents]:
        config = folder / ".clang-tidy"
        if config.is_file():
            digest.update(config.read_bytes())
        if folder == SOURCE:
            break
    return digest


def fingerprint(path, entry, without):
    words = compiler_words(entry)
    text = subprocess.run([*words, "-E", "-C", str(path)], cwd=entry["directory"], capture_output=True,
                          check=False)
    digest = configuration(path, without)
    # No clone's own path: another clone's memory is as good.
    here = str(SOURCE).encode()
    digest.update(" ".join(words).encode().replace(here, b"."))
    digest.update(text.stdout.replace(here, b"."))
    return None if text.returncode else digest.hexdigest()


def check(path, entry, database, stamps, without):
    """Returns (path, output, seconds); the output is empty when there is nothing to report."""
    begin_s = time.monotonic()
    key = fingerprint(path, entry, without)
    stamp = stamps / key if key else None
    if stamp and stamp.exists():
        stamp.touch()
        return path, "", 0.0
    # The compiler's own warnings are the build's business, and g++ and clang disagree about some.
    run = subprocess.run(
        ["clang-tidy", "-p", str(database), "--quiet", "--extra-arg=-Wno-everything", *without, str(path)],
        capture_output=True, text=True, check=False)
    if run.returncode == 0:
        if stamp:
            stamp.touch()
        return path, "", time.monotonic() - begin_s
    return path, run.stdout or run.stderr, time.monotonic() - begin_s


def write_database(build, work):
    """Compile commands as clang reads them: GCC's precompiled headers are nothing to it."""
    folder = build / "tidy"
    folder.mkdir(exist_ok=True)
    commands = [{"directory": entry["directory"], "file": str(path),
                 "arguments": [*compiler_words(entry), "-c", str(path)]}
                for path, entry in work.items()]
    with open(folder / "compile_commands.json", "w", encoding="utf-8") as stream:
        json.dump(commands, stream)
    return folder


def findings(output):
    """Splits clang-tidy's output into findings, their paths made relative to the repository."""
    output = re.sub(re.escape(str(SOURCE)) + r"/(build/[^/]+/roots/[a-z0-9_-]+/)?", "", output)
    output = re.sub(r"/\S*/roots/[a-z0-9_-]+/", "", output)
    starts = [match.start() for match in FINDING.finditer(output)]
    if not starts:
        return [output.strip()]
    return [output[a:b].rstrip() for a, b in zip(starts, starts[1:] + [len(output)])]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("paths", nargs="*")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_intermixed_args()
    build = arguments.build.resolve()

    ours = entries(build, arguments.paths)
    linted = None if arguments.all else linted_texts()
    if linted is None and not arguments.all and not arguments.list:
        print("clang-tidy: the commit that .ci/linted names is not in this clone; all files are checked")
    if linted is not None and rules_key((SOURCE / ".clang-tidy").read_bytes()) not in linted:
        linted = None
    if arguments.list:
        suppressed = text_key((SOURCE / ".ci/cppcheck.suppressions").read_bytes())
        known = linted is not None and suppressed in linted
        print("".join(f"{path}\n" for path in (changed(ours, linted) if known else ours)), end="")
        return 0
    work = ours if linted is None else changed(ours, linted)
    database = write_database(build, work)
    stamps = memory()

    def without(path):
        analysed = arguments.all and SOURCE / "tests" not in path.parents
        return [] if analysed else ["--checks=-clang-analyzer-*"]

    shown = set()
    checked = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        futures = [pool.submit(check, path, entry, database, stamps, without(path))
                   for path, entry in work.items()]
        for future in concurrent.futures.as_completed(futures):
            path, output, seconds = future.result()
            checked += seconds > 0
            if not output:
                continue
            for finding in findings(output):
                if finding not in shown:
                    shown.add(finding)
                    print(finding, flush=True)
    print(f"clang-tidy: {len(ours)} files, {len(work)} of them changed since the last look at all, "
          f"{checked} of these looked at now, {len(shown)} findings")
    return 1 if shown else 0


if __name__ == "__main__":
    sys.exit(main())
