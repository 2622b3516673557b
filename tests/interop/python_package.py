#!/usr/bin/env python3
"""The Python package against what the programs say of the same files: plans field by field, and, of plans with a byte
changed and the checksum made right again, what is refused, at which byte, by which name. Its tables of messages against
lcmtypes/. Results, truths, its errors, and the example of its README.

  python_package.py BIN RUNS SOURCE PLANS     RUNS: the program that executes the runs and writes their logs
"""
import json
import os
import pathlib
import random
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np

from export import run_test

SEED = 20250103
EDITS = 150  # of each of two plans


def dumped_plan(source):
    """The bytes of FORMAT.md's example."""
    text = (source / "shared/plan/FORMAT.md").read_text()
    lines = re.findall(r"^[0-9a-f]{4}  ((?:[0-9a-f]{2} ?)+)", re.search(r"```dump\n(.*?)```", text, re.S)[1], re.M)
    return bytes.fromhex(" ".join(lines))


def resealed(tenon, data):
    """With the checksum that the bytes have."""
    return bytes(data[:-4]) + struct.pack("<I", tenon.plan.crc32c(data[:-4]))


def refusal(read, *arguments):
    """The FileError, or None."""
    from tenon import FileError  # pylint: disable=import-outside-toplevel
    try:
        read(*arguments)
        return None
    except FileError as error:
        return error


def check_documented(tenon, source, failures):
    data = dumped_plan(source)
    plan = tenon.plan.decode_plan(data)
    failures.check(plan.task_name == "box_on_table_2d" and plan.task_hash == 0x32C5A4C03D383653, "the example's header")
    failures.check(np.array_equal(plan.displacements, np.float32([[-0.25, 0, 0, 0, 0, 0], [0, -0.25, 0, 0, 0, 0],
                                                                  [0.7, 0.2, 0, 0, 0, 0]])), "the example's displacements")
    failures.check(plan.steps[1].outcomes["contact"].always == "+x +y", "the example's contacts")
    failures.check(plan.thresholds("force_on_N").tolist() == [6, 6, 6], "the example's thresholds")
    for size in range(len(data)):
        failures.check(refusal(tenon.plan.decode_plan, data[:size]) is not None, f"{size} bytes of the example are a plan")
    for i in range(len(data)):
        flipped = bytearray(data)
        flipped[i] ^= 1 << i % 8
        failures.check(refusal(tenon.plan.decode_plan, bytes(flipped)) is not None, f"byte {i} of the example is another")
    failures.check(tenon.plan.crc32c(b"123456789") == 0xE3069283, "CRC-32C of 123456789")


def check_against_inspect(tenon, inspect, file, failures):
    told = json.loads(subprocess.run([inspect, file, "--json", "-"], capture_output=True, check=True).stdout)
    plan = tenon.read_plan(file)
    name = file.name
    same = {"task": plan.task_name, "task_hash": f"{plan.task_hash:016x}", "start_name": plan.start_name,
            "method": plan.method, "coordinates": plan.coordinates, "goal_tolerance_m": plan.goal_tolerance_m,
            "force_limit_N": plan.force_limit_N, "torque_limit_Nm": plan.torque_limit_Nm,
            "contact_stiffness_Npm": plan.contact_stiffness_Npm, "latency_max_s": plan.latency_max_s, "cost": plan.cost,
            "bound": plan.bound, "draws": plan.draws, "draws_at_goal": plan.draws_at_goal,
            "check_envelopes": plan.check_envelopes}
    for key, value in same.items():
        failures.check(told[key] == value, f"{name}: {key} = {value}, tenon-inspect says {told[key]}")
    failures.check(plan.goal_axis_tolerances.tolist() == told.get("goal_axis_tolerances", [0.0] * 6)
                   and plan.goal_free_axes == told.get("goal_free_axes", "none"), f"{name}: the goal's axes")
    compliance = {key: getattr(plan, key) for key in told["compliance"] if key != "axes"}
    failures.check({**compliance, "axes": plan.compliant_axes} == told["compliance"], f"{name}: compliance")
    for which in ("start", "goal"):
        failures.check(told[which]["position_m"] == getattr(plan, f"{which}_position_m").tolist(), f"{name}: {which}")
        q = getattr(plan, f"{which}_orientation_wxyz")
        turned = 2 * np.arctan2(np.linalg.norm(q[1:]), abs(q[0]))
        failures.check(abs(turned - np.linalg.norm(told[which]["rotation_rad"])) < 1e-9, f"{name}: {which}'s orientation")
    failures.check(len(plan.parameter_sets) == len(told["parameter_sets"]), f"{name}: parameter sets")
    for mine, theirs in zip(plan.parameter_sets, told["parameter_sets"]):
        failures.check({key: getattr(mine, key) for key in theirs} == theirs, f"{name}: {mine}, told {theirs}")
    failures.check(len(plan.steps) == len(told["steps"]), f"{name}: steps")
    for mine, theirs in zip(plan.steps, told["steps"]):
        outcomes = {outcome: {"successor": rule.successor, "travelled_min": rule.travelled_min.tolist(),
                              "travelled_max": rule.travelled_max.tolist(),
                              "place_min": rule.place_min.tolist(),
                              "place_max": rule.place_max.tolist(), "always": rule.always,
                              "possible": rule.possible} for outcome, rule in mine.outcomes.items()}
        made = {"displacement": mine.displacement.tolist(), "slow_from_m": mine.slow_from_m,
                "parameter_set": mine.parameter_set, "outcomes": outcomes}
        failures.check(made == theirs, f"{name}: step {made}, tenon-inspect says {theirs}")
    return plan.version


