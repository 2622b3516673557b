#!/usr/bin/env python3
"""The page of a run laid over its plan in headless Chromium: on a screen and a phone, light and dark, with WebGL and
without; a run that is done, one that a fault ends, one that misses, and what is left of them where a file is missing.
What the page shows is held against the log as this script reads it. And what does not belong together is refused.

  run_page.py TENON_INSPECT PAGE_RUNS SOURCE PLANS [--pictures FOLDER]

@param PAGE_RUNS the program that executes the runs  @param PLANS the folder of the plans that the tests share
"""
import argparse
import json
import math
import pathlib
import re
import struct
import subprocess
import tempfile
import time

from browser import Browser, run_test
from looked_at import LookedAt
from on_paper import print_page
from plan_page import BYTES_MAX, ROOT, SMALL, look_at, press, stay_as_high
from rise import fall_back, stay_put, tick_by_key

PLAN = "box_4_gantry3"
HEADING_BYTES = 28
# Of a cycle's message: 8 bytes of hash, 4 times, 3 small numbers, step, phase, signature; then doubles.
POSE_AT, WRENCH_AT = 48, 48 + 8 * 27
STATES_WITH_FORCES = range(2, 11)  # behind the taring


def events(file):
    """(channel, message) of each event of an LCM log."""
    data = file.read_bytes()
    at = 0
    while at < len(data):
        sync, _, _, name, size = struct.unpack_from(">Iqqii", data, at)
        assert sync == 0xEDA1DA01
        at += HEADING_BYTES
        yield data[at:at + name].decode(), data[at + name:at + name + size]
        at += name + size


class Oracle:
    """What the page has to show of a log."""

    def __init__(self, file):
        self.peaks = [0.0] * 6
        self.times = []
        self.tools = []
        for channel, message in events(file):
            if channel != "TENON_CYCLE":
                continue
            self.times.append(struct.unpack_from(">q", message, 24)[0])
            self.tools.append(struct.unpack_from(">7d", message, POSE_AT))
            if message[40] in STATES_WITH_FORCES:
                wrench = struct.unpack_from(">6d", message, WRENCH_AT)
                self.peaks = [max(peak, abs(value)) for peak, value in zip(self.peaks, wrench)]


