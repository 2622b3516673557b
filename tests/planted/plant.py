#!/usr/bin/env python3
"""Shows that the tests of the default tier see a fault: plants each of faults.yaml in a copy of the tree, builds the
tests that must see it, and runs them.

  plant.py [WORDS...]       the faults that have one of these in their lines of the list; all unless told otherwise
  plant.py --list           prints the list and checks that it fits the tree; builds nothing
  plant.py --folder FOLDER  copies and builds there and leaves it, so that the next time less is compiled

First the same tests must pass without a fault. Exit status 0 if all were caught, 1 if not, 2 if the list is out of
date. A build with sanitizers takes the plans of build/dev in the tree itself.
"""
import argparse
import dataclasses
import filecmp
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import yaml

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LIST = pathlib.Path(__file__).resolve().parent / "faults.yaml"
NOT_COPIED = {".git", "build"}
FAILED = re.compile(r"^\s*\d+ - (\S+) \((?!Not Run)", re.M)
FAILED_CASE = re.compile(r"^\[  FAILED  \] (\w\S*?),? .*\(\d+ ms\)$", re.M)


class OutOfDate(Exception):
    """The list does not fit the tree."""


class Broken(Exception):
    """What should build or pass does not, whatever was planted."""


@dataclasses.dataclass(frozen=True)
class Fault:
    name: str
    file: str
    text: str
    becomes: str
    area: str
    preset: str = "dev"
    tests: str = ""

    def line(self):
        return f"{self.preset:10}  {self.area:10}  {self.name}"

    def selection(self):
        return self.preset, self.area, self.tests

    def planted(self, text):
        """The text of the file with the fault in it."""
        count = text.count(self.text)
        if count != 1:
            raise OutOfDate(f"{LIST.name}: \"{self.name}\": its text stands {count} times in {self.file}, must stand "
                            "there once; the list is out of date")
        return text.replace(self.text, self.becomes)


def read_faults():
    with open(LIST, encoding="utf-8") as stream:
        faults = [Fault(**entry) for entry in yaml.safe_load(stream)]
    for fault in faults:
        path = SOURCE / fault.file
        fault.planted(path.read_text(encoding="utf-8") if path.is_file() else "")
    return faults


def files_of(root):
    """What a copy of the tree holds, as paths below its root."""
    for folder, folders, files in os.walk(root):
        here = pathlib.Path(folder).relative_to(root)
        if here == pathlib.Path("."):
            folders[:] = [name for name in folders if name not in NOT_COPIED]
        yield from (here / name for name in files)


def copy_tree(root):
    """Brings a copy up to date. What is the same already stays as it is, so that nothing is compiled again."""
    ours = set(files_of(SOURCE))
    for path in set(files_of(root)) - ours:
        (root / path).unlink()
    for path in ours:
        if not (root / path).exists() or not filecmp.cmp(SOURCE / path, root / path, shallow=False):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / path, root / path)


class Copy:
    def __init__(self, root, jobs):
        self.root = root
        self.jobs = str(jobs)
        self.configured = set()
        copy_tree(root)

    def run(self, *words):
        return subprocess.run(words, cwd=self.root, text=True, check=False, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)

    def build(self, preset, area):
        """Raises what the compiler said where it fails."""
        if preset not in self.configured:
            run = self.run("cmake", "--preset", preset, f"-DTENON_PLANS_FROM={SOURCE / 'build/dev/plans'}")
            if run.returncode != 0:
                raise Broken(run.stdout)
            self.configured.add(preset)
        run = self.run("cmake", "--build", "--preset", preset, "--parallel", self.jobs, "--target", f"tests_{area}")
        if run.returncode != 0:
            raise Broken(run.stdout)

    def failing_tests(self, preset, area, tests, to_the_end):
        """Builds and runs a selection of the default tier. @return the names of those that fail, and what was said"""
        self.build(preset, area)
        words = ["ctest", "--preset", preset, "--parallel", self.jobs, "--label-regex", f"^{area}$",
                 "--label-exclude", "^full$", "--tests-regex", tests or ".", "--output-on-failure"]
        run = self.run(*words, *([] if to_the_end else ["--stop-on-failure"]))
        failed = FAILED.findall(run.stdout.partition("The following tests FAILED:")[2])
        if run.returncode != 0 and not failed:
            raise Broken(run.stdout)
        if failed:  # where a test is many cases: those
            failed = FAILED_CASE.findall(run.stdout) or failed
        return failed, run.stdout

    def plant(self, fault):
        path = self.root / fault.file
        sound = path.read_text(encoding="utf-8")
        path.write_text(fault.planted(sound), encoding="utf-8")
        try:
            return self.failing_tests(*fault.selection(), to_the_end=False)[0]
        finally:
            path.write_text(sound, encoding="utf-8")


def check_sound(copy, faults):
    """All selections pass where nothing is planted."""
    for preset, area, tests in dict.fromkeys(fault.selection() for fault in faults):
        begin_s = time.monotonic()
        failed, said = copy.failing_tests(preset, area, tests, to_the_end=True)
        if failed:
            raise Broken(f"{said}\nwithout a fault these fail already: {' '.join(failed)}")
        print(f"sound   {preset} {area} {tests} ({time.monotonic() - begin_s:.0f} s)", flush=True)


def plant_all(copy, faults):
    """@return how many were missed"""
    check_sound(copy, faults)
    missed = 0
    for fault in faults:
        begin_s = time.monotonic()
        try:
            failed = copy.plant(fault)
        except Broken as broken:
            raise Broken(f"{broken}\n\"{fault.name}\" does not build") from None
        if failed:
            print(f"caught  {fault.name}  by {failed[0]} ({time.monotonic() - begin_s:.0f} s)", flush=True)
        else:
            missed += 1
            print(f"MISSED  {fault.name}", flush=True)
    print(f"{len(faults)} faults planted, {len(faults) - missed} caught")
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("words", nargs="*", metavar="WORDS")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--jobs", "-j", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    try:
        faults = [fault for fault in read_faults()
                  if not arguments.words or any(words in fault.line() for words in arguments.words)]
        if arguments.list:
            for fault in faults:
                print(fault.line())
            return 0
        if not faults:
            raise OutOfDate(f"{LIST.name}: no fault's line has one of these: {', '.join(arguments.words)}")
        with tempfile.TemporaryDirectory(prefix="tenon_planted_") as temporary:
            root = (arguments.folder or pathlib.Path(temporary)).resolve()
            return 1 if plant_all(Copy(root, arguments.jobs), faults) else 0
    except OutOfDate as error:
        print(f"plant: {error}", file=sys.stderr)
        return 2
    except Broken as error:
        print(f"plant: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