def edited(draw, data):
    """A plan's bytes with a field or two made into something else."""
    data = bytearray(data)
    at = draw.choice((draw.randrange(6, 8), draw.randrange(12, len(data) - 4), draw.randrange(12, len(data) - 4)))
    if draw.random() < 0.5:
        data[at] ^= 1 << draw.randrange(8)
    elif draw.random() < 0.5:
        data[at] = draw.choice((0, 1, 2, 0x7F, 0x80, 0xC8, 0xC9, 0xFE, 0xFF))
    else:
        at = min(at, len(data) - 8)
        data[at:at + 4] = struct.pack("<f", draw.choice((0.0, -1.0, 1e9, float("nan"), float("inf"), 1e-12, 9.5)))
    return data


def check_refusals_alike(tenon, inspect, folder, file, failures):
    """@return how many edits were refused"""
    draw = random.Random(SEED)
    whole = file.read_bytes()
    path = folder / "edited.tnp"
    refused = 0
    for _ in range(EDITS):
        data = resealed(tenon, edited(draw, whole))
        path.write_bytes(data)
        said = subprocess.run([inspect, path], capture_output=True, text=True, check=False)
        error = refusal(tenon.read_plan, path)
        failures.check((error is None) == (said.returncode == 0),
                       f"{file.name}: the package says {error}, tenon-inspect {said.stderr or 'nothing'}")
        if error is None or said.returncode == 0:
            continue
        refused += 1
        byte, field = re.search(r": byte (\d+), ([a-z_A-Z0-9]+):", said.stderr).groups()
        mine = error.what.split(":")[0]
        if field == "thresholds":  # its name there for the six together
            failures.check(re.match(r"(force|torque)_(on|keep|off)", mine), f"{file.name}: {error}, there {said.stderr}")
        elif field != "step_count":  # which looks ahead there
            failures.check((error.byte, mine) == (int(byte), field), f"{file.name}: {error}, there {said.stderr}")
    return refused


def check_message_tables(tenon, source, failures):
    files = {"cycle_state": "CYCLE", "step_event": "STEP", "run_setup": "SETUP", "run_status": "STATUS",
             "run_summary": "SUMMARY"}
    failures.check({path.stem for path in (source / "lcmtypes").glob("*.lcm")} == set(files), "message types")
    for stem, table in files.items():
        text = re.sub(r"//.*", "", (source / f"lcmtypes/{stem}.lcm").read_text())
        fields = []
        for kind, name, dimensions in re.findall(r"^\s*(\w+)\s+(\w+)((?:\[\w+\])*);", text.partition("{")[2], re.M):
            sizes = [int(size) if size.isdigit() else size for size in re.findall(r"\[(\w+)\]", dimensions)]
            fields.append((kind, name, *sizes))
        failures.check(tuple(fields) == getattr(tenon.messages, table), f"{stem}.lcm: {table} says another thing")


