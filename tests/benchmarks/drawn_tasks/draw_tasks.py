#!/usr/bin/env python3
"""Draws assembly tasks such as users bring: no key in them was chosen so that they plan.

  draw_tasks.py --seed S [--count N] --out FOLDER

Writes FOLDER/NN_KIND.yaml, N of them (20), kinds in turn. Equal seeds draw equal tasks. Lengths are in
metres; clearance is 0.7 to 2 mm, the standard deviation of the start 5 to 15 mm along x, y and z. The
tasks have no `search` and no `primitives`, and goals no `uncertainty_m2`: that is what is tested.
Seed 1 is for development; judge by another.
"""

import argparse
import pathlib
import random

PARTICLE_SIGMAS = 3

COMMON = """\
particle_sigmas: 3

speeds: {{approach_mps: 0.10, contact_mps: 0.05}}

contact:
  force_on_N: 9.0
  force_keep_N: 3.0
  force_off_N: 1.5
  debounce_s: 0.006
  force_limit_N: 20.0

compliance:
  axes: [x, y, z]
  mass_kg: 2.0
  damping_Nspm: 1500.0
  stiffness_Npm: 1000.0

physics:
  friction: {{low: 0.1, nominal: 0.3, high: 0.6}}
  contact_stiffness_Npm: 5e4
  oversize_m: {oversize}
"""


def number(value):
    return f"{value:.6g}"


def vector(values):
    return "[" + ", ".join(number(v) for v in values) + "]"


def box(name, low, high):
    """A box between two corners."""
    size = [h - l for l, h in zip(low, high)]
    centre = [(h + l) / 2 for l, h in zip(low, high)]
    return f"  - {{name: {name}, box_m: {vector(size)}, pose: {{position_m: {vector(centre)}}}}}\n"


def plate_with_pocket(outer, pocket, top, prefix=""):
    """Four boxes around a pocket; outer and pocket are (x_low, x_high, y_low, y_high)."""
    ox0, ox1, oy0, oy1 = outer
    px0, px1, py0, py1 = pocket
    return (
        box(prefix + "left", (ox0, oy0, 0.0), (px0, oy1, top))
        + box(prefix + "right", (px1, oy0, 0.0), (ox1, oy1, top))
        + box(prefix + "front", (px0, oy0, 0.0), (px1, py0, top))
        + box(prefix + "back", (px0, py1, 0.0), (px1, oy1, top))
    )


