#!/usr/bin/env python3
"""Measures the executor's real time on this machine, against the virtual arm on the same machine.

  real_time.py [--bin FOLDER] [--plan FILE] [--blocks N] [--stops N] [--json FILE]

Wake-ups: blocks of a whole run (tenon-exec, FIFO 80) and of cyclictest at the same period and priority take
turns, so that both see the same machine; each side's blocks are pooled. Printed are mean, p99, p99.9 and worst,
and the ratio of the two p99.9.

Force stop: runs in which the sensor reads 80 N more in free air, one stop each. From the executor's own record
of the frames: from when the force's frame was read to when the stop's was handed over, and, from above, from the
SYNC that asked for that force, which holds what the virtual arm and both processes' wake-ups took. The wire's own
share (the stop, and one frame that is in flight) is in neither: it is counted in bus time by ForceStopOnTheBus
in tests_hw.

Nothing is asserted. Exit status 1 where a run did not end as it should.
"""

import argparse
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
CELL = ROOT / "hw/cells/gantry3.yaml"
TASK = ROOT / "planner/tasks/box_on_table_2d.yaml"
START = "4"
PERIOD_US = 2000  # of the cell
PRIORITY = 80
SYNC_ID, FORCE_ID, STOP_ID = "080", "181", "183"
HISTOGRAM_US = 100_000


class Arm:
    """tenon-sim on a free port, for one client."""

    def __init__(self, folder, binaries, faults=()):
        ready = folder / "ready"
        ready.unlink(missing_ok=True)
        command = [binaries / "tenon-sim", "--cell", CELL, "--task", TASK, "--start", START, "--once"]
        command += ["--can", "slcan-listen://127.0.0.1:0", "--ready-file", ready]
        for fault in faults:
            command += ["--fault", fault]
        self.process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL)
        while not ready.exists() and self.process.poll() is None:
            time.sleep(0.01)
        self.uri = "slcan://" + ready.read_text().split()[-1]

    def end(self):
        self.process.terminate()
        self.process.wait()


