#!/usr/bin/env python3
"""The documents' pictures, as the programs draw them of the how-tos' own tasks and of the demo's, and as drawn.py draws
what they say: made again, and held against those in the tree, whose numbers may differ by rounding.

  pictures.py BIN SOURCE PLANS [--write]     --write: puts them into the tree

PLANS: the folder of the plans that the tests share.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import yaml

import drawn

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from how_to import BLOCK, FILES, save  # pylint: disable=wrong-import-position

FIRST, ARM, CI, THINKS = "planner/FIRST_TASK.md", "hw/YOUR_ARM.md", "sim/CI.md", "planner/HOW_IT_PLANS.md"
WATCH, HOUSE = "executor/WATCH.md", "shared/ARCHITECTURE.md"
FROM_ABOVE, FROM_THE_SIDE = "The plan, Seen from above", "The plan, Seen from the side, along y"
# What is beside a label in a document: the document, the page that it is taken from, and the title that it has there.
PICTURES = {
    "planner/pictures/pocket_above.svg": (FIRST, "pocket.html", "Start above, Seen from above"),
    "planner/pictures/pocket_side.svg": (FIRST, "pocket.html", "Start above, Seen from the side, along y"),
    "planner/pictures/pocket_plan.svg": (FIRST, "plan.html", FROM_THE_SIDE),
    "planner/pictures/pocket_uncertainty.svg": (FIRST, "plan.html", "Uncertainty after each step"),
    "planner/pictures/connector_plan.svg": ("README.md", "connector.html", FROM_THE_SIDE),
    "planner/pictures/box_plan.svg": (THINKS, "why.html", FROM_ABOVE),
    "planner/pictures/box_uncertainty.svg": (THINKS, "why.html", "Uncertainty after each step"),
}
# The same of figures that are files already.
FIGURES = {
    "sim/pictures/pocket_runs.svg": (CI, "figures/pocket_runs_xz.svg"),
    "sim/pictures/nominal_runs.svg": (CI, "figures/nominal_runs_xz.svg"),
}
BELIEFS = [(0, "at the start"), (2, "after two steps along x"), (4, "after two along y"), (7, "at the end")]
# And of what drawn.py makes of what programs have left in a folder.
DRAWN = {
    "planner/pictures/box_beliefs.svg": (THINKS, lambda folder, _: drawn.beliefs(
        (folder / "why.html").read_text(), BELIEFS, (130, 550, -450, 0))),
    "planner/pictures/box_course.svg": (THINKS, lambda folder, _: drawn.course(
        json.loads((folder / "statistics.json").read_text()))),
    "hw/pictures/my_arm.svg": (ARM, lambda folder, _: drawn.arm_frames(
        (folder / "mine.html").read_text(), json.loads((folder / "dry_run.json").read_text()),
        yaml.safe_load((folder / "my_arm/cell.yaml").read_text()))),
    "executor/pictures/monitor.svg": (WATCH, lambda folder, _: drawn.screen(
        ["tenon-monitor", "--lcm-url", "file://run.lcmlog"], folder, 96, 29, r"step 2 \(3 of 7\)")),
    "shared/pictures/house.svg": (HOUSE, lambda _, source: drawn.house((source / ".cmake/Tenon.cmake").read_text())),
    "shared/pictures/may_use.svg": (HOUSE, lambda _, source: drawn.matrix((source / ".cmake/Tenon.cmake").read_text())),
}
# The commands that leave it there, by how their blocks begin.
TYPED = [(FIRST, "tenon-plan --check"), (FIRST, "tenon-plan pocket"), (ARM, "tenon-plan --check"),
         (CI, "tenon-evaluate .* -n 40"), (CI, "tenon-plan pocket"), (THINKS, "tenon-plan planner/tasks")]
BYTES_MAX = 30_000
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
WITHIN = 0.05  # mm, or of the chart's units
CYCLES = 1600  # of the run that the monitor is shown: 0.1 s of step 2


def make_pages(binaries, source, plans, folder):
    """By the commands of the how-tos; the demo's page of the plan that the build has made for it, and a log of a run of
    the READMEs' plan in virtual time."""
    for room in ("hw", "planner"):
        (folder / room).symlink_to(source / room)
    texts = {howto: BLOCK.findall((source / howto).read_text()) for howto, _ in TYPED}
    for kind, text in sum(texts.values(), []):
        if kind in FILES:
            save(text, folder)
    shutil.copy(source / "hw/robots/gantry3/gantry3.urdf", folder / "my_arm/arm.urdf")
    for howto, begins in TYPED:
        text = next(text for kind, text in texts[howto] if kind == "sh" and re.match(begins, text.replace("\\\n", "")))
        subprocess.run(["bash", "-ec", text], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    subprocess.run(["tenon-inspect", plans / "connector_csp6_bench.tnp", "--task", "planner/tasks/connector.yaml", "--cell",
                    "hw/cells/csp6_bench.yaml", "--report", "connector.html"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run([binaries / "page_runs", folder], check=True, stdout=subprocess.DEVNULL)
    (folder / "run.lcmlog").write_bytes(drawn.log_until((folder / "box.lcmlog").read_bytes(), CYCLES))


def picture(page, title):
    """A file of its own. The tracks of 200 random starts are left out: a picture is to be small."""
    for svg in re.findall(r"<svg.*?</svg>", page.partition("<script")[0], re.S):
        if f"<title>{title}</title>" in svg or f"aria-label='{title}'" in svg:
            svg = re.sub(r"<(?:polyline|circle)[^>]*'#000'[^>]*/>\n?", "", svg)
            white = "style='background:#fff' font-family='sans-serif'"
            return svg.replace("<svg ", f"<svg xmlns='http://www.w3.org/2000/svg' {white} ", 1) + "\n"
    raise SystemExit(f"FAILED: no picture '{title}'")


def same(one, other):
    numbers, others = NUMBER.findall(one), NUMBER.findall(other)
    return NUMBER.sub("#", one) == NUMBER.sub("#", other) and all(
        abs(float(a) - float(b)) <= WITHIN for a, b in zip(numbers, others))


def made(folder, source):
    """Yields each picture's file, document and text."""
    for file, (document, page, title) in PICTURES.items():
        yield file, document, picture((folder / page).read_text(), title)
    for file, (document, figure) in FIGURES.items():
        yield file, document, (folder / figure).read_text()
    for file, (document, draw) in DRAWN.items():
        yield file, document, draw(folder, source)


def main():
    binaries, source, plans = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    os.environ["PATH"] = f"{binaries}:{os.environ['PATH']}"
    failed = 0
    with tempfile.TemporaryDirectory(prefix="tenon_pictures_") as name:
        folder = pathlib.Path(name)
        make_pages(binaries, source, plans, folder)
        for file, document, text in made(folder, source):
            kept = source / file
            if "--write" in sys.argv:
                kept.parent.mkdir(exist_ok=True)
                kept.write_text(text)
            good = kept.exists() and same(text, kept.read_text()) and len(text) < BYTES_MAX
            link = re.escape(str(kept.relative_to((source / document).parent)))
            shown = re.search(rf"!\[[^\]]+\]\({link}\)", (source / document).read_text())
            failed += not (good and shown)
            print(f"{'' if good and shown else 'FAILED: '}{file}: {len(text)} bytes, "
                  f"{'as the programs draw it' if good else 'is another one, or too large'}"
                  f"{'' if shown else f'; not in {document}'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
