#!/usr/bin/env python3
"""The virtual arm and its executor as sim/README.md has them: both commands typed word by word, in real time; the part
ends at its goal, and the log that they leave exports. In a network of its own, since the port is everybody's.

  unshare --net pair.py BIN SOURCE PLAN
"""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from commands import BLOCK, commands_of

# A run that ends so may tell of a machine that gave executor or arm no time; as tests/support/busy_machine.cpp has them.
BUSY = {"overruns", "blind", "bus_silent", "feedback_missing", "feedback_poor"}
ATTEMPTS = 10


def commands_typed(source):
    text = (source / "sim/README.md").read_text(encoding="utf-8")
    block = next(match[2] for match in BLOCK.finditer(text) if match[2].startswith("tenon-sim ") and "tenon-exec" in match[2])
    return list(commands_of(block))


def attempt(sim, execute, folder, environment):
    """@return the executor's result, its output, the truth"""
    for name in ("result.json", "truth.json"):
        (folder / name).unlink(missing_ok=True)
    # Its output goes to a file: as to a terminal, nobody has to read it for it to go on.
    with open(folder / "sim.out", "w+", encoding="utf-8") as output:
        arm = subprocess.Popen(["bash", "-c", f"exec {sim}"], cwd=folder, env=environment, stdout=output, stderr=output)
        try:
            while arm.poll() is None and "listening on" not in (folder / "sim.out").read_text(encoding="utf-8"):
                time.sleep(0.02)
            ran = subprocess.run(["bash", "-c", execute], cwd=folder, env=environment, text=True, capture_output=True,
                                 check=False, timeout=300)
        finally:
            arm.send_signal(signal.SIGINT)
            arm.wait(60)
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    result = folder / "result.json"
    return json.loads(result.read_text(encoding="utf-8")) if result.exists() else None, ran.stdout + ran.stderr, truth


def main():
    programs, source, plan = map(pathlib.Path, sys.argv[1:4])
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    sim, execute = commands_typed(source)
    print(f"{sim}\n{execute}")
    environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
    with tempfile.TemporaryDirectory(prefix="tenon_pair_") as scratch:
        folder = pathlib.Path(scratch)
        for name in ("planner", "hw", "sim"):
            (folder / name).symlink_to(source / name)
        shutil.copy(plan, folder / "plan.tnp")
        for number in range(1, ATTEMPTS + 1):
            result, said, truth = attempt(sim, execute, folder, environment)
            if result is None:
                print(f"FAILED: no result: {said}")
                return 1
            print(f"{number}: {result['status']}: {result['message']}; {1e3 * truth['error_norm_m']:.2f} mm from the goal")
            if result["status"] == "done" or result.get("arm_fault", result["reason"]) not in BUSY:
                break
            time.sleep(number)
        if result["status"] != "done" or not truth["within_tolerance"]:
            print(f"FAILED: {said}")
            return 1
        exported = subprocess.run(["tenon-monitor", "export", "run.lcmlog", "--csv", "run.csv", "--mcap", "run.mcap"],
                                  cwd=folder, env=environment, text=True, capture_output=True, check=False)
        print(exported.stdout, end="")
        if exported.returncode != 0 or not re.match(rf"run\.csv: {result['cycle']['cycles']} cycles", exported.stdout):
            print(f"FAILED: export: {exported.stdout}{exported.stderr}, the run has {result['cycle']['cycles']} cycles")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