def execute(folder, binaries, plan, faults, options):
    """One run. Returns its result.json."""
    arm = Arm(folder, binaries, faults)
    result = folder / "result.json"
    command = [binaries / "tenon-exec", "--cell", CELL, "--plan", plan, "--can", arm.uri, "--lcm-url", "none"]
    command += ["--json", result, "--black-box", folder / "box.csv", *options]
    subprocess.run(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    arm.end()
    return json.loads(result.read_text())


def logged_wakeups_us(log):
    """wakeup_late_s of every TENON_CYCLE of an LCM log (lcmtypes/cycle_state.lcm)."""
    before_joints, after_joints = 313, 4
    data = log.read_bytes()
    at, found = 0, []
    while at + 28 <= len(data):
        _, _, _, name_size, size = struct.unpack_from(">IqqII", data, at)
        name = data[at + 28 : at + 28 + name_size]
        start = at + 28 + name_size
        if name == b"TENON_CYCLE":
            joints = data[start + before_joints]
            late_s = struct.unpack_from(">d", data, start + before_joints + 1 + 16 * joints + after_joints)[0]
            found.append(1e6 * late_s)
        at = start + size
    return found


def cyclictest_us(loops):
    """Latencies of one thread at the executor's period and priority, whole microseconds."""
    command = ["cyclictest", "--quiet", "--mlockall", "--threads=1", f"--priority={PRIORITY}"]
    command += [f"--interval={PERIOD_US}", f"--loops={loops}", f"--histogram={HISTOGRAM_US}"]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = []
    for line in out.splitlines():
        bucket = re.fullmatch(r"(\d{6}) (\d+)\s*", line)
        if bucket:
            found += [float(bucket[1])] * int(bucket[2])
    worst = re.search(r"# Max Latencies: (\d+)", out)
    # What lies beyond the histogram is counted as the worst that there was.
    found += [float(worst[1])] * (loops - len(found))
    return found


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def summary(values):
    return {
        "count": len(values),
        "mean_us": sum(values) / len(values),
        "p99_us": quantile(values, 0.99),
        "p999_us": quantile(values, 0.999),
        "max_us": max(values),
    }


def line_of(name, s):
    return (
        f"{name:<34} {s['count']:>7} {s['mean_us']:>9.1f} {s['p99_us']:>9.1f} "
        f"{s['p999_us']:>9.1f} {s['max_us']:>9.1f}"
    )


def wake_ups(folder, binaries, plan, blocks):
    ours, theirs = [], []
    whole = True
    for _ in range(blocks):
        log = folder / "log"
        result = execute(folder, binaries, plan, [], ["--log", log])
        whole = whole and result["status"] == "done"
        block = logged_wakeups_us(log)
        ours += block
        theirs += cyclictest_us(len(block))
    return summary(ours), summary(theirs), whole


def stop_us(can_log):
    """From the last force, and from the last SYNC, before the stop to it; None: there was no stop."""
    heard = asked = None
    for line in can_log.read_text().splitlines():
        match = re.match(r"\((\d+)\.(\d{6})\) \S+ ([0-9A-F]{3})#", line)
        if not match:
            continue
        now_us = 1_000_000 * int(match[1]) + int(match[2])
        if match[3] == SYNC_ID:
            asked = now_us
        if match[3] == FORCE_ID:
            heard = now_us
        if match[3] == STOP_ID and heard is not None:
            return float(now_us - heard), float(now_us - asked)
    return None


def force_stops(folder, binaries, plan, stops):
    found, whole = [], True
    for i in range(stops):
        # Each at another place of the cycle and of the way.
        fault = f"forged-force:at=free,time_s={0.1 + 0.0137 * i:.4f},force_N=80,duration_s=0.01"
        can_log = folder / "frames.log"
        result = execute(folder, binaries, plan, [fault], ["--can-log", can_log])
        took_us = stop_us(can_log)
        whole = whole and result["reason"] == "force_fault" and took_us is not None
        if took_us is not None:
            found.append(took_us)
    return [summary(list(side)) for side in zip(*found)], whole


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/dev/bin")
    parser.add_argument("--plan", type=pathlib.Path, default=ROOT / "build/dev/plans/box_4_gantry3.tnp")
    parser.add_argument("--blocks", type=int, default=5, help="of each of the two, default 5")
    parser.add_argument("--stops", type=int, default=50, help="runs that end by a force, default 50")
    parser.add_argument("--json", type=pathlib.Path)
    arguments = parser.parse_args()
    figures, whole = {}, True
    print(f"{'us':<34} {'count':>7} {'mean':>9} {'p99':>9} {'p99.9':>9} {'worst':>9}")
    with tempfile.TemporaryDirectory(prefix="tenon_") as name:
        folder = pathlib.Path(name)
        if arguments.blocks:
            ours, theirs, good = wake_ups(folder, arguments.bin, arguments.plan, arguments.blocks)
            whole = whole and good
            ratio = ours["p999_us"] / theirs["p999_us"]
            print(line_of("executor's loop wakes late", ours))
            print(line_of("cyclictest", theirs))
            print(f"p99.9, executor's over cyclictest's: {ratio:.2f}", flush=True)
            figures |= {"executor": ours, "cyclictest": theirs, "p999_ratio": ratio}
        if arguments.stops:
            stops, good = force_stops(folder, arguments.bin, arguments.plan, arguments.stops)
            whole = whole and good
            if stops:
                print(line_of("force heard to stop sent", stops[0]))
                print(line_of("SYNC sent to stop sent", stops[1]))
                figures |= {"force_to_stop": stops[0], "sync_to_stop": stops[1]}
    if arguments.json:
        arguments.json.write_text(json.dumps(figures, indent=2) + "\n")
    if not whole:
        print("not all runs ended as they should: the machine was too busy", file=sys.stderr)
    return 0 if whole else 1


if __name__ == "__main__":
    sys.exit(main())
