#!/usr/bin/env python3
"""The plan's page in headless Chromium: on a screen and a phone, light and dark, with WebGL and without.

  plan_page.py TENON_INSPECT SOURCE PLANS [--pictures FOLDER]

@param PLANS the folder of the plans that the tests share  @param FOLDER for a picture of each page
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import tempfile

from browser import Browser, run_test
from looked_at import LookedAt
from on_paper import print_page
from rise import ROOT, fall_back, keep_view, rise, scroll_over_the_scene, stay_put, tick_by_key

BYTES_MAX = 3_000_000
SMALL = 700  # px; what plays is drawn many times, by software where no graphics card is
# How far the middle of what stands still in the flat scene is from the middle of its frame, of the frame's width.
OFF_THE_MIDDLE = """(() => { const frame = document.querySelector('.canvas').getBoundingClientRect();
  const boxes = [...document.querySelectorAll('.canvas svg > path')].map(e => e.getBoundingClientRect());
  if (!document.querySelector('.canvas svg > path[fill-opacity="0.45"]')) return 0; // no environment
  const [left, right] = [Math.min(...boxes.map(b => b.left)), Math.max(...boxes.map(b => b.right))];
  return ((left + right) - (frame.left + frame.right)) / 2 / frame.width; })()"""
OFF_MAX = 0.01
# What covers a part of the picture that one looks at.
OVER_THE_SCENE = """(() => { const scene = document.querySelector('.canvas').getBoundingClientRect();
  return [...document.querySelectorAll('.stage button, .stage input, .stage p')].filter(e => {
    const r = e.getBoundingClientRect();
    return r.height && r.top < scene.bottom - 1 && r.bottom > scene.top + 1 && r.left < scene.right - 1
      && r.right > scene.left + 1; }).map(e => e.textContent); })()"""
# (plan, task, cell that it was made for)
PLANS = [
    ("peg_2d_fine", "peg_in_hole_2d_fine", None),
    ("box_se2_csp6", "box_on_table_se2", "csp6"),
    ("toy_1d", "toy_1d", None),
]


def write_page(arguments, folder, plan, task, cell):
    """Beside it PLAN.json, what planning was like, but for how long it took: the page is the same whenever it was."""
    file = folder / f"{plan}.html"
    statistics = json.loads((pathlib.Path(arguments.plans) / f"{plan}.json").read_text())
    statistics["time_s"] = {kind: 0.5 * number for number, kind in enumerate(statistics["time_s"], 1)}
    file.with_suffix(".json").write_text(json.dumps(statistics))
    command = [arguments.inspect, f"{arguments.plans}/{plan}.tnp", "--report", str(file),
               "--task", f"{arguments.source}/planner/tasks/{task}.yaml"]
    # The toy's page is one without it.
    if plan != PLANS[-1][0]:
        command += ["--statistics", str(file.with_suffix(".json"))]
    if cell:
        command += ["--cell", f"{arguments.source}/hw/cells/{cell}.yaml"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return file


def look_at(browser, file, fragment, webgl, failures, pictures, served=None):
    """Each width and colour: nothing said, nothing asked for, nothing wider than the window, nothing unnamed.

    Where WebGL is drawn without a graphics card, which takes seconds, only two of the four, unless
    TENON_EVERY_WINDOW is set.
    @param fragment of the address: where the page is to open
    @param served: the page's address, where it has a server, and what it may ask it for; `file` names it then"""
    address, allowed = served or (file, [])
    every = not webgl or "TENON_EVERY_WINDOW" in os.environ
    for width in (1400, 390):
        for dark in (False, True) if every else (width == 390,):
            name = f"{file.stem}_{width}_{'dark' if dark else 'light'}_{'webgl' if webgl else 'svg'}"
            browser.open(address, width=width, dark=dark, fragment=fragment)
            browser.wait_for(f"{ROOT}.ready === 'true'")
            failures.check(not fragment or browser.evaluate(f"{ROOT}.step") == "1", f"{name}: does not open at {fragment}")
            wide = browser.evaluate("document.documentElement.scrollWidth")
            failures.check(wide <= width, f"{name}: {wide} px wide")
            if webgl:
                rise(browser)
            shown = browser.evaluate("[...document.querySelectorAll('.canvas > *')].filter(e => e.getClientRects().length)"
                                     ".map(e => e.localName).join()")
            failures.check(shown == ("canvas" if webgl else "svg"), f"{name}: the scene is drawn by {shown}")
            choices = browser.evaluate("document.querySelector('.views').innerText")
            failures.check(("In space" in choices) == webgl, f"{name}: offers the views {choices}")
            boxes = browser.evaluate("[...document.querySelectorAll('.in-space')].map(e => getComputedStyle(e).visibility === 'visible')")
            failures.check(all(box == webgl for box in boxes), f"{name}: what a scene in space has is seen: {boxes}")
            off = 0.0 if webgl else browser.evaluate(OFF_THE_MIDDLE)
            failures.check(abs(off) < OFF_MAX, f"{name}: the scene is {100 * off:.1f} % of the frame beside its middle")
            over = browser.evaluate(OVER_THE_SCENE)
            failures.check(not over, f"{name}: over the scene stand {over}")
            for said in browser.said():
                failures.check(False, f"{name}: says {said}")
            for url in browser.requests():
                failures.check(url in allowed, f"{name}: asks for {url}")
            unnamed = browser.evaluate(
                "[...document.querySelectorAll('button,input,select,svg[role=img],canvas')]"
                ".filter(e => !(e.textContent.trim() || e.getAttribute('aria-label') || e.closest('label'))).length")
            failures.check(unnamed == 0, f"{name}: {unnamed} elements without a name")
            if pictures:
                browser.picture(pictures / f"{name}.png")
            cut = browser.evaluate(
                "[...document.querySelectorAll('.now h2, .words p')].filter(e => { e.append(' ' + 'name'.repeat(20));"
                " return e.scrollWidth > e.clientWidth; }).map(e => e.textContent)")
            failures.check(not cut, f"{name}: a long name is cut off in {cut}")


