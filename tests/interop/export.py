#!/usr/bin/env python3
"""`tenon-monitor export` on the logs of runs that are done, fail and miss: its CSV and MCAP, each read here by a reader
that shares nothing with their writers, against the log as the Python package reads it. Damaged and broken-off logs, a
full disk, several runs in a log, and what is refused.

  export.py TENON_MONITOR RUNS SOURCE     RUNS: the program that executes the runs and writes their logs
"""
import csv
import json
import math
import pathlib
import random
import resource
import subprocess
import sys
import tempfile

import jsonschema
import numpy as np

from mcap_file import McapFile, Wrong

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from failures import run_test  # pylint: disable=wrong-import-position

SEED = 20250101
SAMPLES = 200
AXES = ("x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad")


def export(monitor, *words, limit_bytes=None):
    def limit():
        if limit_bytes is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit_bytes, resource.RLIM_INFINITY))

    return subprocess.run([monitor, "export", *map(str, words)], text=True, capture_output=True, check=False,
                          preexec_fn=limit)


def expected_cycle(run, i):
    """What a row says of cycle i, by the package; what is not known is left out."""
    values = {"time_s": run.time_s[i], "log_time_us": run.log_time_us[i], "cycle": run.cycle[i],
              "state": run.state_names[i], "state_number": run.state[i], "contact_bits": run.contact_bits[i],
              "wrench_fresh": bool(run.wrench_fresh[i]), "joints_fresh": run.joints_fresh[i],
              "wakeup_late_s": run.wakeup_late_s[i], "compute_s": run.compute_s[i], "late_cycles": run.late_cycles[i]}
    if run.step[i] >= 0:
        values["step"] = run.step[i]
        values["phase"] = ("moving", "probing", "settling", "done")[run.phase[i]]
        if run.setup is not None:
            values["contact_from_N"] = run.setup.force_on_N[run.step[i]]
            values["contact_from_Nm"] = run.setup.torque_on_Nm[run.step[i]]
    for name in ("tool", "setpoint", "commanded"):
        for axis in range(3):
            values[f"{name}_{AXES[axis]}"] = getattr(run, f"{name}_position_m")[i, axis]
        for part in range(4):
            values[f"{name}_q{'wxyz'[part]}"] = getattr(run, f"{name}_orientation_wxyz")[i, part]
    for axis in range(6):
        values[f"velocity_{AXES[axis]}ps"] = run.velocity[i, axis]
    for axis in range(3):
        values[f"force_{'xyz'[axis]}_N"] = run.force_N[i, axis]
        values[f"torque_{'xyz'[axis]}_Nm"] = run.torque_Nm[i, axis]
    for joint, (name, linear) in enumerate(zip(run.joint_names, run.joint_linear)):
        unit = "" if linear is None else "_m" if linear else "_rad"
        values[f"joint_{name}{unit}"] = run.joint_position[i, joint]
        values[f"joint_{name}_commanded{unit}"] = run.joint_commanded[i, joint]
    return {key: value for key, value in values.items() if not (isinstance(value, float) and math.isnan(value))}


def same(told, value):
    """A number exactly as it is, whatever it is written as."""
    if isinstance(value, (bool, str)):
        return told == value
    return float(told) == float(value)


def check_row(told, expected, where, failures):
    for key, value in expected.items():
        failures.check(key in told and same(told[key], value), f"{where}: {key} is {told.get(key)}, in the log {value}")


def csv_value(text):
    if text in ("true", "false"):
        return text == "true"
    return text


def check_csv(path, run, failures):
    data = path.read_bytes()
    failures.check(data.count(b"\r\n") == data.count(b"\n"), f"{path.name}: ends of lines")
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file, strict=True))
    failures.check(len(rows) == len(run.time_s), f"{path.name}: {len(rows)} rows, the log has {len(run.time_s)} cycles")
    draw = random.Random(SEED)
    for i in [0, len(rows) - 1, *draw.sample(range(len(rows)), min(SAMPLES, len(rows)))]:
        told = {key: csv_value(text) for key, text in rows[i].items() if text != ""}
        expected = expected_cycle(run, i)
        check_row(told, expected, f"{path.name}: row {i}", failures)
        optional = {"motion_s", "arm_state", "end_reason", "contacts", "records_dropped", "outcome", "event"}
        failures.check(set(told) <= set(expected) | optional, f"{path.name}: row {i} tells {set(told) - set(expected)}")
    outcomes = [row["outcome"] for row in rows if row["outcome"]]
    failures.check(outcomes == [step.outcome for step in run.steps], f"{path.name}: outcomes {outcomes}")
    for row in rows:
        if row["outcome"]:
            failures.check(row["event"].startswith("step ") or "; step " in row["event"], f"{path.name}: {row['event']}")
    failures.check(rows[0]["event"] == "waiting", f"{path.name}: begins with '{rows[0]['event']}'")
    changes = [int(i) for i in np.flatnonzero(np.diff(run.state)) + 1]
    failures.check(all(run.state_names[i] in rows[i]["event"] for i in changes), f"{path.name}: states are not told")


