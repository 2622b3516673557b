#!/usr/bin/env python3
"""tenon-sim --view in headless Chromium while a plan is executed in real time: the part moves on the page and ends
where the truth file says; two look on at once; a simulation that is killed or stands still is told from
one that has ended, and the page of one that was killed becomes that of the next. On a screen and a phone, light and
dark, with WebGL and without.

  live_page.py BIN SOURCE PLANS [--pictures FOLDER]

@param BIN the folder of the programs  @param PLANS the folder of the plans that the tests share
"""
import argparse
import json
import math
import pathlib
import signal
import subprocess
import tempfile
import time
import urllib.parse
import urllib.request

from browser import Browser, run_test
from plan_page import BYTES_MAX, ROOT, look_at

# At 100 Hz, so that a busy machine is no trouble; the plan is for this start.
CELL, TASK, PLAN, START = "lwa4p", "box_on_table_2d", "box_1_lwa4p", "1"
OFFSET_M = (0.02, -0.015)
JOINTS = 6
RATE_MIN_HZ = 20
ATTEMPTS = 3


class Simulation:
    """tenon-sim with a view, used with `with`. @param port of the view; None: a free one"""

    def __init__(self, arguments, folder, *more, port=None):
        source = pathlib.Path(arguments.source)
        self.truth_file = folder / "truth.json"
        self.process = subprocess.Popen(
            [f"{arguments.bin}/tenon-sim", "--cell", source / f"hw/cells/{CELL}.yaml", "--task",
             source / f"planner/tasks/{TASK}.yaml", "--start", START, "--offset", f"x_m={OFFSET_M[0]},y_m={OFFSET_M[1]}",
             "--can", "slcan-listen://127.0.0.1:0", "--json", self.truth_file, "--view", *([str(port)] if port else []), *more],
            stdout=subprocess.PIPE, text=True)
        lines = [self.process.stdout.readline() for _ in range(2)]
        if not lines[0].startswith("view: http://127.0.0.1:") or not lines[1].startswith("listening on "):
            raise SystemExit(f"FAILED: tenon-sim says {lines}")
        self.url = lines[0].split()[1]
        self.can = "slcan://" + lines[1].split()[-1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def truth(self):
        return json.loads(self.truth_file.read_text())


def page_now(browser):
    """What the page says of itself; the tool as numbers."""
    now = browser.evaluate(f"({{...{ROOT}}})")
    now["tool"] = json.loads(now.get("tool", "null"))
    return now


def watch_a_run(arguments, folder, browser, failures):
    """@return whether the executor came to its end by the plan, and not because the machine was too busy"""
    with Simulation(arguments, folder, "--once") as simulation, Browser(webgl=False) as other:
        browser.open(simulation.url)
        other.open(simulation.url)
        browser.wait_for(f"{ROOT}.state === 'live' && {ROOT}.tool")
        other.wait_for(f"{ROOT}.state === 'live' && {ROOT}.tool")
        first = page_now(browser)
        failures.check(first["enabled"] == "0", f"live: {first['enabled']} drives enabled before anybody came")
        result = folder / "result.json"
        executor = subprocess.Popen(
            [f"{arguments.bin}/tenon-exec", "--cell", f"{arguments.source}/hw/cells/{CELL}.yaml", "--plan",
             f"{arguments.plans}/{PLAN}.tnp", "--can", simulation.can, "--lcm-url", "none", "--rt", "prefer", "--json",
             result], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder)
        seen = []
        while simulation.process.poll() is None:
            seen.append(page_now(browser))
            time.sleep(0.1)
        executor.wait()
        browser.wait_for(f"{ROOT}.state !== 'live'")
        last = page_now(browser)
        if json.loads(result.read_text())["status"] != "done":
            return False
        hold_against_the_truth(browser, simulation.truth(), first, seen, last, failures)
        failures.check(page_now(other)["state"] == "ended", "live: the other viewer was not told of the end")
        failures.check(page_now(other)["tool"] == last["tool"], "live: two viewers see two ends")
    return True


def hold_against_the_truth(browser, truth, first, seen, last, failures):
    failures.check(last["state"] == "ended", f"live: ends as '{last['state']}'")
    way = max(math.dist(now["tool"][:3], first["tool"][:3]) for now in seen)
    failures.check(way > 0.05, f"live: the part has moved by {way} m")
    failures.check(any(now["enabled"] == str(JOINTS) for now in seen), "live: never were all drives enabled")
    failures.check(any(now["points"] != "0" for now in seen), "live: never was there a contact")
    places = len({tuple(now["tool"]) for now in seen})
    failures.check(places > 20, f"live: {len(seen)} looks saw the part at {places} places")
    seconds = float(last["time"]) - float(first["time"])
    rate = (int(last["moments"]) - int(first["moments"])) / seconds
    print(f"live: {rate:.1f} moments a second over {seconds:.1f} s, {way * 1e3:.0f} mm of way")
    failures.check(rate >= RATE_MIN_HZ, f"live: {rate} moments a second")
    # The truth is in the frame of the environment as it stands, the page in the one where it should.
    tool = [truth["tool"]["x_m"] + OFFSET_M[0], truth["tool"]["y_m"] + OFFSET_M[1], truth["tool"]["z_m"]]
    failures.check(math.dist(tool, last["tool"][:3]) < 2e-4, f"live: ends at {last['tool']}, in truth at {tool}")
    words = browser.evaluate("document.querySelector('.words').textContent")
    verdict = "At the goal" if truth["within_tolerance"] else "Not at the goal"
    failures.check(words.startswith(verdict), f"live: says '{words}' of {verdict}")
    heading = browser.evaluate("document.querySelector('.now h2').textContent")
    failures.check(heading == "The simulation has ended", f"live: ends with '{heading}'")
    shown = browser.evaluate("document.querySelector('.forces polyline').getAttribute('points').split(' ').length")
    failures.check(shown > 100, f"live: the force's line has {shown} points")
    for said in browser.said():
        failures.check(False, f"live: says {said}")


def run_of(browser):
    return json.loads(browser.evaluate("document.getElementById('page-data').textContent"))["run_id"]


def lose_it(arguments, folder, browser, failures):
    """A simulation that stands still, goes on, is killed without a word, and is followed by another one."""
    with Simulation(arguments, folder) as simulation:
        browser.open(simulation.url)
        browser.wait_for(f"{ROOT}.state === 'live' && {ROOT}.tool")
        simulation.process.send_signal(signal.SIGSTOP)
        browser.wait_for(f"{ROOT}.state === 'silent'")
        simulation.process.send_signal(signal.SIGCONT)
        browser.wait_for(f"{ROOT}.state === 'live'")
        simulation.process.kill()
        browser.wait_for(f"{ROOT}.state === 'lost'")
        heading = browser.evaluate("document.querySelector('.now h2').textContent")
        failures.check(heading == "Connection lost", f"lost: says '{heading}'")
    before = run_of(browser)
    # The page asks again by itself, and a server of another run makes it load anew.
    browser.events.clear()
    with Simulation(arguments, folder, port=urllib.parse.urlsplit(simulation.url).port):
        browser.wait_for_event("Page.loadEventFired")
        browser.wait_for(f"{ROOT}.state === 'live' && {ROOT}.tool")
        after = run_of(browser)
        failures.check(before != after, f"followed: the page is still that of run {before}")
        failures.check(browser.evaluate("performance.getEntriesByType('navigation')[0].type") == "reload",
                       "followed: somebody else than the page has loaded it")


def look(arguments, folder, webgl, browser, failures):
    with Simulation(arguments, folder) as simulation:
        with urllib.request.urlopen(simulation.url) as answer:
            size = len(answer.read())
        print(f"live: {size} bytes")
        failures.check(size < BYTES_MAX, f"live: {size} bytes, more than {BYTES_MAX}")
        served = (simulation.url, [simulation.url + "events"])
        look_at(browser, pathlib.Path("live.html"), "", webgl, failures, arguments.pictures, served)
        simulation.process.send_signal(signal.SIGINT)
        failures.check(simulation.process.wait() == 0, "live: SIGINT ends it with another status than 0")


def main(failures):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("bin", "source", "plans"):
        parser.add_argument(name)
    parser.add_argument("--pictures", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tenon_pages_") as scratch:
        folder = pathlib.Path(scratch)
        for webgl in (True, False):
            with Browser(webgl) as browser:
                look(arguments, folder, webgl, browser, failures)
                if not webgl:
                    lose_it(arguments, folder, browser, failures)
        with Browser(webgl=False) as browser:
            done = any(watch_a_run(arguments, folder, browser, failures) for _ in range(ATTEMPTS))
            failures.check(done, f"live: the plan was not done in {ATTEMPTS} runs")


if __name__ == "__main__":
    run_test(main)