def check_results(tenon, folder, failures):
    for name in ("box", "fault", "missed"):
        result = tenon.read_result(folder / f"{name}.json")
        told = json.loads((folder / f"{name}.json").read_text())
        run = tenon.read_run(folder / f"{name}.lcmlog")
        failures.check(result.status == told["status"] and result.cycle.cycles == len(run.time_s), f"{name}: result")
        failures.check(len(result.steps) == len(run.steps), f"{name}: {len(result.steps)} steps, the log {len(run.steps)}")
        if result.steps:
            failures.check(np.array_equal(result.steps.array("travelled"), run.steps.array("travelled")) and
                           result.steps.array("travelled").shape == (len(told["steps"]), 6), f"{name}: travelled")
        failures.check(run.summary.message == told["message"], f"{name}: {run.summary.message}")
        peak_N = np.nanmax(np.linalg.norm(run.force_N, axis=1))
        failures.check(abs(peak_N - told["peak_force_N"]) < 1e-9, f"{name}: {peak_N} N, told {told['peak_force_N']} N")
        failures.check(run.joint_names == ("x", "y", "z") and run.joint_linear == (True,) * 3, f"{name}: {run.joint_names}")


def check_docstrings(tenon, run, failures):
    """Every field is told by its class, and every shape that is told is the array's."""
    for kind in (tenon.Run, tenon.Log, tenon.Plan, tenon.Step, tenon.ParameterSet, tenon.OutcomeRule):
        for field in kind.__dataclass_fields__:
            failures.check(re.search(rf"^ {{8}}{field}\b", kind.__doc__, re.M), f"{kind.__name__}'s text lacks {field}")
    sizes = {"N": len(run.time_s), "J": len(run.joint_names)}
    told = re.findall(r"^ {8}(\w+): \((N(?:, ?\w+)?),?\)", tenon.Run.__doc__, re.M)
    for name, shape in told:
        wanted = tuple(sizes.get(size) or int(size) for size in shape.replace(" ", "").split(","))
        failures.check(getattr(run, name).shape == wanted, f"Run.{name} is {getattr(run, name).shape}, told {wanted}")
    failures.check(len(told) == 24, f"the shapes of {len(told)} arrays are told")


def make_truth(sim, source, file):
    """A virtual arm that is stopped as soon as it is there."""
    ready = file.with_suffix(".ready")
    arm = subprocess.Popen([sim, "--cell", source / "hw/cells/gantry3.yaml", "--task",
                            source / "planner/tasks/box_on_table_2d.yaml", "--start", "4", "--seed", "3", "--can",
                            "slcan-listen://127.0.0.1:0", "--ready-file", ready, "--json", file],
                           stdout=subprocess.DEVNULL)
    while not ready.exists() and arm.poll() is None:
        time.sleep(0.01)
    arm.send_signal(signal.SIGINT)
    arm.wait(60)


def check_truth(tenon, file, failures):
    truth = tenon.read_truth(file)
    told = json.loads(file.read_text())
    failures.check(truth.offset.shape == (6,) and truth.offset.tolist() == list(told["offset"].values()), "truth: offset")
    failures.check(truth.error.tolist() == list(told["error"].values()), "truth: error")
    failures.check(truth.seed == 3 and truth.start == "4" and len(truth.events) == len(told["events"]), "truth")
    failures.check(truth.drives.array("position").shape == (3,), "truth: drives")


