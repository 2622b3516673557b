#!/usr/bin/env python3
"""Times tenon-plan as a whole process: shipped tasks, and tasks that draw_tasks.py draws.

  plan_times.py [--bin FOLDER] [--repeat N] [--seed S]... [--json FILE] [NAME...]

A line for each task: seconds from start to end (median and worst of N runs), the medians of finding guides and of
searching, certifying and running the corners, how many starts of it were planned, largest resident memory. Names
choose groups or tasks by a part of their name. Nothing is asserted.
"""

import argparse
import json
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
TASKS = ROOT / "planner" / "tasks"
SHIPPED = [
    "box_on_table_2d",
    "box_on_table_3d",
    "connector",
    "peg_in_hole_2d",
    "peg_in_hole_2d#clearance_1mm",
    "peg_in_hole_2d#clearance_0.5mm",
    "peg_in_hole_2d_fine",
    "peg_in_hole_2d_fine#clearance_1mm",
    "peg_in_hole_2d_fine#clearance_0.5mm",
    "peg_in_hole_3d",
    "peg_in_hole_3d#clearance_1mm",
    "peg_in_hole_3d#clearance_0.5mm",
]


def starts(file):
    """Names of a task file's starts, in order."""
    block = re.search(r"^starts:\n((?:[ #].*\n|\n)*)", file.read_text(), re.M).group(1)
    return re.findall(r'name: "?([\w.-]+)"?', block)


def run(program, task, start, time_limit_s):
    with tempfile.TemporaryDirectory() as folder:
        plan = pathlib.Path(folder) / "plan.tnp"
        statistics_file = pathlib.Path(folder) / "statistics.json"
        command = [program, task, "--start", start, "-o", plan, "--time-limit", str(time_limit_s)]
        command += ["--json", statistics_file]
        began = time.monotonic()
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        seconds = time.monotonic() - began
        return {
            "start": start,
            "seconds": seconds,
            "planned": ended.returncode == 0,
            "parts_s": json.loads(statistics_file.read_text())["time_s"] if statistics_file.exists() else {},
            "said": ended.stderr.strip().splitlines()[-1:] if ended.returncode else [],
        }


def measure(program, name, task, names, repeat, time_limit_s):
    runs = [run(program, task, start, time_limit_s) for start in names for _ in range(repeat)]
    seconds = [one["seconds"] for one in runs]

    def part(*names):
        return statistics.median(sum(one["parts_s"].get(name, 0.0) for name in names) for one in runs)

    planned = {one["start"] for one in runs if one["planned"]}
    memory_mb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(
        f"{name:40s} median {statistics.median(seconds):7.2f} s  worst {max(seconds):7.2f} s"
        f"  guides {part('attractors'):5.2f} s"
        f"  search to corners {part('search', 'certification', 'corners'):5.2f} s"
        f"  {len(planned)} of {len(names)} planned  at most {memory_mb:.0f} MB so far",
        flush=True,
    )
    for one in runs:
        for line in one["said"]:
            print(f"    start {one['start']}: {line}")
    return {"task": name, "runs": runs}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--seed", type=int, action="append", default=[], help="of drawn tasks")
    parser.add_argument("--time-limit", type=float, default=300.0)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    program = arguments.bin / "tenon-plan"
    if not program.exists():
        sys.exit(f"plan_times: {program} is missing: cmake --build --preset release, or --bin")

    def chosen(name):
        return not arguments.names or any(part in name for part in arguments.names)

    results = []
    for name in filter(chosen, SHIPPED):
        file, _, variant = name.partition("#")
        path = TASKS / f"{file}.yaml"
        task = f"{path}#{variant}" if variant else str(path)
        results.append(
            measure(program, name, task, starts(path), arguments.repeat, arguments.time_limit)
        )
    with tempfile.TemporaryDirectory() as folder:
        for seed in arguments.seed:
            drawn = pathlib.Path(folder) / str(seed)
            tool = ROOT / "tests" / "benchmarks" / "drawn_tasks" / "draw_tasks.py"
            subprocess.run([sys.executable, "-B", tool, "--seed", str(seed), "--out", drawn], check=True)
            for file in sorted(drawn.glob("*.yaml")):
                name = f"seed {seed}: {file.stem}"
                if chosen(name):
                    results.append(
                        measure(
                            program, name, str(file), ["1"], arguments.repeat, arguments.time_limit
                        )
                    )
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
