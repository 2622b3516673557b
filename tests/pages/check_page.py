#!/usr/bin/env python3
"""The page of tenon-plan --check in headless Chromium: on a screen and a phone, light and dark.

  check_page.py TENON_PLAN SOURCE [--pictures FOLDER]

@param FOLDER for a picture of each page
"""
import argparse
import pathlib
import subprocess
import tempfile

from browser import Browser, run_test
from on_paper import print_page

# (task, change, pictures: one for each start and view, parts that stand in something, finding)
TASKS = [
    ("box_on_table_2d", None, 12, 0, "Nothing stands against planning it"),
    ("peg_in_hole_3d", None, 2, 0, "Nothing stands against planning it"),
    ("peg_in_hole_tilt", None, 1, 0, "Nothing stands against planning it"),
    # The part's lower end is inside of the block.
    ("peg_in_hole_tilt", ("position_m: [-0.10, 0.0, 0.18]", "position_m: [-0.10, 0.0, 0.06]"), 1, 1, "is in collision"),
    # The goal is in the block's wall.
    ("peg_in_hole_tilt", ("pose: {position_m: [0.0, 0.0, 0.010]}\n  tol", "pose: {position_m: [0.02, 0.0, 0.010]}\n  tol"),
     1, 1, "is in collision"),
]


def write_page(arguments, folder, number, task, change):
    source = pathlib.Path(arguments.source) / "planner/tasks" / f"{task}.yaml"
    text = source.read_text()
    if change:
        if change[0] not in text:
            raise SystemExit(f"FAILED: {task} has no {change[0]}")
        text = text.replace(*change)
    file = folder / f"{task}_{number}.yaml"
    file.write_text(text)
    page = file.with_suffix(".html")
    ended = subprocess.run([arguments.plan, "--check", str(file), "--report", str(page)], stdout=subprocess.DEVNULL)
    return page, ended.returncode


def look(browser, page, expected, failures, pictures):
    figures, red, finding = expected
    for width in (1400, 390):
        for dark in (False, True):
            name = f"{page.stem}_{width}_{'dark' if dark else 'light'}"
            browser.open(page, width=width, dark=dark)
            wide = browser.evaluate("document.documentElement.scrollWidth")
            failures.check(wide <= width, f"{name}: {wide} px wide")
            found = browser.evaluate("document.querySelectorAll('figure svg[role=img] > title').length")
            failures.check(found == figures, f"{name}: {found} pictures, not {figures}")
            found = browser.evaluate("document.querySelectorAll('svg [fill=\"#770022\"]').length")
            failures.check(found == red, f"{name}: {found} parts in red, not {red}")
            empty = browser.evaluate("[...document.querySelectorAll('table')].filter(t => !t.querySelector('tbody tr'))"
                                     ".map(t => t.closest('section').textContent)")
            failures.check(not empty, f"{name}: tables without rows: {empty}")
            first = browser.evaluate("document.querySelector('.badges li').textContent")
            failures.check(finding in first, f"{name}: says first '{first}'")
            for said in browser.said():
                failures.check(False, f"{name}: says {said}")
            for url in browser.requests():
                failures.check(False, f"{name}: asks for {url}")
            if pictures:
                browser.picture(pictures / f"{name}.png")


def main(failures):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plan")
    parser.add_argument("source")
    parser.add_argument("--pictures", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tenon_pages_") as folder, Browser(webgl=False) as browser:
        for number, (task, change, *expected) in enumerate(TASKS):
            page, status = write_page(arguments, pathlib.Path(folder), number, task, change)
            failures.check(status == (2 if change else 0), f"{task}: exit status {status}")
            look(browser, page, expected, failures, arguments.pictures)
            print_page(browser, page, failures, arguments.pictures)
    return f"{len(TASKS)} pages"


if __name__ == "__main__":
    run_test(main)