def check_errors(tenon, folder, failures):
    log = (folder / "box.lcmlog").read_bytes()
    files = {
        "text.lcmlog": b"time,force\n", "none.lcmlog": log[:20], "half.json": b'{"status": "do', "list.json": b"[]",
        "other.json": b'{"task": "a"}', "binary.json": b'{"a": "\xff"}',
    }
    for name, data in files.items():
        (folder / name).write_bytes(data)
    for read, name, words, byte in (
            (tenon.read_run, "text.lcmlog", "is no LCM log", 0), (tenon.read_run, "none.lcmlog", "holds no cycle", None),
            (tenon.read_run, "lost.lcmlog", "cannot be read: No such file", None),
            (tenon.read_plan, "text.lcmlog", "a plan has at least", 0), (tenon.read_plan, "box.lcmlog", "a plan begins with", 0),
            (tenon.read_result, "half.json", "is no whole JSON", 11), (tenon.read_result, "list.json", "must be an object", None),
            (tenon.read_result, "other.json", "status is missing; give the file that tenon-exec wrote", None),
            (tenon.read_result, "binary.json", "is no text", 7),
            (tenon.read_truth, "other.json", "start is missing; give the file that tenon-sim wrote", None)):
        error = refusal(read, folder / name)
        failures.check(error is not None and words in str(error) and str(folder / name) in str(error) and error.byte == byte,
                       f"{name}: {error}")
    (folder / "cut.lcmlog").write_bytes(log[:len(log) // 2 + 1])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = tenon.read_run(folder / "cut.lcmlog")
    said = [str(entry.message) for entry in caught if issubclass(entry.category, tenon.LogWarning)]
    failures.check(len(said) == 1 and "breaks off within a message" in said[0], f"cut.lcmlog: warns {said}")
    failures.check(run.summary is None and len(run.time_s) > 100, "cut.lcmlog: is not read as far as it goes")
    # Whatever a message's bytes are, it is read or counted.
    draw = random.Random(SEED)
    garbled = bytearray(log[:40_000])
    for _ in range(300):
        at = draw.randrange(28, len(garbled))
        kept, garbled[at] = garbled[at], draw.randrange(256)
        (folder / "garbled.lcmlog").write_bytes(garbled)
        refusal(tenon.read_log, folder / "garbled.lcmlog")
        garbled[at] = kept


def check_example(source, folder, plan, failures):
    """As its reader types it: in a folder with the run's files, the package on the path."""
    example = re.search(r"```python\n(.*?)```", (source / "shared/python/README.md").read_text(), re.S)[1]
    for name, file in (("plan.tnp", plan), ("run.lcmlog", folder / "box.lcmlog"), ("result.json", folder / "box.json")):
        (folder / name).write_bytes(file.read_bytes())
    ended = subprocess.run([sys.executable, "-B", "-c", example], cwd=folder, text=True, capture_output=True, check=False,
                           env={**os.environ, "PYTHONPATH": str(source / "shared/python")})
    failures.check(ended.returncode == 0 and "box_on_table_2d: done after" in ended.stdout and "step 0: " in ended.stdout,
                   f"the example of the README: {ended.stdout}{ended.stderr}")
    print(ended.stdout, end="")


def make_baselines(tenon_plan, source, folder):
    """Plans with a rotation and without envelopes: one of version 2, and of 4 where the goal's axes differ."""
    task = source / "planner/tasks/box_on_table_se2.yaml"
    own = folder / "own_axes.yaml"
    own.write_text(task.read_text().replace("  tolerance_m: 2e-3\n",
                                            "  tolerance_m: 2e-3\n  tolerances: {x_m: 4e-3}\n  free: [rz]\n"))
    files = []
    for source_file in (task, own):
        files.append(folder / f"{source_file.stem}.tnp")
        subprocess.run([tenon_plan, source_file, "--method", "single-particle", "-o", files[-1]], check=True,
                       stdout=subprocess.DEVNULL)
    return files


def main(failures):
    programs, runs, source, plans = pathlib.Path(sys.argv[1]), *sys.argv[2:3], *map(pathlib.Path, sys.argv[3:5])
    sys.path.insert(0, str(source / "shared/python"))
    import tenon  # pylint: disable=import-outside-toplevel
    inspect = programs / "tenon-inspect"
    with tempfile.TemporaryDirectory(prefix="tenon_python_") as scratch:
        folder = pathlib.Path(scratch)
        check_documented(tenon, source, failures)
        check_message_tables(tenon, source, failures)
        files = sorted(plans.glob("*.tnp")) + make_baselines(programs / "tenon-plan", source, folder)
        versions = {file: check_against_inspect(tenon, inspect, file, failures) for file in files}
        failures.check(set(versions.values()) == {1, 2, 3, 4}, f"plans of versions {set(versions.values())}")
        for version in (1, 2, 3, 4):
            file = next(file for file in files if versions[file] == version)
            refused = check_refusals_alike(tenon, inspect, folder, file, failures)
            print(f"{file.name}, version {version}: {refused} of {EDITS} edits are refused, by both at the same byte")
            failures.check(refused > EDITS / 10, f"{file.name}: only {refused} edits are refused")
        subprocess.run([runs, folder], check=True, stdout=subprocess.DEVNULL)
        check_results(tenon, folder, failures)
        check_docstrings(tenon, tenon.read_run(folder / "box.lcmlog"), failures)
        make_truth(programs / "tenon-sim", source, folder / "truth.json")
        check_truth(tenon, folder / "truth.json", failures)
        check_errors(tenon, folder, failures)
        check_example(source, folder, plans / "box_4_gantry3.tnp", failures)
    return f"{len(files)} plans"


if __name__ == "__main__":
    run_test(main)