def inspect(arguments, page, *options):
    command = [arguments.inspect, f"{arguments.plans}/{PLAN}.tnp", "--report", str(page), *map(str, options)]
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def write_pages(arguments, folder, failures):
    """@return the pages by name"""
    task = ["--task", f"{arguments.source}/planner/tasks/box_on_table_2d.yaml",
            "--cell", f"{arguments.source}/hw/cells/gantry3.yaml"]
    whole = (folder / "box.lcmlog").read_bytes()
    (folder / "cut.lcmlog").write_bytes(whole[:len(whole) // 2 - 1])
    log, run = (lambda name: ["--log", folder / f"{name}.lcmlog"]), (lambda name: ["--run", folder / f"{name}.json"])
    wanted = {
        "box": [*task, *run("box"), *log("box")],
        "fault": [*task, *run("fault"), *log("fault")],
        "forced": [*task, *run("forced"), *log("forced")],
        "missed": [*task, *log("missed")],
        "bare": [*run("box"), *log("box")],
        "result": [*task, *run("box")],
        "cut": [*task, *log("cut")],
    }
    pages = {}
    for name, options in wanted.items():
        pages[name] = folder / f"{name}.html"
        made = inspect(arguments, pages[name], *options)
        failures.check(made.returncode == 0, f"{name}: {made.stderr}")
        size = pages[name].stat().st_size
        print(f"{name}: {size} bytes")
        failures.check(size < BYTES_MAX, f"{name}: {size} bytes, more than {BYTES_MAX}")
    return pages


def data_of(browser):
    return json.loads(browser.evaluate("document.getElementById('page-data').textContent"))


def near(one, other, within):
    return len(one) == len(other) and all(abs(a - b) <= within for a, b in zip(one, other))


def hold_against_the_log(browser, page, oracle, failures):
    """Peaks, ends and the tool's last pose, which stands where the log has it once nothing is moved."""
    browser.open(page)
    browser.wait_for(f"{ROOT}.ready === 'true'")
    run = data_of(browser)["run"]
    for axis, peak in enumerate(oracle.peaks):
        shown = max(abs(value) for value in run["curves"]["wrench"][axis] if value is not None)
        failures.check(abs(shown - peak) < 2e-3, f"{page.stem}: largest along {axis} is {shown}, in the log {peak}")
    end = 1e-9 * (oracle.times[-1] - oracle.times[0])
    failures.check(abs(float(browser.evaluate(f"{ROOT}.time")) - end) < 2e-3, f"{page.stem}: does not end at {end} s")
    tool = json.loads(browser.evaluate(f"{ROOT}.tool"))
    goal = data_of(browser)["goal"]
    failures.check(near(tool[:2], goal[:2], 1e-3), f"{page.stem}: moved onto the goal it ends at {tool}, not {goal}")
    browser.evaluate("[...document.querySelectorAll('.legend label')]"
                     ".find(l => l.textContent.includes('onto the goal')).querySelector('input').click()")
    tool = json.loads(browser.evaluate(f"{ROOT}.tool"))
    failures.check(near(tool[:3], oracle.tools[-1][:3], 2e-5), f"{page.stem}: ends at {tool}, in the log at "
                   f"{oracle.tools[-1]}")


def hold_against_the_result(browser, page, result, failures):
    """The cycles that were late: as many by the result, in the page's words, and marked in its curves."""
    late, cycles = (json.loads(result.read_text())["cycle"][key] for key in ("late_cycles", "cycles"))
    failures.check(late > 0, f"{page.stem}: no cycle was late")
    browser.open(page)
    browser.wait_for(f"{ROOT}.ready === 'true'")
    marked = sum(data_of(browser)["run"]["curves"]["late_cycles"])
    text = browser.evaluate("document.body.innerText")
    failures.check(marked == late, f"{page.stem}: {marked} late cycles are marked, in the result are {late}")
    for words in (f"{cycles} cycles, {late} late", f"Late cycles: {late}, "):
        failures.check(words in text, f"{page.stem}: does not say '{words}'")


def use(browser, page, failures):
    """Keys, steps, zoom, a joint, and the play to the end."""
    name = page.stem
    browser.open(page, width=SMALL)
    browser.wait_for(f"{ROOT}.ready === 'true'")
    spans = data_of(browser)["run"]["spans"]
    at = lambda: float(browser.evaluate(f"{ROOT}.time"))
    browser.evaluate("document.querySelector('button.jump[data-span=\"2\"]').click()")
    failures.check(browser.evaluate(f"{ROOT}.step") == "2", f"{name}: a step's button leads elsewhere")
    failures.check(abs(at() - spans[2]["from_s"]) < 2e-3, f"{name}: a step's button leads to {at()} s")
    press(browser, "ArrowRight")
    held = browser.evaluate("[...document.querySelectorAll('.now p')].find(p => p.textContent.startsWith('Holds'))"
                            ".textContent")
    failures.check(held == "Holds " + spans[2]["signature"], f"{name}: after step 2 '{held}', in the result "
                   f"{spans[2]['signature']}")
    browser.evaluate("[...document.querySelectorAll('.zoom button')].find(b => b.textContent === 'This step').click()")
    browser.wait_for(f"{ROOT}.zoom !== 'all'")
    low, high = json.loads(browser.evaluate(f"{ROOT}.zoom"))
    failures.check(low <= spans[2]["from_s"] < spans[2]["to_s"] <= high, f"{name}: shows {low} to {high} s of step 2")
    browser.evaluate("[...document.querySelectorAll('.zoom button')].find(b => b.textContent === 'Whole run').click()")
    browser.wait_for(f"{ROOT}.zoom === 'all'")
    browser.evaluate("(() => { const s = document.querySelector('h3 select'); s.value = '2';"
                     " s.dispatchEvent(new Event('change')); })()")
    labels = browser.evaluate("[...document.querySelectorAll('.plot canvas')].map(p => p.getAttribute('aria-label')).join()")
    joint = data_of(browser)["run"]["curves"]["joints"][2]["name"]
    failures.check(f"Joint {joint} over time" in labels, f"{name}: the third joint is not shown: {labels}")
    for wanted in ("Steps over time", "Force on the tool", "Torque", "place in the task frame", "Timing", "Load of the bus"):
        failures.check(wanted in labels, f"{name}: no curve '{wanted}'")
    browser.evaluate("document.activeElement.blur()")  # a list takes the keys for itself
    press(browser, "Home")
    failures.check(at() == 0.0, f"{name}: Home leads to {at()} s")
    press(browser, "ArrowRight")
    failures.check(abs(at() - spans[0]["from_s"]) < 2e-3, f"{name}: right arrow leads to {at()} s")
    browser.evaluate("(() => { const s = document.querySelector('.controls select'); s.value = '4';"
                     " s.dispatchEvent(new Event('change')); })()")
    press(browser, " ")
    browser.wait_for(f"{ROOT}.playing === 'false' && {ROOT}.step === 'end'")
    heading = browser.evaluate("document.querySelector('.now h2').textContent")
    failures.check(heading == "Done", f"{name}: ends with '{heading}'")
    failures.check(not browser.said(), f"{name}: says something while it is used")


def tell(browser, pages, failures):
    """What each page says of how its run ended, and of what it lacks."""
    text = lambda: browser.evaluate("document.body.innerText")
    for name, wanted in (("fault", ["Not done", "Faults", "unfinished ("]),
                         ("forced", ["external force", "unfinished ("]), ("missed", ["Not done"]),
                         ("cut", ["breaks off within a message", "Its end is not in the log"]),
                         ("result", ["give it with --log"]), ("bare", ["give it with --task", "Done"])):
        browser.open(pages[name])
        browser.wait_for(f"{ROOT}.ready === 'true'")
        for words in wanted:
            failures.check(words in text(), f"{name}: does not say '{words}'")
        if name == "forced":  # the cycle that ended the step has none any more
            ended_by_N = float(re.search(r"external force ([\d.]+) N", text())[1])
            row = browser.evaluate("document.querySelector('td.stopped').parentElement.textContent")
            failures.check(f"{ended_by_N:.1f} N" in row, f"forced: {ended_by_N} N ended the step, its row says '{row}'")
    browser.open(pages["fault"])
    browser.wait_for(f"{ROOT}.ready === 'true'")
    fault = data_of(browser)["run"]["faults"][-1]
    browser.evaluate("document.querySelector('.faults button.jump').click()")
    failures.check(math.isclose(float(browser.evaluate(f"{ROOT}.time")), fault["time_s"], abs_tol=2e-3),
                   "fault: its button does not lead to it")


def tell_contacts(arguments, browser, page, failures):
    """The page says of a step's contacts what the text says."""
    text = subprocess.run([arguments.inspect, f"{arguments.plans}/{PLAN}.tnp"], check=True, capture_output=True,
                          text=True).stdout
    contacts = lambda words: re.findall(r"contacts ([^\n\t]*?)\s*(?:->|\t|\n)", words)
    in_text = contacts(text)
    browser.open(page)
    shown = browser.evaluate("[...document.querySelectorAll('.moves td')].map(e => e.textContent)"
                             ".filter(t => t.includes('; contacts ')).map(t => t.split('; contacts ')[1])")
    failures.check(in_text == shown and any("possible" in words for words in shown),
                   f"{page.stem}: contacts {shown}, in the text {in_text}")


def tell_what_lacks(browser, page, failures):
    """A dash in place of a value says what the executor did instead."""
    for end, wanted in (("End", "the run had ended"), ("Home", "the executor was waiting")):
        browser.open(page)
        browser.wait_for(f"{ROOT}.ready === 'true'")
        press(browser, end)
        dashes = browser.evaluate("[...document.querySelectorAll('.curves-key b')].filter(b => b.textContent === '–')"
                                  ".map(b => [b.parentElement.textContent, b.title])")
        failures.check(dashes and all(wanted in title for _, title in dashes), f"{page.stem}: by {end} lack {dashes}")
        failures.check(f"not commanded: {wanted}" in [title for _, title in dashes], f"{page.stem}: by {end} {dashes}")


def open_at(browser, page, failures):
    """#step=1.5 opens in the middle of step 1 as it ran; a step that never ran is the end."""
    spans = {}
    for fragment, step in (("#step=1.5", 1), ("#step=2", 2), ("#step=6", None)):
        browser.open(page, fragment=fragment)
        browser.wait_for(f"{ROOT}.ready === 'true'")
        run = data_of(browser)["run"]
        spans = {span["step"]: span for span in run["spans"]}
        place = float(fragment[6:]) % 1
        wanted = run["duration_s"] if step is None else \
            spans[step]["from_s"] + place * (spans[step]["to_s"] - spans[step]["from_s"])
        at = float(browser.evaluate(f"{ROOT}.time"))
        failures.check(abs(at - wanted) < 5e-3, f"{page.stem}{fragment}: opens at {at} s, not {wanted}")


# How many pixels of a curve's canvas are dark enough for paper.
INK = """[...document.querySelectorAll('.plot canvas')].map(canvas => {
  if (!canvas.getBoundingClientRect().width) return 0;
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let dark = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && data[i] + data[i + 1] + data[i + 2] < 400) ++dark;
  return dark; })"""
STILLS = ("[...document.querySelectorAll('section.still svg[role=img]')].filter(e => e.getBoundingClientRect().height)"
          ".map(e => e.querySelector('title').textContent)")


def print_pages(browser, pages, failures, pictures):
    """In print stand the curves, as drawn, and a still picture of the scene; the latter also where no script runs."""
    for name, page in pages.items():
        text = print_page(browser, page, failures, pictures)
        ink = browser.evaluate(INK)
        wanted = 0 if name == "result" else 7
        failures.check(len(ink) >= wanted and all(count > 100 for count in ink), f"{name}: prints curves of {ink} pixels")
        stills = browser.evaluate(STILLS)
        failures.check(len(stills) == (0 if name == "bare" else 1), f"{name}: prints the pictures {stills}")
        failures.check("need scripts" not in text, f"{name}: asks for scripts in print")
        browser.call("Emulation.setScriptExecutionDisabled", value=True)
        browser.open(page)
        browser.call("Emulation.setScriptExecutionDisabled", value=False)
        text = browser.evaluate("document.body.innerText")
        stills = browser.evaluate(STILLS)
        failures.check(len(stills) == (0 if name == "bare" else 1), f"{name}: without scripts shows {stills}")
        failures.check(("The curves need scripts." in text) == (wanted > 0), f"{name}: without scripts says '{text}'")


def refuse(arguments, folder, failures):
    """One line each, status 2, and no page."""
    page = folder / "refused.html"
    (folder / "garbage.lcmlog").write_bytes(b"no log at all")
    damaged = bytearray((folder / "box.lcmlog").read_bytes())
    damaged[damaged.index(b"\xed\xa1\xda\x01", len(damaged) // 2)] ^= 0xFF
    (folder / "damaged.lcmlog").write_bytes(damaged)
    (folder / "short.lcmlog").write_bytes(damaged[:100])
    (folder / "half.json").write_text((folder / "box.json").read_text()[:500])
    other = json.loads((folder / "box.json").read_text())
    other["start"] = "1"
    (folder / "other.json").write_text(json.dumps(other))
    for options, words in ((["--log", "garbage.lcmlog"], "is no LCM log"),
                           (["--log", "damaged.lcmlog"], "no event of an LCM log begins here"),
                           (["--log", "short.lcmlog"], "holds no cycle of a run"),
                           (["--log", "none.lcmlog"], "cannot be read"),
                           (["--run", "half.json"], "is no whole JSON"),
                           (["--run", "other.json"], "from start '1'"),
                           (["--run", "missed.json", "--log", "box.lcmlog"], "is of another run than"),
                           ([], "--report needs --task")):
        made = inspect(arguments, page, *[folder / o if "." in o else o for o in options])
        failures.check(made.returncode == 2, f"{options}: status {made.returncode}")
        failures.check(words in made.stderr and made.stderr.count("\n") == 1, f"{options}: says '{made.stderr}'")
        failures.check(not page.exists(), f"{options}: leaves a page")


def main(failures):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("inspect", "page_runs", "source", "plans"):
        parser.add_argument(name)
    parser.add_argument("--pictures", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tenon_pages_") as scratch:
        folder = pathlib.Path(scratch)
        subprocess.run([arguments.page_runs, folder], check=True)
        pages = write_pages(arguments, folder, failures)
        refuse(arguments, folder, failures)
        looked_at = LookedAt(__file__, arguments.plans, pages.values(), arguments.pictures)
        if looked_at.before():
            return f"{len(pages)} pages as they were when they were looked at"
        for webgl in (True, False):
            with Browser(webgl) as browser:
                for name in ("box", "fault") if webgl else pages:
                    began = time.monotonic()
                    look_at(browser, pages[name], "", webgl, failures, arguments.pictures)
                    print(f"{name}: looked at in {time.monotonic() - began:.1f} s")
                use(browser, pages["box"], failures)
                stay_put(browser, pages["box"], failures, webgl)
                if webgl:
                    fall_back(browser, pages["box"], failures)
                    continue  # words and numbers are the same, and there every page takes seconds to be drawn
                hold_against_the_log(browser, pages["box"], Oracle(folder / "box.lcmlog"), failures)
                for name in ("box", "fault"):
                    hold_against_the_result(browser, pages[name], folder / f"{name}.json", failures)
                tell(browser, pages, failures)
                tell_contacts(arguments, browser, pages["box"], failures)
                tick_by_key(browser, pages["box"], failures)
                stay_as_high(browser, pages["box"], failures)
                for name in ("box", "fault"):
                    tell_what_lacks(browser, pages[name], failures)
                open_at(browser, pages["fault"], failures)
                print_pages(browser, pages, failures, arguments.pictures)
        looked_at.now(failures)
    return f"{len(pages)} pages"


if __name__ == "__main__":
    run_test(main)
