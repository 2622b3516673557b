#!/usr/bin/env python3
"""tenon-evaluate's page in headless Chromium: on a screen and a phone, light and dark, with WebGL and without; its
filters, and a failed run replayed to its end.

  evaluation_page.py TENON_EVALUATE SOURCE PLANS [--pictures FOLDER]

@param PLANS the folder of the plans that the tests share  @param FOLDER for a picture of each page
"""
import argparse
import collections
import json
import pathlib
import subprocess
import tempfile

from browser import Browser, run_test
from on_paper import print_page
from plan_page import BYTES_MAX, ROOT, SMALL, look_at, press, stay_as_high
from rise import fall_back, stay_put, tick_by_key

# Worlds in which some runs of a plan fail, in several ways, and those in which none begins.
EXPERIMENTS = {"harsh": "name: harsh\nfriction: [0.1, 0.6]\nforce_drift_N_sqrts: [0.0, 1.2]\n",
               "hopeless": "name: hopeless\nforce_drift_N_sqrts: [9.0, 9.5]\n"}
# (name, plans, task, cell, experiment, runs, seed)
EVALUATIONS = [
    ("box", ["box_1_gantry3"], "box_on_table_2d", "gantry3", "harsh", 16, 5),
    ("pegs", ["peg_2d_fine"], "peg_in_hole_2d_fine", "gantry3_peg", "harsh", 6, 1),
    ("two", ["box_1_gantry3", "box_4_gantry3"], "box_on_table_2d", "gantry3", "harsh", 4, 2),
    ("none", ["box_1_gantry3"], "box_on_table_2d", "gantry3", "hopeless", 2, 1),
]


