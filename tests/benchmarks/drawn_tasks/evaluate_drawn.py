#!/usr/bin/env python3
"""Draws tasks, plans them and has the virtual arm execute the plans; prints one table.

  evaluate_drawn.py --seed S --out FOLDER [--runs N] [--only PART] [--count N] [--bin FOLDER]

The arm is gantry3_peg, its world differs from the planner's as peg_in_hole.yaml says. FOLDER keeps tasks,
plans and runs: started again, only what is missing is made. Take another folder for another build. Planning
times are seconds of one core and of the clock, on the machine as it is; reach is the task's own.
"""

import argparse
import json
import pathlib
import resource
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
CELL = ROOT / "hw" / "cells" / "gantry3_peg.yaml"
WORLD = ROOT / "sim" / "experiments" / "peg_in_hole.yaml"


def plan(program, task, threads, time_limit_s):
    """Plans once; what came of it, from beside the plan where it is known."""
    note = task.with_suffix(".planned.json")
    if note.exists():
        return json.loads(note.read_text())
    command = [program, task, "--cell", CELL, "-o", task.with_suffix(".tnp")]
    command += ["--json", task.with_suffix(".stats.json"), "--threads", str(threads)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    ended = subprocess.run(
        [str(part) for part in command + ["--time-limit", time_limit_s]],
        capture_output=True,
        text=True,
        check=False,
    )
    if ended.returncode not in (0, 1):
        sys.exit(f"evaluate_drawn: {task}: tenon-plan ended with {ended.returncode}: {ended.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    said = ended.stderr.strip().splitlines() or ended.stdout.strip().splitlines() or [""]
    result = {
        "planned": ended.returncode == 0,
        "seconds": time.monotonic() - began,
        "core_seconds": after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime,
        "said": "" if ended.returncode == 0 else said[-1],
    }
    note.write_text(json.dumps(result) + "\n")
    return result


def evaluate(program, task, runs, seed, threads):
    """The summary of the runs; tenon-evaluate itself goes on where it was stopped."""
    results = task.with_suffix(".runs.json")
    known = json.loads(results.read_text())["plans"][0] if results.exists() else None
    if known is None or known["summary"]["success"]["runs"] < runs:
        command = [program, "--cell", CELL, "--task", task, "--plan", task.with_suffix(".tnp")]
        command += ["--experiment", WORLD, "-n", runs, "--seed", seed, "--threads", threads]
        subprocess.run(
            [str(part) for part in command + ["--json", results]], stdout=subprocess.DEVNULL, check=True
        )
        known = json.loads(results.read_text())["plans"][0]
    return known


def row(task, arguments):
    planned = plan(arguments.bin / "tenon-plan", task, arguments.threads, arguments.time_limit)
    took = f"{task.stem:24s} {planned['core_seconds']:7.1f} s of a core, {planned['seconds']:7.1f} s"
    if not planned["planned"]:
        print(f"{took}  no plan: {planned['said']}", flush=True)
        return False, 0, 0, 0
    if arguments.runs == 0:
        print(took, flush=True)
        return True, 0, 0, 0
    known = evaluate(
        arguments.bin / "tenon-evaluate", task, arguments.runs, arguments.seed, arguments.threads
    )
    summary = known["summary"]
    within = summary["within"][-1]
    print(
        f"{took}  {within['succeeded']:3d} of {within['runs']:3d} within {within['distance']:g} sigma,"
        f" {summary['success']['succeeded']:3d} of {summary['success']['runs']:3d} in all,"
        f" {summary['done_but_wrong']} done but wrong",
        flush=True,
    )
    for group in known["failures"]:
        print(
            f"    {group['runs']} {group['class']} with {group['outcome']}, first run"
            f" {group['first_run']}: {group['first_reason']}"
        )
    return True, within["succeeded"], within["runs"], summary["done_but_wrong"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, required=True, help="of the tasks and of the runs")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--runs", type=int, default=200, help="of each plan; 0: plan only")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--time-limit", type=float, default=300.0)
    parser.add_argument("--only", default="", help="tasks with this in their name")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    draw = pathlib.Path(__file__).with_name("draw_tasks.py")
    command = [sys.executable, "-B", draw, "--out", arguments.out]
    command += ["--seed", str(arguments.seed), "--count", str(arguments.count)]
    subprocess.run(command, check=True)
    tasks = [t for t in sorted(arguments.out.glob("*.yaml")) if arguments.only in t.stem]
    rows = [row(task, arguments) for task in tasks]
    held = sum(1 for planned, good, runs, _ in rows if planned and good >= 0.98 * runs)
    print(
        f"seed {arguments.seed}: {sum(planned for planned, *_ in rows)} of {len(rows)} planned, {held} of"
        f" them hold in 98 % within reach, {sum(wrong for *_, wrong in rows)} runs done but wrong"
    )


if __name__ == "__main__":
    main()
