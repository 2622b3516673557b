#!/usr/bin/env python3
"""tenon-monitor's dashboard beside a real run: tenon-exec against tenon-sim, in a network of the test's own. To its
end; with a drive that falls silent; with an executor that is killed.

  real_run.py BIN SOURCE PLAN [--print]

@param PLAN of start 4 of the box task on the gantry
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import network
from terminal import Terminal

STEPS = 7
# A machine that gave a process no time has not shown anything.
BUSY = ("overruns", "feedback_poor", "arm_fault", "feedback_missing", "wrench_missing", "blind", "following_error")
ATTEMPTS = 4


class Run:
    """One run of the plan, watched at a size."""

    def __init__(self, arguments, folder, size, faults=()):
        self.arguments = arguments
        self.result_file = folder / "result.json"
        self.result_file.unlink(missing_ok=True)
        cell = f"{arguments.source}/hw/cells/gantry3.yaml"
        self.terminal = Terminal([f"{arguments.bin}/tenon-monitor"], *size)
        self.terminal.wait_for("WAITING")
        ready = folder / "ready"
        ready.unlink(missing_ok=True)
        self.sim = subprocess.Popen(
            [f"{arguments.bin}/tenon-sim", "--cell", cell, "--task",
             f"{arguments.source}/planner/tasks/box_on_table_2d.yaml", "--start", "4", "--once",
             "--can", "slcan-listen://127.0.0.1:0", "--ready-file", str(ready), *faults],
            stdout=subprocess.PIPE, text=True)
        end = time.monotonic() + 30.0
        while not ready.exists() and time.monotonic() < end:
            time.sleep(0.05)
        if not ready.exists():
            raise RuntimeError("tenon-sim does not listen")
        uri = "slcan://" + self.sim.stdout.readline().split()[-1]
        self.exec = subprocess.Popen(
            [f"{arguments.bin}/tenon-exec", "--cell", cell, "--plan", arguments.plan, "--can", uri, "--rt", "off",
             "--json", str(self.result_file), "--black-box", str(folder / "box.csv")],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def reason(self):
        return json.loads(self.result_file.read_text())["reason"] if self.result_file.exists() else None

    def close(self):
        for process in (self.exec, self.sim):
            if process.poll() is None:
                process.kill()
            process.wait()
        status = self.terminal.end("q")
        self.terminal.close()
        return status


class Test:
    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder
        self.failures = 0
        self.where = ""

    def check(self, good, what, run):
        if not good:
            self.failures += 1
            print(f"FAILED: {self.where}: {what}\n{run.terminal.text()}")

    def look(self, run, *patterns):
        for pattern in patterns:
            self.check(run.terminal.row(pattern) is not None, f"no row {pattern!r}", run)
        self.check(run.terminal.screen.wraps == 0, "a line ran over its end", run)
        if self.arguments.print:
            print(f"=== {self.where}\n{run.terminal.text()}")

    def in_a_step(self, run):
        return run.terminal.wait_for(rf"^LIVE: running, step \d+ \([1-{STEPS}] of {STEPS}\)", 30.0)

    def to_its_end(self, size):
        """@return false: the machine was too busy"""
        self.where = f"{size[0]} columns, to its end"
        run = Run(self.arguments, self.folder, size)
        seen = self.in_a_step(run)
        if seen:
            run.terminal.read(0.5)
            self.look(run, r"plan box_on_table_2d, start 4", r"cell gantry3", r"running, drives enabled",
                      r"step \d \(\d of 7\)", r"expects", r"^x +[+-]\d+\.\d N .* %|x +[+-]\d+\.\d N .* %",
                      r"\|f\| +\d+\.\d N .* of +60 N", r"z +\+0\.\d{4} m ", r"load +\d+ % ", r"\d+ frames/s",
                      r"wakes late +\d+\.\d{3} ms", r"cycle \d\.\d s ago")
            load = re.search(r"load +(\d+) %", run.terminal.text())
            # The same frames by their count and length: 9 a cycle of 2 ms, 1 Mbit/s.
            self.check(load and 30 <= int(load.group(1)) <= 60, "an unlikely load", run)
        ended = run.terminal.wait_for(r"^(DONE|FAILED|STOPPED): ", 60.0)
        while run.exec.poll() is None and run.terminal.row("finished, drives") is None:
            run.terminal.read()
        run.exec.wait(30)
        busy = run.reason() in BUSY
        if not busy:
            self.check(seen and ended, "no step, or no end", run)
            self.check(run.terminal.wait_for(r"finished, drives"), "does not finish", run)
            self.look(run, r"^DONE: ")
            self.check(run.close() == 0, "does not end in good order", run)
            return True
        run.close()
        return False

    def silent_drive(self, size):
        self.where = f"{size[0]} columns, a silent drive"
        run = Run(self.arguments, self.folder, size, ["--fault", "drop:node=2,time_s=5,duration_s=100"])
        self.check(run.terminal.wait_for(r"^FAULT arm_fault", 30.0), "no fault", run)
        run.terminal.read(0.3)
        ours = "FAULT arm_fault: feedback_missing at node 2" in " ".join(run.terminal.text().split())
        if ours:
            self.look(run, r"y +[+-]\d\.\d+ m +NO ANSWER for")
            self.check(run.terminal.style(0, 0)[1] == "red", "a fault is not red", run)
            self.check(run.terminal.wait_for(r"^FAILED: arm: node 2 \(y\): no", 30.0), "no end", run)
            self.look(run, r"^FAILED: arm: node 2")
        run.close()
        return ours

    def killed(self, size):
        self.where = f"{size[0]} columns, killed"
        run = Run(self.arguments, self.folder, size)
        seen = self.in_a_step(run)
        if seen:
            run.exec.kill()
            time.sleep(0.1)
            self.check(run.terminal.wait_for(r"^STALE: no cycle for [1-9]\.\d s; what is shown is old", 10.0),
                       "not stale", run)
            self.look(run, r"^STALE")
        run.close()
        return seen


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin")
    parser.add_argument("source")
    parser.add_argument("plan")
    parser.add_argument("--print", action="store_true", help="every screen")
    arguments = parser.parse_args()
    network.enter()
    with tempfile.TemporaryDirectory() as name:
        test = Test(arguments, pathlib.Path(name))
        for scene, size in [(test.to_its_end, (80, 30)), (test.silent_drive, (40, 34)), (test.killed, (200, 30))]:
            attempt = 0
            while not scene(size):
                attempt += 1
                if attempt == ATTEMPTS:
                    test.failures += 1
                    print(f"FAILED: {test.where}: ended for want of time {ATTEMPTS} times")
                    break
                time.sleep(5 * attempt)
    print(f"{test.failures} failures")
    return 1 if test.failures else 0


if __name__ == "__main__":
    sys.exit(main())
