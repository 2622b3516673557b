#!/usr/bin/env python3
"""Draws tasks, plans them and has the virtual arm execute the plans; prints one table.

  evaluate_drawn.py --seed S --out FOLDER [--runs N] [--only PART] [--count N] [--bin FOLDER]

The arm is gantry3_peg, its world differs from the planner's as peg_in_hole.yaml says. FOLDER keeps tasks,
plans and runs: started again, only what is missing is made. Take another folder for another build. Planning
times are seconds of one core and of the clock, on the machine as it is; reach is the task's own.
--runs 0 only plans.
"""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from planned_and_run import ROOT, evaluate, options, parsed, plan, print_failures  # noqa: E402

CELL = ROOT / "hw" / "cells" / "gantry3_peg.yaml"
WORLD = ROOT / "sim" / "experiments" / "peg_in_hole.yaml"


def row(task, arguments):
    planned = plan(
        arguments.bin / "tenon-plan",
        task,
        CELL,
        task.with_suffix(""),
        arguments.threads,
        arguments.time_limit,
    )
    took = f"{task.stem:24s} {planned['core_seconds']:7.1f} s of a core, {planned['seconds']:7.1f} s"
    if not planned["planned"]:
        print(f"{took}  no plan: {planned['said']}", flush=True)
        return False, 0, 0, 0
    if arguments.runs == 0:
        print(took, flush=True)
        return True, 0, 0, 0
    known = evaluate(
        arguments.bin / "tenon-evaluate",
        task,
        CELL,
        WORLD,
        task.with_suffix(".tnp"),
        task.with_suffix(".runs.json"),
        arguments.runs,
        arguments.seed,
        arguments.threads,
    )
    summary = known["summary"]
    within = summary["within"][-1]
    promised = summary["promised"]
    print(
        f"{took}  {within['succeeded']:3d} of {within['runs']:3d} within {within['distance']:g} sigma,"
        f" {promised['succeeded']:3d} of {promised['runs']:3d} of these within the task's tilt,"
        f" {summary['success']['succeeded']:3d} of {summary['success']['runs']:3d} in all,"
        f" {summary['done_but_wrong']} done but wrong",
        flush=True,
    )
    print_failures(known)
    return True, within["succeeded"], within["runs"], summary["done_but_wrong"]


def main():
    parser = options(__doc__)
    parser.add_argument("--count", type=int, default=20, help="of tasks")
    arguments = parsed(parser)
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