def check_mcap(path, run, failures):
    try:
        mcap = McapFile(path)
    except Wrong as wrong:
        failures.check(False, f"{path.name}: {wrong}")
        return None
    counts = {"/tenon/cycle": len(run.time_s), "/tenon/step": len(run.steps), "/tenon/status": len(run.statuses),
              "/tenon/run": 0 if run.summary is None else 1}
    for topic, count in counts.items():
        failures.check(len(mcap.topic(topic)) == count, f"{path.name}: {len(mcap.topic(topic))} of {topic}, not {count}")
    for _, (schema, topic, encoding, _) in mcap.channels.items():
        name, schema_encoding, text = mcap.schemas[schema]
        failures.check((encoding, schema_encoding) == ("json", "jsonschema"), f"{path.name}: {topic} is {encoding}")
        validator = jsonschema.Draft7Validator(json.loads(text))
        validator.check_schema(validator.schema)
        messages = mcap.topic(topic)
        draw = random.Random(SEED)
        for message in draw.sample(messages, min(SAMPLES, len(messages))):
            said = json.loads(message.data)
            failures.check(set(said) <= set(validator.schema["properties"]), f"{topic}: {set(said)} is not all in {name}")
            failures.check(validator.is_valid(said), f"{topic}: {said} is not of schema {name}")
    cycles = mcap.topic("/tenon/cycle")
    start = cycles[0].log_time
    for i in random.Random(SEED + 1).sample(range(len(cycles)), min(SAMPLES, len(cycles))):
        said = json.loads(cycles[i].data)
        check_row(said, expected_cycle(run, i), f"{path.name}: cycle {i}", failures)
        since = round(1e9 * run.time_s[i])
        failures.check(cycles[i].log_time - start == since, f"{path.name}: cycle {i} at {cycles[i].log_time - start} ns")
        failures.check(cycles[i].sequence == i, f"{path.name}: cycle {i} has number {cycles[i].sequence}")
    for message, step in zip(mcap.topic("/tenon/step"), run.steps):
        said = json.loads(message.data)
        check_row(said, {"step": step.step, "outcome": step.outcome, "next": str(step.successor), "time_s": step.time_s,
                         "duration_s": step.duration_s, "peak_force_N": step.peak_force_N,
                         **{f"travelled_{key}": value for key, value in zip(AXES, step.travelled)}},
                  f"{path.name}: step {step.step}", failures)
    check_frames(mcap, run, start, failures)
    return mcap


def check_frames(mcap, run, start, failures):
    """Frames are poses of cycles, about fifty a second."""
    frames = mcap.topic("/tenon/frames/tool")
    by_time = {round(1e9 * time): i for i, time in enumerate(run.time_s)}
    for message in frames:
        said = json.loads(message.data)
        i = by_time[message.log_time - start]
        told = [said["translation"][key] for key in "xyz"] + [said["rotation"][key] for key in "wxyz"]
        held = [*run.tool_position_m[i], *run.tool_orientation_wxyz[i]]
        failures.check(told == held, f"frame of cycle {i}: {told}, in the log {held}")
        stamp = said["timestamp"]["sec"] * 10**9 + said["timestamp"]["nsec"]
        failures.check(stamp == message.log_time, f"frame of cycle {i}: {stamp} ns in a message of {message.log_time} ns")
    known = run.time_s[~np.isnan(run.tool_position_m[:, 0])]
    least = (known[-1] - known[0]) / 0.022
    failures.check(least < len(frames) <= (known[-1] - known[0]) / 0.02 + 2, f"{len(frames)} frames")


