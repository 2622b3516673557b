#!/usr/bin/env python3
"""How planning time grows: a drawn square pocket, one quantity of which is varied at a time.

  plan_growth.py [--bin FOLDER] [--seed S] [--repeat N] [--threads N] [clearance|bodies|particles]...

clearance  between peg and pocket, 4 to 0.2 mm
bodies     the plate's walls cut into layers: 5 to 101 bodies of the same outline
particles  uncertain coordinates: x z (4 particles), x y z (6), and all six of keyed_peg.yaml (12, and 64 corners)

A line for each value: seconds of the clock (median and worst of N runs), seconds of a core, simulated moves,
expansions, refuted paths, largest resident memory. Nothing is asserted.
"""

import argparse
import json
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import time

from plan_times import ROOT, TASKS

sys.path.insert(0, str(pathlib.Path(__file__).parent / "drawn_tasks"))
import draw_tasks  # noqa: E402

CLEARANCES_MM = [4.0, 2.0, 1.0, 0.5, 0.2]
LAYERS = [1, 4, 8, 16, 25]


class Pocket(draw_tasks.Draw):
    """The square pocket of a seed, whatever else is changed."""

    def __init__(self, seed, clearance_mm=1.0, layers=1):
        super().__init__(random.Random(f"growth {seed}"))
        self.clearance = 1e-3 * clearance_mm
        self.layers = layers

    def square_pocket(self):
        self.peg[1] = self.peg[0]
        pocket = self.pocket()
        outer = self.outline(pocket)
        thick = self.depth / self.layers
        for i in range(self.layers):
            layer = draw_tasks.plate_with_pocket(outer, pocket, thick, f"layer_{i}_")
            self.environment += draw_tasks.raised(layer, i * thick)
        self.environment += draw_tasks.box(
            "bottom", (outer[0], outer[2], -0.02), (outer[1], outer[3], 0.0)
        )

    def text(self):
        return self.yaml("00_square_pocket")


def in_the_plane(text):
    """Without y: the start above the pocket's middle."""
    lines = []
    for line in text.splitlines():
        if line.startswith("coordinates:"):
            line = "coordinates: [x, z]"
        elif line.startswith("  axes: [x, y, z]"):
            line = "  axes: [x, z]"
        elif "sigma_m:" in line:
            head, _, rest = line.partition("position_m: [")
            place, _, rest = rest.partition("]")
            x, _, z = place.split(",")
            sigma = rest.partition("sigma_m: [")[2].partition(",")[0]
            line = f"{head}position_m: [{x}, 0, {z}]}}, sigma_m: [{sigma}, {sigma}]}}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def run(program, task, threads, folder, extra):
    statistics_file = folder / "stats.json"
    statistics_file.unlink(missing_ok=True)
    command = [program, task, "-o", folder / "plan.tnp", "--json", statistics_file]
    command += ["--threads", threads, "--time-limit", 300, *extra]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    ended = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    seconds = time.monotonic() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if not statistics_file.exists():
        sys.exit(f"plan_growth: {ended.stderr}")
    return {
        "planned": ended.returncode == 0,
        "seconds": seconds,
        "core_seconds": after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime,
        "memory_mb": after.ru_maxrss / 1024,
        "statistics": json.loads(statistics_file.read_text()),
    }


def measure(name, task, arguments, folder, extra=()):
    program = arguments.bin / "tenon-plan"
    runs = [run(program, task, arguments.threads, folder, extra) for _ in range(arguments.repeat)]
    seconds = [one["seconds"] for one in runs]
    told = runs[-1]["statistics"]
    moves = sum(m if isinstance(m, int) else m["simulated"] for m in told["moves"].values())
    print(
        f"{name:24s} median {statistics.median(seconds):6.2f} s  worst {max(seconds):6.2f} s"
        f"  {statistics.median(one['core_seconds'] for one in runs):6.2f} s of a core"
        f"  {moves:7d} moves  {told['expansions']:5d} expansions  {len(told['refusals']):3d} refuted"
        f"  at most {max(one['memory_mb'] for one in runs):.0f} MB so far"
        f"{'' if runs[-1]['planned'] else '  NO PLAN'}",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("what", nargs="*", default=["clearance", "bodies", "particles"])
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        task = folder / "00_square_pocket.yaml"
        if "clearance" in arguments.what:
            for clearance_mm in CLEARANCES_MM:
                task.write_text(Pocket(arguments.seed, clearance_mm=clearance_mm).text())
                measure(f"clearance {clearance_mm:g} mm", task, arguments, folder)
        if "bodies" in arguments.what:
            for layers in LAYERS:
                task.write_text(Pocket(arguments.seed, layers=layers).text())
                measure(f"{4 * layers + 1} bodies", task, arguments, folder)
        if "particles" in arguments.what:
            task.write_text(in_the_plane(Pocket(arguments.seed).text()))
            measure("4 particles", task, arguments, folder)
            task.write_text(Pocket(arguments.seed).text())
            measure("6 particles", task, arguments, folder)
            bench = ROOT / "hw" / "cells" / "csp6_bench.yaml"
            keyed = TASKS / "keyed_peg.yaml"
            measure("12 and 64 particles", keyed, arguments, folder, ["--cell", bench])


if __name__ == "__main__":
    main()