class Draw:
    """One task: a part with its tip's frame at (0, 0, 0), the goal's place, and all around it."""

    def __init__(self, rng):
        self.rng = rng
        self.sigma = rng.uniform(0.005, 0.015)
        self.clearance = rng.uniform(0.0007, 0.002)
        self.peg = [rng.uniform(0.03, 0.06), rng.uniform(0.03, 0.06), rng.uniform(0.08, 0.16)]
        self.environment = ""
        self.depth = rng.uniform(0.03, 0.06)  # of the pocket
        self.above_bottom = rng.uniform(0.004, 0.010)

    def outline(self, pocket):
        """Outer sides of a plate around a pocket."""
        rng = self.rng
        return (
            pocket[0] - rng.uniform(0.05, 0.10),
            pocket[1] + rng.uniform(0.05, 0.10),
            pocket[2] - rng.uniform(0.05, 0.10),
            pocket[3] + rng.uniform(0.05, 0.10),
        )

    def pocket(self):
        x = 0.5 * (self.peg[0] + self.clearance)
        y = 0.5 * (self.peg[1] + self.clearance)
        return (-x, x, -y, y)

    def square_pocket(self):
        self.peg[1] = self.peg[0]
        return self.rectangular_pocket()

    def rectangular_pocket(self):
        pocket = self.pocket()
        outer = self.outline(pocket)
        self.environment += plate_with_pocket(outer, pocket, self.depth)
        self.environment += box("bottom", (outer[0], outer[2], -0.02), (outer[1], outer[3], 0.0))

    def tray(self):
        """A box onto a spot of a walled tray."""
        self.peg[2] = self.rng.uniform(0.04, 0.10)
        half = [self.rng.uniform(0.15, 0.25), self.rng.uniform(0.15, 0.25)]
        wall = self.rng.uniform(0.03, 0.06)
        spot = [self.rng.uniform(-0.3, 0.3) * h for h in half]
        inner = (-half[0] - spot[0], half[0] - spot[0], -half[1] - spot[1], half[1] - spot[1])
        outer = (inner[0] - 0.03, inner[1] + 0.03, inner[2] - 0.03, inner[3] + 0.03)
        self.environment += plate_with_pocket(outer, inner, wall)
        self.environment += box("bottom", (outer[0], outer[2], -0.02), (outer[1], outer[3], 0.0))
        self.above_bottom = 0.001
        self.depth = wall

    def fixture(self):
        """A box into the corner of two walls on a base, a clearance off each."""
        self.peg[2] = self.rng.uniform(0.04, 0.10)
        x = -0.5 * self.peg[0] - 0.5 * self.clearance
        y = -0.5 * self.peg[1] - 0.5 * self.clearance
        long_x, long_y = self.rng.uniform(0.12, 0.25), self.rng.uniform(0.12, 0.25)
        wall = self.rng.uniform(0.03, 0.06)
        self.environment += box("wall_x", (x - 0.03, y - 0.03, 0.0), (x, y + long_y, wall))
        self.environment += box("wall_y", (x, y - 0.03, 0.0), (x + long_x, y, wall))
        self.environment += box("base", (x - 0.03, y - 0.03, -0.02), (x + long_x, y + long_y, 0.0))
        self.above_bottom = 0.001
        self.depth = wall

    def stepped_hole(self):
        """A wider pocket over the one that fits."""
        pocket = self.pocket()
        step = self.rng.uniform(0.004, 0.010)
        wide = (pocket[0] - step, pocket[1] + step, pocket[2] - step, pocket[3] + step)
        outer = self.outline(wide)
        lower = 0.5 * self.depth
        self.environment += plate_with_pocket(outer, pocket, lower, "lower_")
        upper = plate_with_pocket(outer, wide, self.depth - lower, "upper_")
        self.environment += raised(upper, lower)
        self.environment += box("bottom", (outer[0], outer[2], -0.02), (outer[1], outer[3], 0.0))

    def off_centre_slot(self):
        """A slot far from the middle of its plate, long in y: a wall stands across it at the goal."""
        x0, x1, y0, _ = self.pocket()
        length = self.rng.uniform(1.5, 2.5) * self.peg[1]
        slot = (x0, x1, y0, y0 + length)
        outer = self.outline(slot)
        far = self.rng.uniform(0.08, 0.15)
        outer = (outer[0] - far, outer[1], outer[2], outer[3] + far)
        self.environment += plate_with_pocket(outer, slot, self.depth)
        self.environment += box("bottom", (outer[0], outer[2], -0.02), (outer[1], outer[3], 0.0))

    def yaml(self, name):
        kind = getattr(self, name.split("_", 1)[1])
        kind()
        high = self.depth + PARTICLE_SIGMAS * self.sigma + self.rng.uniform(0.03, 0.06)
        start = [self.rng.uniform(-0.05, 0.05), self.rng.uniform(-0.05, 0.05), high]
        goal = [0.0, 0.0, self.above_bottom]
        tip = [self.peg[0] + self.clearance, self.peg[1] + self.clearance, 0.02]
        text = f"# Drawn by draw_tasks.py.\nname: {name}\ncoordinates: [x, y, z]\n\nheld:\n"
        half = [0.5 * self.peg[0], 0.5 * self.peg[1]]
        text += box("part", (-half[0], -half[1], 0.0), (half[0], half[1], self.peg[2]))
        text += "\nenvironment:\n" + self.environment
        text += "\nstarts:\n"
        text += f'  - {{name: "1", pose: {{position_m: {vector(start)}}}, '
        text += f"sigma_m: {vector([self.sigma] * 3)}}}\n"
        text += f"\ngoal:\n  pose: {{position_m: {vector(goal)}}}\n  tolerance_m: 2e-3\n"
        text += f"  inserted: {{box_m: {vector(tip)}, pose: {{position_m: {vector(goal)}}}}}\n\n"
        return text + COMMON.format(oversize=number(0.25 * self.clearance))


def raised(boxes, height):
    """The same boxes, higher."""
    lines = []
    for line in boxes.splitlines():
        head, _, place = line.rpartition("position_m: [")
        x, y, z = (float(v) for v in place.split("]")[0].split(","))
        lines.append(f"{head}position_m: {vector([x, y, z + height])}}}}}")
    return "\n".join(lines) + "\n"


KINDS = [
    "square_pocket",
    "rectangular_pocket",
    "tray",
    "fixture",
    "stepped_hole",
    "off_centre_slot",
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for i in range(arguments.count):
        name = f"{i + 1:02d}_{KINDS[i % len(KINDS)]}"
        draw = Draw(random.Random(f"{arguments.seed} {i}"))
        (arguments.out / f"{name}.yaml").write_text(draw.yaml(name))


if __name__ == "__main__":
    main()