# The time of the first frame of a page that can be used, by its own clock.
FIRST_FRAME = """new MutationObserver((_, observer) => {
  if (document.documentElement?.dataset.ready !== 'true') return;
  observer.disconnect();
  requestAnimationFrame(() => setTimeout(() => { window.firstFrame_ms = performance.now(); }));
}).observe(document, { attributes: true, subtree: true });"""


def opening_s(browser, file):
    """From the address to the first frame of a page that can be used."""
    script = browser.call("Page.addScriptToEvaluateOnNewDocument", source=FIRST_FRAME)["identifier"]
    browser.open(file)
    browser.wait_for("window.firstFrame_ms")
    browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
    return 1e-3 * browser.evaluate("window.firstFrame_ms")


def press(browser, key):
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=0)


# In how many pixels of the scene in space its particles are seen.
PARTICLES_ARE_SEEN = """(async () => {
  const canvas = document.querySelector('.canvas canvas');
  const box = [...document.querySelectorAll('.legend label')].find(e => / particle/.test(e.textContent))
    .querySelector('input');
  const pixels = () => new Promise(done => {
    box.click();
    requestAnimationFrame(() => {
      const flat = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
      flat.drawImage(canvas, 0, 0);
      done(flat.getImageData(0, 0, canvas.width, canvas.height).data);
    });
  });
  const [without, shown] = [await pixels(), await pixels()];
  let count = 0;
  for (let i = 0; i < shown.length; i += 4) {
    if ([0, 1, 2].some(c => Math.abs(shown[i + c] - without[i + c]) > 4)) ++count;
  }
  return count; })()"""
EDGES_MAX = 3000  # px; with faces that fight for what is in front it were more than 9000


def particles_at_the_end(browser, file, failures):
    """All are where the front part is: its faces have their own colour, whatever edges shine through."""
    browser.open(file, width=1400)
    browser.wait_for(f"{ROOT}.ready === 'true'")
    rise(browser)
    press(browser, "End")
    browser.wait_for(f"{ROOT}.step === 'end'")
    seen = browser.evaluate(PARTICLES_ARE_SEEN)
    failures.check(0 < seen < EDGES_MAX, f"{file.stem}: at the end particles are seen in {seen} pixels")


