#!/usr/bin/env python3
"""tenon-monitor's dashboard in a pseudo-terminal, on messages that the test publishes in a network of its own.

  dashboard.py TENON_MONITOR SOURCE [--print]
"""
import argparse
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import network
from made_up_run import MadeUpRun
from terminal import ENTERED, Terminal

SIZES = [(40, 40), (80, 30), (200, 30)]
FAULT = "external force 80.3 N above force_fault_N = 60"


class Test:
    def __init__(self, arguments, publisher, folder):
        self.arguments = arguments
        self.publisher = publisher
        self.folder = folder
        self.failures = 0
        self.where = ""

    def check(self, good, what, terminal=None):
        if good:
            return
        self.failures += 1
        print(f"FAILED: {self.where}: {what}")
        if terminal:
            print(terminal.text())

    def open(self, columns, rows, **more):
        return Terminal([self.arguments.monitor, "--record-to", str(self.folder)], columns, rows, **more)

    def begin(self, terminal):
        """A run that is seen from its beginning. A program that does not listen yet misses it."""
        self.check(terminal.wait_for("WAITING: nothing has come"), "does not wait", terminal)
        run = MadeUpRun(self.publisher)
        run.begin()
        run.go_on(1.0, terminal.read)
        return run

    def shows(self, terminal, *patterns):
        for pattern in patterns:
            self.check(terminal.row(pattern) is not None, f"no row {pattern!r}", terminal)
        self.check(terminal.screen.wraps == 0, f"{terminal.screen.wraps} lines ran over their end", terminal)
        self.check("q quit  r record" in terminal.lines()[-1], "no keys in the last row", terminal)
        if self.arguments.print:
            print(f"=== {self.where}\n{terminal.text()}")

    # --- scenes ---------------------------------------------------------------------------------

    def live(self, terminal):
        self.shows(terminal, r"^LIVE: running, step 0 \(1 of 3\)", r"plan made_up_plan, start left",
                   r"cell bench, robot arm_on_rail", r"step 0 \(1 of 3\): \+x 0\.1 m", r"expects contact",
                   r"after 0\.0300 to 0\.0800 m", r"\+0\.0425 m .* of 0\.1 m", r"of at most 10 s, moving", r"holds -y",
                   r"x +\+5\.2 N .*█.* 87 %.*(!|near its trigger)", r"y +-1\.0 N .* 17 %.* -y",
                   r"rz +-0\.300 Nm .*█.* 50 %", r"\|f\| +5\.3 N .* of +60 N", r"\|t\| +0\.300 Nm .* of +10 Nm",
                   r"elbow +-1\.9500 rad .*█.* 1 %!", r"wrist_3 +\+1\.5000 rad .*█.* 12 % ",
                   r"rail +\+0\.2500 m .*█.* 25 % ", r"load +44 % █+.* most 85 %", r"4533 frames/s, at most +54 %",
                   r"unsent 2", r"wakes late +0\.050 ms, worst +0\.050 ms", r"computes +0\.120 ms",
                   r"period 2 ms +late 4", r"cycle 0\.\d s ago, wrench 0 ms old")
        self.check(terminal.style(0, 0)[1] == "green", "live is not green", terminal)
        row = terminal.row(r"x +\+5\.2 N")
        column = terminal.lines()[row].index("+5.2")
        self.check(terminal.style(row, column)[0] in ("yellow", "brown"), "near its trigger is not yellow", terminal)

    def drawn_as_anew(self, terminal, run):
        """What piece by piece came to stand there is what a screen drawn at once shows."""
        for way in (0.09, 0.02, 0.0425):
            run.pose = [way, 0.0, 0.0]
            run.go_on(0.3, terminal.read)
        still = [line for line in terminal.lines() if not re.search(r" s ago| s of | \d+\.\d s", line)]
        terminal.press("\x0c")
        terminal.read(0.3)
        anew = [line for line in terminal.lines() if not re.search(r" s ago| s of | \d+\.\d s", line)]
        self.check(still == anew, f"drawn by pieces:\n{still}\nnot as anew:", terminal)

    def fault(self, terminal, run):
        run.end_reason, run.state, run.wrench = run.FORCE_FAULT, run.QUICK_STOPPING, [80.3, 0, 0, 0, 0, 0]
        run.go_on(0.6, terminal.read)
        self.shows(terminal, r"^FAULT force_fault, quick stopping", r"\|f\| +80\.3 N .*> of +60 N")
        self.check(terminal.style(0, 0)[1] == "red", "a fault is not red", terminal)
        run.state = run.FINISHED
        run.go_on(0.3, terminal.read)
        run.summary(1, run.FORCE_FAULT, FAULT)
        terminal.read(0.5)
        self.shows(terminal, r"^FAILED: external force 80\.3 N above", r"finished, drives")
        banner = " ".join(line.strip() for line in terminal.lines()[:2])
        self.check(FAULT in banner, "the message is not whole", terminal)
        self.check(terminal.style(0, 0)[1] == "red", "a failure is not red", terminal)

    def stale(self, terminal):
        self.check(terminal.wait_for(r"^STALE: no cycle for [1-9]\.\d s", 5.0), "not stale", terminal)
        self.shows(terminal, r"^STALE: no cycle for \d\.\d s", r"x +\+5\.2 N")
        self.check(terminal.style(0, 0)[1] == "red", "stale is not red", terminal)

    def done(self, terminal, run):
        run.end_reason, run.state = run.PLAN_DONE, run.FINISHED
        run.go_on(0.3, terminal.read)
        run.summary(0, run.PLAN_DONE, "plan done")
        terminal.read(1.8)
        self.shows(terminal, r"^DONE: plan done")
        self.check(terminal.row("STALE") is None, "an end is called stale", terminal)

    def all_of_one_size(self, columns, rows):
        self.where = f"{columns} columns"
        terminal = self.open(columns, rows)
        run = self.begin(terminal)
        self.live(terminal)
        self.drawn_as_anew(terminal, run)
        self.stale(terminal)
        run.go_on(0.5, terminal.read)
        self.shows(terminal, r"^LIVE: running")
        self.fault(terminal, run)
        # Another run, in the same window.
        run = MadeUpRun(self.publisher)
        run.begin()
        run.go_on(0.5, terminal.read)
        self.live(terminal)
        self.done(terminal, run)
        self.check(terminal.end("q") == 0, "q does not end it", terminal)
        self.check(not terminal.restored(), f"not restored: {terminal.restored()}")
        terminal.close()

    def resized(self):
        self.where = "resized"
        terminal = self.open(80, 30)
        run = self.begin(terminal)
        for columns, rows in [(200, 30), (40, 40), (30, 8), (2, 1), (80, 30)]:
            terminal.resize(columns, rows)
            run.go_on(0.6, terminal.read)
            self.check("#" not in terminal.text(), f"{columns} x {rows}: what stood there is left", terminal)
            self.check(terminal.screen.wraps == 0, f"{columns} x {rows}: wraps", terminal)
            if columns == 30:
                self.check(terminal.row("lines more: make the") is not None, "does not say what is hidden", terminal)
        self.live(terminal)
        terminal.end("q")
        terminal.close()

    def ended_by_signals(self):
        for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.where = sent.name
            terminal = self.open(80, 30)
            self.begin(terminal)
            self.check(terminal.end(sent) == 0, "does not end in good order", terminal)
            self.check(not terminal.restored(), f"not restored: {terminal.restored()}")
            terminal.close()
        self.where = "Ctrl-C"
        terminal = self.open(80, 30)
        self.begin(terminal)
        self.check(terminal.end("\x03") == 0 and not terminal.restored(), "does not end in good order", terminal)
        terminal.close()

    def outlives_fragments(self):
        """LCM's library would write them anywhere."""
        self.where = "fragments"
        terminal = self.open(80, 30)
        run = self.begin(terminal)
        for begins_at in (0xFFFFFFFF, 0xFFFFFC00, 0xFFFFFF00, 0):
            for channel in ("TENON_SETUP", "TENON_CYCLE", "TENON_STATUS"):
                self.publisher.publish_fragment(channel, begins_at)
        run.go_on(0.6, terminal.read)
        self.live(terminal)
        self.check(terminal.end("q") == 0, "does not end in good order", terminal)
        terminal.close()

    def recorded(self):
        """The log is played by LCM's own player, and read by the monitor piped."""
        self.where = "recorded"
        terminal = self.open(80, 30)
        run = self.begin(terminal)
        terminal.press("r")
        run.go_on(1.0, terminal.read)
        self.check(terminal.row(r"q quit  r stop  REC [1-9]\d* messages to /") is not None, "does not say REC", terminal)
        self.check(list(self.folder.glob("*.lcmlog")) == [], "has its name before it is whole")
        run.summary(1, run.FORCE_FAULT, FAULT)
        run.go_on(0.2, terminal.read)
        terminal.press("r")
        self.check(terminal.wait_for("recorded [1-9]"), "does not say where", terminal)
        terminal.end("q")
        logs = list(self.folder.glob("tenon-*.lcmlog"))
        self.check(len(logs) == 1, f"{len(logs)} logs", terminal)
        self.check(str(logs[0]) in terminal.raw.decode(errors="replace"), "does not say where, once it has ended")
        terminal.close()
        for log in logs:
            command = [self.arguments.monitor, "--lcm-url", f"file://{log}?speed=1000"]
            lines = subprocess.run(command, capture_output=True, text=True, check=False)
            self.check(lines.returncode == 0 and f"failed: {FAULT}" in lines.stdout, f"not replayed: {lines}")
            self.check("\x1b" not in lines.stdout, "a pipe gets escapes")
            terminal = self.open(80, 30)
            self.check(terminal.wait_for("WAITING"), "does not wait", terminal)
            subprocess.run(["lcm-logplayer", "--speed=4", str(log)], check=False, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
            self.check(terminal.wait_for("^FAILED: external force"), "lcm-logplayer does not play it", terminal)
            terminal.end("q")
            terminal.close()
            self.breaks_off(log)
            log.unlink()

    def breaks_off(self, log):
        """A log without its end says so on the screen, not only once it is left."""
        half = self.folder / "half.log"
        half.write_bytes(log.read_bytes()[:-20])
        terminal = Terminal([self.arguments.monitor, "--lcm-url", f"file://{half}?speed=1000"], 80, 30)
        self.check(terminal.wait_for("END, not whole:"), "does not say that the log is not whole", terminal)
        text = " ".join(line.strip() for line in terminal.lines()[:5])
        self.check("breaks off within a message" in text, "does not say that the log breaks off", terminal)
        self.check(terminal.end("q") == 1, "ends as if the log were whole", terminal)
        terminal.close()
        half.unlink()

    def piped(self):
        """What waits, and what has gone silent, says so once."""
        self.where = "piped"
        with subprocess.Popen([self.arguments.monitor], stdout=subprocess.PIPE, text=True) as monitor:
            time.sleep(1.5)
            run = MadeUpRun(self.publisher)
            run.begin()
            run.go_on(0.5, time.sleep)
            # Silent in what counts: a status is no cycle.
            for _ in range(5):
                run.status()
                time.sleep(0.5)
            monitor.send_signal(signal.SIGINT)
            said = monitor.communicate()[0].splitlines()
        self.check(monitor.returncode == 0, f"ends with {monitor.returncode}")
        told = [line.split(":")[0] for line in said if line.startswith(("waiting: ", "stale: no cycle for 1."))]
        self.check(told == ["waiting", "stale"], f"says {said}")

    def ended_by_a_full_disk(self):
        self.where = "full disk"
        terminal = self.open(80, 30, limit_bytes=50_000)
        run = self.begin(terminal)
        terminal.press("r")
        run.go_on(2.0, terminal.read)
        self.check(terminal.row(r"RECORDING ENDED: File too large; \d+ of \d+ messages are in") is not None,
                   "a full disk is not said", terminal)
        self.shows(terminal, "^LIVE: running")
        self.check(terminal.end("q") == 0 and not terminal.restored(), "does not end in good order")
        for log in self.folder.glob("*.lcmlog"):
            self.check(40_000 < log.stat().st_size <= 50_000, f"{log.stat().st_size} bytes of log")
            log.unlink()
        terminal.close()

    def without_colour(self):
        self.where = "NO_COLOR"
        terminal = self.open(80, 30, environment={"NO_COLOR": "1"})
        self.begin(terminal)
        self.shows(terminal, "^LIVE: running")
        self.check(terminal.colours() == {("default", "default")}, f"colours {terminal.colours()}", terminal)
        terminal.end("q")
        terminal.close()
        self.where = "ASCII"
        terminal = self.open(80, 30, environment={"LC_ALL": "C"})
        self.begin(terminal)
        self.shows(terminal, "^LIVE: running", r"x +\+5\.2 N .*#.* 87 %", r"load +44 % #+")
        self.check(terminal.raw.isascii(), "more than ASCII is sent")
        terminal.end("q")
        terminal.close()

    def on_a_dumb_terminal(self):
        self.where = "dumb terminal"
        terminal = self.open(80, 30, environment={"TERM": "dumb"})
        terminal.read(1.0)
        run = MadeUpRun(self.publisher)
        run.begin()
        run.go_on(0.5, terminal.read)
        self.check(b"running" in terminal.raw and ENTERED not in terminal.raw, f"no lines: {terminal.raw!r}")
        self.check(terminal.end(signal.SIGINT) == 0, "does not end")
        terminal.close()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("monitor")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("--print", action="store_true", help="every screen")
    arguments = parser.parse_args()
    network.enter()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "records").mkdir()
        test = Test(arguments, network.Publisher(folder / "types", arguments.source / "lcmtypes"), folder / "records")
        for columns, rows in SIZES:
            test.all_of_one_size(columns, rows)
        test.resized()
        test.ended_by_signals()
        test.outlives_fragments()
        test.recorded()
        test.piped()
        test.ended_by_a_full_disk()
        test.without_colour()
        test.on_a_dumb_terminal()
    print(f"{test.failures} failures")
    return 1 if test.failures else 0


if __name__ == "__main__":
    sys.exit(main())