def told_events(mcap):
    return [(json.loads(message.data)["level"], json.loads(message.data)["message"]) for message in mcap.topic("/tenon/events")]


def check_whole(monitor, folder, tenon, failures):
    for name in ("box", "fault", "missed"):
        log = folder / f"{name}.lcmlog"
        made = export(monitor, log, "--csv", folder / f"{name}.csv", "--mcap", folder / f"{name}.mcap")
        failures.check(made.returncode == 0 and not made.stderr, f"{name}: {made.stderr}")
        print(made.stdout, end="")
        run = tenon.read_run(log)
        check_csv(folder / f"{name}.csv", run, failures)
        mcap = check_mcap(folder / f"{name}.mcap", run, failures)
        if mcap is None:
            continue
        events = told_events(mcap)
        result = json.loads((folder / f"{name}.json").read_text())
        word = "done" if result["status"] == "done" else "failed"
        failures.check(events[-1][1] == f"{word}: {result['message']}", f"{name}: ends with {events[-1]}")
        failures.check((events[-1][0] == 4) == (word == "failed"), f"{name}: ends at level {events[-1][0]}")
        failures.check(mcap.metadata["tenon"]["log"] == log.name and "notes" not in mcap.metadata["tenon"],
                       f"{name}: metadata {mcap.metadata}")
        failures.check(mcap.library.startswith("tenon ") and mcap.profile == "", f"{name}: made by '{mcap.library}'")
    print(f"box.mcap: {McapFile(folder / 'box.mcap').chunk_count} chunks")