def evaluate(arguments, folder, name, plans, task, cell, experiment, runs, seed):
    """@return the page and the JSON"""
    page, results = folder / f"{name}.html", folder / f"{name}.json"
    command = [arguments.evaluate, "--cell", f"{arguments.source}/hw/cells/{cell}.yaml", "--task",
               f"{arguments.source}/planner/tasks/{task}.yaml", "--experiment", folder / f"{experiment}.yaml", "-n",
               str(runs), "--seed", str(seed), "--report", page, "--json", results]
    for plan in plans:
        command += ["--plan", f"{arguments.plans}/{plan}.tnp"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return page, json.loads(results.read_text())


def filter_runs(browser, name, results, failures):
    """Every filter alone takes its own runs away, by the count of the JSON, and brings them back."""
    runs = [run for run in results["plans"][0]["runs"] if run["path"]]
    counts = collections.Counter(
        {"succeeded": "at the goal", "done_but_wrong": "done but wrong"}.get(run["class"], "stopped: " + run["ending"])
        for run in runs)
    shown = lambda: int(browser.evaluate(f"{ROOT}.shown"))
    failures.check(shown() == len(runs), f"{name}: {shown()} of {len(runs)} paths at first")
    for outcome, count in counts.items():
        click = ("[...document.querySelectorAll('.filters .filter')].filter(b => !b.hidden && "
                 f"b.querySelector('span').textContent === '{outcome}').map(b => b.click()).length")
        clicked = browser.evaluate(click)
        failures.check(clicked == 1, f"{name}: {clicked} filters '{outcome}'")
        failures.check(shown() == len(runs) - count, f"{name}: {shown()} paths without the {count} '{outcome}'")
        browser.evaluate(click)
        failures.check(shown() == len(runs), f"{name}: {shown()} paths with '{outcome}' again")


def choose(browser, name, results, failures):
    """Another plan shows its own runs."""
    for number, plan in enumerate(results["plans"]):
        browser.evaluate("(() => { const s = document.querySelector('.filters select');"
                         f" s.value = '{number}'; s.dispatchEvent(new Event('change')); }})()")
        wanted = sum(len(run["path"]) > 0 for run in plan["runs"])
        shown = int(browser.evaluate(f"{ROOT}.shown"))
        failures.check(shown == wanted, f"{name}: {shown} paths of plan {number}, not {wanted}")
        heading = browser.evaluate("document.querySelector('.filters').textContent")
        failures.check(f"{shown} of {shown}" in heading, f"{name}: says '{heading}'")
    failures.check(not browser.said(), f"{name}: says something")


def lit(browser):
    """How many coloured line pieces the flat scene draws of runs."""
    return browser.evaluate("[...document.querySelectorAll('.canvas svg > g:first-of-type path')]"
                            ".map(p => p.getAttribute('d').split('M').length - 1).reduce((a, b) => a + b, 0)")


def replay(browser, name, results, failures):
    """A click on a failed run's button plays it to its end, where the page says what the JSON says."""
    run = next(run for run in results["plans"][0]["runs"] if run["class"] != "succeeded" and run["step"] >= 0)
    data = json.loads(browser.evaluate("document.getElementById('page-data').textContent"))
    goal = data["goal"]
    # From the first moment on: no sensor reads exactly nothing, when no move runs either.
    for recording in data["plans"][0]["recordings"]:
        unfelt = sum(not any(wrench) for wrench in list(zip(*recording["wrench"]))[1:])
        failures.check(unfelt == 0, f"{name}: run {recording['run']} feels nothing in {unfelt} moments")
    browser.evaluate("(() => { const s = document.querySelector('.controls select'); s.value = '4';"
                     " s.dispatchEvent(new Event('change')); })()")
    # At once, for it plays.
    clicked, shown, step = browser.evaluate(
        f"(() => {{ const n = [...document.querySelectorAll('td button.jump[data-run=\"{run['run']}\"]')]"
        f".map(b => b.click()).length; return [n, {ROOT}.run, {ROOT}.step]; }})()")
    failures.check(clicked == 1, f"{name}: {clicked} buttons for run {run['run']}")
    failures.check(shown == str(run["run"]), f"{name}: another run is shown")
    failures.check(step == "0", f"{name}: does not begin with step 0")
    browser.wait_for(f"{ROOT}.playing === 'false' && {ROOT}.step === 'end'")
    tool = json.loads(browser.evaluate(f"{ROOT}.tool"))
    error = [run["error"][axis] for axis in ("x_m", "y_m", "z_m")]
    off = max(abs(t - g - e) for t, g, e in zip(tool, goal, error))
    failures.check(off < 3e-5, f"{name}: ends {1e3 * off:.3f} mm from where run {run['run']} ended")
    heading = browser.evaluate("document.querySelector('.now h2').textContent")
    failures.check(f"Run {run['run']}," in heading, f"{name}: ends with '{heading}'")
    words = browser.evaluate("document.querySelector('.words').textContent")
    failures.check(run["reason"] in words, f"{name}: ends with '{words}', not with '{run['reason']}'")
    chart = browser.evaluate("document.querySelector('svg.forces').getAttribute('aria-label')")
    failures.check(f"Run {run['run']}:" in chart and " N" in chart, f"{name}: the chart is '{chart}'")
    for key, step in (("Home", "0"), ("End", "end")):
        press(browser, key)
        found = browser.evaluate(f"{ROOT}.step")
        failures.check(found == step, f"{name}: key {key} leads to step {found}, not {step}")
    failures.check(not browser.said(), f"{name}: says something while it plays")


# Of each picture that has ways of runs, those that leave its frame.
CUT_OFF = """[...document.querySelectorAll('.plots .still svg[role=img]')].map(svg => {
  const frame = svg.querySelector('.frame').getBBox();
  return [...svg.querySelectorAll('[stroke-opacity]')].map(e => e.getBBox()).filter(b =>
    b.x < frame.x - 1 || b.y < frame.y - 1 || b.x + b.width > frame.x + frame.width + 1
    || b.y + b.height > frame.y + frame.height + 1).length; })"""


def on_paper(browser, page, failures, pictures):
    """Tables fit, and no way of a run is cut off."""
    print_page(browser, page, failures, pictures)
    cut = browser.evaluate(CUT_OFF)
    failures.check(cut and not any(cut), f"{page.stem}: its pictures cut off {cut} ways")


def main(failures):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("evaluate")
    parser.add_argument("source")
    parser.add_argument("plans")
    parser.add_argument("--pictures", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tenon_pages_") as name:
        folder = pathlib.Path(name)
        for experiment, text in EXPERIMENTS.items():
            (folder / f"{experiment}.yaml").write_text(text)
        made = [evaluate(arguments, folder, *evaluation) for evaluation in EVALUATIONS]
        for page, _ in made:
            size = page.stat().st_size
            print(f"{page.name}: {size} bytes")
            failures.check(size < BYTES_MAX, f"{page.name}: {size} bytes, more than {BYTES_MAX}")
        for webgl in (True, False):
            with Browser(webgl) as browser:
                for page, _ in made:
                    look_at(browser, page, "", webgl, failures, arguments.pictures)
                page, results = made[0]
                browser.open(page, width=SMALL)
                browser.wait_for(f"{ROOT}.ready === 'true'")
                before = lit(browser)
                filter_runs(browser, f"{page.stem} {webgl}", results, failures)
                browser.evaluate("document.querySelector('.filters .filter').click()")
                left = lit(browser)
                failures.check(webgl or left < before, f"{page.stem}: a filter leaves {left} of {before}")
                replay(browser, f"{page.stem} {webgl}", results, failures)
                stay_put(browser, page, failures, webgl)
                if webgl:
                    fall_back(browser, page, failures)
                    continue  # words and numbers are the same
                tick_by_key(browser, page, failures)
                stay_as_high(browser, page, failures)
                browser.open(page, fragment="#step=1.5")
                browser.wait_for(f"{ROOT}.ready === 'true'")
                failures.check(browser.evaluate(f"{ROOT}.step") == "1", f"{page.stem}: does not open at #step=1.5")
                browser.open(made[2][0])
                browser.wait_for(f"{ROOT}.ready === 'true'")
                choose(browser, f"two {webgl}", made[2][1], failures)
                for page, _ in made:
                    on_paper(browser, page, failures, arguments.pictures)
                browser.open(made[3][0])
                browser.wait_for(f"{ROOT}.ready === 'true'")
                press(browser, " ")
                failures.check(browser.evaluate(f"{ROOT}.run") == "" and browser.evaluate(f"{ROOT}.shown") == "2",
                               "none: replays what never began")
                failures.check(not browser.said(), "none: says something")
    return f"{len(made)} pages"


if __name__ == "__main__":
    run_test(main)