def play(browser, file, failures):
    """By itself from the start to the end, where the page says what the data says; then by keys."""
    name = file.stem
    browser.open(file, width=SMALL, calm=False)
    browser.wait_for(f"{ROOT}.ready === 'true'")
    browser.evaluate("(() => { const s = document.querySelector('.controls select'); s.value = '4';"
                     " s.dispatchEvent(new Event('change')); })()")
    browser.wait_for(f"{ROOT}.playing === 'false' && {ROOT}.step === 'end'")
    data = json.loads(browser.evaluate("document.getElementById('page-data').textContent"))
    shown = json.loads(browser.evaluate(f"{ROOT}.spread"))
    failures.check(shown == data["nodes"][-1]["spread"], f"{name}: ends with the spread {shown}")
    heading = browser.evaluate("document.querySelector('.now h2').textContent")
    failures.check(str(len(data["steps"])) in heading and "done" in heading, f"{name}: ends with '{heading}'")
    arrived = sum(draw["at_goal"] for draw in data["draws"])
    words = browser.evaluate("document.querySelector('.words').textContent")
    failures.check(f"{arrived} of {len(data['draws'])} at the goal" in words, f"{name}: ends with '{words}'")
    for key, step in (("Home", "0"), ("ArrowRight", "1" if len(data["steps"]) > 1 else "end"), ("ArrowLeft", "0"),
                      ("End", "end")):
        press(browser, key)
        found = browser.evaluate(f"{ROOT}.step")
        failures.check(found == step, f"{name}: key {key} leads to step {found}, not {step}")
    failures.check(not browser.said(), f"{name}: says something while it plays")


def stay_as_high(browser, file, failures):
    """From step to step, where the words stand below the scene: nothing under them moves while it plays."""
    for width in (SMALL, 390):
        browser.open(file, width=width, fragment="#step=0")
        browser.wait_for(f"{ROOT}.ready === 'true'")
        press(browser, "Home")
        heights = {}
        while True:
            step = browser.evaluate(f"new Promise(requestAnimationFrame).then(() => {ROOT}.step)")
            heights[step] = browser.evaluate("document.querySelector('main').getBoundingClientRect().height")
            if step == "end":
                break
            press(browser, "ArrowRight")
        failures.check(len(set(heights.values())) == 1, f"{file.stem} at {width} px: step by step as high as {heights}")


def show_the_spread(browser, file, failures):
    """The flat scene has a whisker of two standard deviations each way along each axis; none is told to be zero."""
    browser.open(file, fragment="#step=1.5")
    browser.wait_for(f"{ROOT}.ready === 'true'")
    wide = browser.evaluate("[...document.querySelectorAll('.bar b')].filter(e => { const text = new Range();"
                            " text.selectNodeContents(e); return text.getClientRects().length > 1"
                            " || e.scrollWidth > e.clientWidth; }).map(e => e.textContent)")
    failures.check(not wide, f"{file.stem}: {wide} has no room")
    press(browser, "Home")
    spread = json.loads(browser.evaluate(f"{ROOT}.spread"))
    data = json.loads(browser.evaluate("document.getElementById('page-data').textContent"))
    view = data["views"][0]
    lengths = browser.evaluate("[...document.querySelectorAll('.canvas .whisker')].map(e => e.getTotalLength())")
    wanted = [4e3 * spread[axis] for axis in (view["right"], view["up"])]
    failures.check(len(lengths) == len(wanted) and all(abs(a - b) < 0.05 for a, b in zip(lengths, wanted)),
                   f"{file.stem}: whiskers of {lengths} mm, by the spread {wanted}")
    press(browser, "End")
    told = browser.evaluate("[...document.querySelectorAll('.uncertainty .value, .bar b, .uncertainty title')]"
                            ".map(e => e.textContent)")
    least = 1e3 * min(data["nodes"][-1]["spread"][axis] for axis in data["coordinates"])
    zeros = [text for text in told if re.search(r"(^|\s)0(\.0+)?( mm|°)", text)]
    failures.check(told and not zeros, f"{file.stem}: on a logarithmic scale stand {zeros}")
    failures.check(any(f"{least:.2g} mm" in text for text in told), f"{file.stem}: {least} mm is not among {told}")
    for amount, wanted in (("0, 0", "0 mm"), ("-4e-6, 0", "0 mm"), ("1e-6, 3", "0°"), ("6e-6, 0", "0.01 mm")):
        found = browser.evaluate(f"amount({amount})")
        failures.check(found == wanted, f"{file.stem}: amount({amount}) is '{found}', not '{wanted}'")


