#!/usr/bin/env python3
"""The documents' pictures, as the programs draw them of the how-to's own task and of the demo's: made again, and held
against those in the tree, whose numbers may differ by rounding.

  pictures.py BIN SOURCE PLANS [--write]     --write: puts them into the tree

PLANS: the folder of the plans that the tests share.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

HOWTO = "planner/FIRST_TASK.md"
# What is beside a label in a document: the document, the page that it is taken from, and the title that it has there.
PICTURES = {
    "planner/pictures/pocket_above.svg": (HOWTO, "pocket.html", "Start above, Seen from above"),
    "planner/pictures/pocket_side.svg": (HOWTO, "pocket.html", "Start above, Seen from the side, along y"),
    "planner/pictures/pocket_plan.svg": (HOWTO, "plan.html", "The plan, Seen from the side, along y"),
    "planner/pictures/pocket_uncertainty.svg": (HOWTO, "plan.html", "Uncertainty after each step"),
    "planner/pictures/connector_plan.svg": ("README.md", "connector.html", "The plan, Seen from the side, along y"),
}
BYTES_MAX = 20_000
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
WITHIN = 0.05  # mm, or of the chart's units


def make_pages(binaries, source, plans, folder):
    """By the commands of the how-to; the demo's page of the plan that the build has made for it."""
    text = (source / HOWTO).read_text()
    (folder / "hw").symlink_to(source / "hw")
    (folder / "pocket.yaml").write_text(re.search(r"^```yaml\n(.*?)^```$", text, re.M | re.S)[1])
    for line in re.search(r"(?s)^```sh\n(tenon-plan --check.*?)^```$.*?^```sh\n(tenon-plan pocket.*?)^```$", text,
                          re.M).groups():
        for command in line.strip().splitlines():
            program, *words = command.split()
            subprocess.run([binaries / program, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([binaries / "tenon-inspect", plans / "connector_csp6_bench.tnp", "--task",
                    source / "planner/tasks/connector.yaml", "--cell", source / "hw/cells/csp6_bench.yaml",
                    "--report", folder / "connector.html"], check=True, stdout=subprocess.DEVNULL)


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


def main():
    binaries, source, plans = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    failed = 0
    with tempfile.TemporaryDirectory(prefix="tenon_pictures_") as name:
        folder = pathlib.Path(name)
        make_pages(binaries, source, plans, folder)
        for file, (document, page, title) in PICTURES.items():
            made = picture((folder / page).read_text(), title)
            kept = source / file
            if "--write" in sys.argv:
                kept.write_text(made)
            good = kept.exists() and same(made, kept.read_text()) and len(made) < BYTES_MAX
            link = re.escape(str(kept.relative_to((source / document).parent)))
            shown = re.search(rf"!\[[^\]]+\]\({link}\)", (source / document).read_text())
            failed += not (good and shown)
            print(f"{'' if good and shown else 'FAILED: '}{file}: {len(made)} bytes, "
                  f"{'as the programs draw it' if good else 'is another one, or too large'}"
                  f"{'' if shown else f'; not in {document}'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