def check_in_part(monitor, folder, tenon, failures):
    """A log is read as far as it goes, and that is said: exit status 1, in the MCAP's metadata too."""
    whole = (folder / "box.lcmlog").read_bytes()
    sync = b"\xed\xa1\xda\x01"
    middle = whole.index(sync, len(whole) // 2)
    damaged = bytearray(whole)
    damaged[middle] ^= 0xFF
    garbled = bytearray(whole)
    garbled[whole.index(b"TENON_STATUS", middle) + len("TENON_STATUS")] ^= 0xFF  # of the type's hash
    for name, data, words in (("cut", whole[:middle + 100], "breaks off within a message after"),
                              ("damaged", damaged, f"byte {middle}: no event of an LCM log begins here"),
                              ("garbled", garbled, "1 messages make no sense and are left out")):
        log = folder / f"{name}.lcmlog"
        log.write_bytes(data)
        made = export(monitor, log, "--csv", folder / f"{name}.csv", "--mcap", folder / f"{name}.mcap")
        failures.check(made.returncode == 1, f"{name}: exit status {made.returncode}")
        failures.check(words in made.stderr and made.stderr.count("\n") == 1, f"{name}: says '{made.stderr}'")
        read = tenon.read_log(log)
        check_csv(folder / f"{name}.csv", read.runs[-1], failures)
        mcap = check_mcap(folder / f"{name}.mcap", read.runs[-1], failures)
        failures.check(mcap is not None and words in mcap.metadata["tenon"]["notes"], f"{name}: its metadata does not say")
        failures.check((read.breaks_off, read.damage is not None, read.malformed) ==
                       (name == "cut", name == "damaged", int(name == "garbled")), f"{name}: the package reads {read}")
    # Between two messages nothing breaks off: the run goes on, the log does not.
    (folder / "early.lcmlog").write_bytes(whole[:middle])
    made = export(monitor, folder / "early.lcmlog", "--csv", folder / "early.csv")
    failures.check(made.returncode == 0 and "ends before the run does" in made.stdout, f"early: {made.stdout}{made.stderr}")


def check_several(monitor, folder, tenon, failures):
    log = folder / "two.lcmlog"
    log.write_bytes((folder / "box.lcmlog").read_bytes() + (folder / "missed.lcmlog").read_bytes())
    read = tenon.read_log(log)
    failures.check(len(read.runs) == 2, f"two: the package reads {len(read.runs)} runs")
    for options, alone in (((), "missed"), (("--run", 1), "box"), (("--run", 2), "missed")):
        made = export(monitor, log, "--csv", folder / "two.csv", *options)
        failures.check(made.returncode == 0, f"two {options}: {made.stderr}")
        failures.check(("holds 2 runs" in made.stdout) == (not options), f"two {options}: says '{made.stdout}'")
        failures.check((folder / "two.csv").read_bytes() == (folder / f"{alone}.csv").read_bytes(),
                       f"two {options}: is not {alone}")
    # Without its setup, as who listens late has it: joints by their numbers, no thresholds.
    whole = (folder / "box.lcmlog").read_bytes()
    bare = whole.replace(b"TENON_SETUP", b"OTHER_SETUP")
    (folder / "bare.lcmlog").write_bytes(bare)
    made = export(monitor, folder / "bare.lcmlog", "--csv", folder / "bare.csv", "--mcap", folder / "bare.mcap")
    failures.check(made.returncode == 0 and "does not name the joints" in made.stdout, f"bare: {made.stdout}{made.stderr}")
    run = tenon.read_run(folder / "bare.lcmlog")
    check_csv(folder / "bare.csv", run, failures)
    check_mcap(folder / "bare.mcap", run, failures)


def check_refusals(monitor, folder, failures):
    log = folder / "box.lcmlog"
    (folder / "text.lcmlog").write_text("time,force\n0,1\n")
    (folder / "none.lcmlog").write_bytes(log.read_bytes()[:20])
    for words, said, status in (
            ((log,), "nothing to write", 2),
            ((log, "--csv", "-"), "give the name of a file", 2),
            ((log, "--csv", log), "is the same file as", 2),
            ((log, "--csv", folder / "a", "--mcap", folder / "a"), "is the same file as", 2),
            ((log, "--csv", folder / "no" / "a.csv"), "cannot be written: No such file or directory", 2),
            ((log, "--mcap", "/dev/null"), "not a regular file", 2),
            ((folder / "lost.lcmlog", "--csv", folder / "a.csv"), "cannot be read: No such file", 2),
            ((folder / "text.lcmlog", "--csv", folder / "a.csv"), "is no LCM log", 2),
            ((folder / "none.lcmlog", "--csv", folder / "a.csv"), "holds no cycle of a run", 2),
            ((log, "--csv", folder / "a.csv", "--run", 2), "has no run 2: it holds 1", 2),
            ((log, "--cvs", folder / "a.csv"), "--csv", 2)):
        made = export(monitor, *words)
        failures.check(made.returncode == status, f"{words}: exit status {made.returncode}")
        failures.check(said in made.stderr and made.stderr.count("\n") == 1, f"{words}: says '{made.stderr}'")
        failures.check(not list(folder.glob("a*")), f"{words}: leaves {list(folder.glob('a*'))}")
    # A disk that takes no more: one line, the old file as it was, nothing else.
    for option in ("--csv", "--mcap"):
        old = folder / "old"
        old.write_text("as it was")
        made = export(monitor, log, option, old, limit_bytes=600_000)
        failures.check(made.returncode == 1, f"full disk, {option}: exit status {made.returncode}")
        failures.check(made.stderr == f"tenon-monitor: {old}: cannot be written: File too large\n",
                       f"full disk, {option}: says '{made.stderr}'")
        failures.check(old.read_text() == "as it was" and not list(folder.glob("old.*")), f"full disk, {option}: leaves files")


def check_reader(folder, failures):
    """The reader of this test finds any byte that is another one, but in texts that nothing covers."""
    whole = (folder / "fault.mcap").read_bytes()
    draw = random.Random(SEED)
    path = folder / "flipped.mcap"
    for i in draw.sample(range(len(whole)), 40):
        flipped = bytearray(whole)
        flipped[i] ^= 1 << draw.randrange(8)
        path.write_bytes(flipped)
        try:
            McapFile(path)
            failures.check(False, f"flipped.mcap: byte {i} is another one, and nobody notices")
        except (Wrong, UnicodeDecodeError):
            pass


def main(failures):
    monitor, runs, source = sys.argv[1:4]
    sys.path.insert(0, str(pathlib.Path(source) / "shared/python"))
    import tenon  # pylint: disable=import-outside-toplevel
    with tempfile.TemporaryDirectory(prefix="tenon_interop_") as scratch:
        folder = pathlib.Path(scratch)
        subprocess.run([runs, folder], check=True, stdout=subprocess.DEVNULL)
        check_whole(monitor, folder, tenon, failures)
        check_in_part(monitor, folder, tenon, failures)
        check_several(monitor, folder, tenon, failures)
        check_refusals(monitor, folder, failures)
        check_reader(folder, failures)


if __name__ == "__main__":
    run_test(main)
