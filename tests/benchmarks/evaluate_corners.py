#!/usr/bin/env python3
"""Plans every shipped task from every start in every variant but #paper, and has the virtual arm execute each
plan at the corners of what the task leaves open: friction low or high, the part as drawn or its largest.

  evaluate_corners.py --seed S --out FOLDER [--runs N] [--only PART] [--bin FOLDER]

The cell is the first shipped one that a plan is found for; all else differs from the planner's world as the
experiment of box_on_table (a box) or peg_in_hole (what goes into something) says. A corner holds where 99 % of
the runs succeed that start within the planned reach in a world that is tilted by no more than the task says. FOLDER keeps plans and runs: started again, only what is missing is
made. Take another folder for another build.
"""

import pathlib
import re

from planned_and_run import ROOT, evaluate, options, parsed, plan, print_failures
from plan_times import TASKS, starts

CELLS = ["gantry3", "gantry3_peg", "csp6_bench", "csp6_peg", "csp6"]


def variants(file):
    block = re.search(r"^variants:\n((?:[ #].*\n|\n)*)", file.read_text(), re.M)
    return re.findall(r"^  ([\w.-]+):", block.group(1), re.M) if block else []


def shipped():
    """Pairs of a task, or variant of one, and a start."""
    for file in sorted(TASKS.glob("*.yaml")):
        for task in [str(file), *(f"{file}#{v}" for v in variants(file) if v != "paper")]:
            yield from ((task, start) for start in starts(file))


def corners(task):
    """Where no part is larger than drawn there is no largest."""
    text = pathlib.Path(task.partition("#")[0]).read_text()
    sizes = ["drawn", "largest"] if re.search(r"^\s+oversize_m: *[^0\s]|oversize_m: *0\.\d*[1-9]", text, re.M) else ["drawn"]
    return [f"{friction},{size}" for friction in ("low", "high") for size in sizes]


def planned_for_a_cell(task, start, stem, arguments):
    """The first cell with a plan; None and the reasons where there is none."""
    reasons = []
    for name in CELLS:
        cell = ROOT / "hw" / "cells" / f"{name}.yaml"
        known = plan(
            arguments.bin / "tenon-plan",
            task,
            cell,
            stem.with_name(f"{stem.name}.{name}"),
            arguments.threads,
            arguments.time_limit,
            ["--start", start],
        )
        if known["planned"]:
            return cell, reasons
        reasons.append(f"{name}: {known['said']}")
    return None, reasons


def name_of(task):
    """"peg#clearance_0.5mm" of "tasks/peg.yaml#clearance_0.5mm", whose last dot is the variant's."""
    file, mark, variant = task.partition("#")
    return pathlib.Path(file).stem + mark + variant


def measure(task, start, arguments):
    """Prints a line a corner; how many corners were run, how many hold, and how many runs were done but wrong."""
    name = name_of(task)
    stem = arguments.out / f"{name.replace('#', '_')}_{start}"
    cell, reasons = planned_for_a_cell(task, start, stem, arguments)
    if cell is None:
        print(f"{name} from {start}: no plan", *reasons, sep="\n    ", flush=True)
        return 0, 0, 0
    kind = "box_on_table" if name.startswith("box") else "peg_in_hole"
    held = wrong = 0
    for corner in corners(task):
        known = evaluate(
            arguments.bin / "tenon-evaluate",
            task,
            cell,
            ROOT / "sim" / "experiments" / f"{kind}.yaml",
            stem.with_name(f"{stem.name}.{cell.stem}.tnp"),
            stem.with_name(f"{stem.name}.{cell.stem}.{corner.replace(',', '_')}.json"),
            arguments.runs,
            arguments.seed,
            arguments.threads,
            ["--corner", corner],
        )
        within = known["summary"]["within"][-1]
        promised = known["summary"]["promised"]
        holds = promised["succeeded"] >= 0.99 * promised["runs"]
        held += holds
        wrong += known["summary"]["done_but_wrong"]
        print(
            f"{name} from {start}, {cell.stem}, {corner}: {within['succeeded']} of {within['runs']} within"
            f" {within['distance']:g} sigma, {promised['succeeded']} of {promised['runs']} of these within the"
            f" task's tilt, {known['summary']['done_but_wrong']} done but wrong"
            f"{'' if holds else '  DOES NOT HOLD'}",
            flush=True,
        )
        print_failures(known)
    return len(corners(task)), held, wrong


def main():
    arguments = parsed(options(__doc__))
    rows = [measure(t, s, arguments) for t, s in shipped() if arguments.only in pathlib.Path(t).name]
    print(
        f"{sum(held for _, held, _ in rows)} of {sum(run for run, *_ in rows)} corners hold, of"
        f" {sum(1 for run, *_ in rows if run)} plans; {sum(1 for run, *_ in rows if not run)} without a plan;"
        f" {sum(wrong for *_, wrong in rows)} runs done but wrong"
    )


if __name__ == "__main__":
    main()