def tell_the_search(browser, file, statistics, failures):
    """What stands in the section is what the file says, each number with its title."""
    browser.open(file)
    browser.wait_for(f"{ROOT}.ready === 'true'")
    cells = lambda table: browser.evaluate(
        f"[...document.querySelectorAll('#search ~ .wide')][{table}] && [...[...document.querySelectorAll("
        f"'#search ~ .wide')][{table}].querySelectorAll('tbody tr')].map(r => [...r.cells].map(c => c.textContent))")
    queues = [sum(search["expansions"][i] for search in statistics["searches"])
              for i in range(len(statistics["heuristics"]))]
    shown = cells(0)
    failures.check([row[0] for row in shown] == statistics["heuristics"], f"{file.stem}: queues {shown}")
    failures.check([int(row[1]) for row in shown] == queues, f"{file.stem}: expansions {shown}, in the file {queues}")
    moves = statistics["moves"]
    wanted = [["Looking for guides", moves["attractors"]["simulated"]], ["Searching", moves["search"]["simulated"]],
              ["Certifying", moves["certification"]], ["Running the corners", moves["corners"]],
              ["Validating", moves["validation"]]]
    shown = [[row[0], int(row[2])] for row in cells(1)]
    failures.check(shown == wanted, f"{file.stem}: moves {shown}, in the file {wanted}")
    rows = browser.evaluate("document.querySelectorAll('#search ~ details tbody tr').length")
    failures.check(rows == len(statistics["searches"]), f"{file.stem}: {rows} searches")
    untitled = browser.evaluate("[...document.querySelectorAll('#search ~ .wide thead th')]"
                                ".filter(h => h.scope !== 'col' || !h.textContent).length")
    failures.check(untitled == 0, f"{file.stem}: {untitled} columns of the search without a title")
    drawn = browser.evaluate("document.querySelectorAll('.course polyline').length")
    failures.check(drawn == (2 if statistics["course"]["cost"] else 0), f"{file.stem}: {drawn} lines of the course")
    return drawn


def main(failures):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("inspect")
    parser.add_argument("source")
    parser.add_argument("plans")
    parser.add_argument("--pictures", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tenon_pages_") as folder:
        files = [write_page(arguments, pathlib.Path(folder), *plan) for plan in PLANS]
        for file in files:
            size = file.stat().st_size
            print(f"{file.name}: {size} bytes")
            failures.check(size < BYTES_MAX, f"{file.name}: {size} bytes, more than {BYTES_MAX}")
        looked_at = LookedAt(__file__, arguments.plans, files, arguments.pictures)
        if looked_at.before():
            return f"{len(files)} pages as they were when they were looked at"
        for webgl in (True, False):
            with Browser(webgl) as browser:
                for file in files:
                    seconds = [opening_s(browser, file) for _ in range(3)]
                    print(f"{file.name}: open within {min(seconds):.2f} s, at worst {max(seconds):.2f} s,"
                          f" {'WebGL' if webgl else 'SVG'}")
                    look_at(browser, file, "#step=1.5", webgl, failures, arguments.pictures)
                play(browser, files[0], failures)
                stay_put(browser, files[0], failures, webgl)
                if webgl:
                    for test in (keep_view, fall_back, scroll_over_the_scene, particles_at_the_end):
                        test(browser, files[0], failures)
                    continue  # words and numbers are the same
                tick_by_key(browser, files[0], failures)
                show_the_spread(browser, files[0], failures)
                stay_as_high(browser, files[0], failures)
                for file in files:
                    text = print_page(browser, file, failures, arguments.pictures)
                    failures.check("\n0\t" in text, f"{file.stem}: the moves have no numbers in print")
                drawn = [tell_the_search(browser, file, json.loads(file.with_suffix(".json").read_text()), failures)
                         for file in files[:-1]]
                failures.check(any(drawn), "no page draws cost against bound")
                browser.open(files[-1])
                failures.check(not browser.evaluate("document.getElementById('search')"), "toy_1d: tells of a search")
        looked_at.now(failures)
    return f"{len(files)} pages"


if __name__ == "__main__":
    run_test(main)
