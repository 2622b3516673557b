"""Plans a task and has the virtual arm execute the plan, each once: what is there already is read."""

import argparse
import json
import pathlib
import resource
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def options(description):
    """The parser of what every such study is told; it may be told more."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, required=True, help="of the runs, and of the tasks if they are drawn")
    parser.add_argument("--runs", type=int, default=200, help="of a plan in a world")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--time-limit", type=float, default=300.0, help="of planning, s")
    parser.add_argument("--only", default="", help="tasks with this in their name")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    return parser


def parsed(parser):
    """Leaves with a line where there is nothing to plan with; makes the folder of results."""
    arguments = parser.parse_args()
    if not (arguments.bin / "tenon-plan").exists():
        sys.exit(f"{arguments.bin} holds no tenon-plan: build the preset release, or --bin")
    arguments.out.mkdir(parents=True, exist_ok=True)
    return arguments


def plan(program, task, cell, stem, threads, time_limit_s, extra=()):
    """Leaves STEM.tnp, STEM.stats.json and STEM.planned.json; returns what the last one holds.

    Keys: planned, seconds (of the clock), core_seconds, said (the reason, where there is no plan).
    """
    note = stem.with_name(stem.name + ".planned.json")
    if note.exists():
        return json.loads(note.read_text())
    command = [program, task, "--cell", cell, "-o", f"{stem}.tnp", "--json", f"{stem}.stats.json"]
    command += ["--threads", threads, "--time-limit", time_limit_s, *extra]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    ended = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if ended.returncode not in (0, 1):
        sys.exit(f"{task}: tenon-plan ended with {ended.returncode}: {ended.stderr}")
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


def evaluate(program, task, cell, world, plan_file, results, runs, seed, threads, extra=()):
    """The one entry of tenon-evaluate's plans[]; tenon-evaluate itself goes on where it was stopped."""
    known = json.loads(results.read_text())["plans"][0] if results.exists() else None
    if known is None or known["summary"]["success"]["runs"] < runs:
        command = [program, "--cell", cell, "--task", task, "--plan", plan_file, "--experiment", world]
        command += ["-n", runs, "--seed", seed, "--threads", threads, "--json", results, *extra]
        subprocess.run([str(part) for part in command], stdout=subprocess.DEVNULL, check=True)
        known = json.loads(results.read_text())["plans"][0]
    return known


def print_failures(known, indent="    "):
    for group in known["failures"]:
        print(
            f"{indent}{group['runs']} {group['class']} with {group['outcome']}, first run"
            f" {group['first_run']}: {group['first_reason']}"
        )
