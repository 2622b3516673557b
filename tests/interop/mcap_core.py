#!/usr/bin/env python3
"""MCAP files of `tenon-monitor export` as the reader of MCAP's makers, @mcap/core, has them: every checksum, counts by
stream, by index and by statistics, values of cycles found by their time, all against the log as the Python package reads
it; and what Foxglove knows by name against Foxglove's own schemas. Needs npm and its registry.

  mcap_core.py TENON_MONITOR RUNS SOURCE
"""
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

import jsonschema

from export import check_row, expected_cycle, export, run_test

HERE = pathlib.Path(__file__).resolve().parent
SEED = 20250102
TIMES = 100


def install(folder):
    """The packages by the hashes of the lock file; nobody's scripts run."""
    if shutil.which("npm") is None:
        subprocess.run([HERE.parents[1] / ".ci/setup.sh", "page"], check=True)
    for name in ("package.json", "package-lock.json", "read.js"):
        shutil.copy(HERE / "mcap_core" / name, folder)
    subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)


def start_ns_of(tenon, log):
    """When the first cycle was published: the first field of its message."""
    for event, _ in tenon.log.events(log):
        if event is not None and event.channel == "TENON_CYCLE":
            return 1000 * int.from_bytes(event.data[8:16], "big", signed=True)
    raise SystemExit(f"FAILED: {log} has no cycle")


def check_file(tenon, log, mcap, folder, failures):
    run = tenon.read_run(log)
    chosen = random.Random(SEED).sample(range(len(run.time_s)), min(TIMES, len(run.time_s)))
    start_ns = start_ns_of(tenon, log)
    times = [str(start_ns + round(1e9 * run.time_s[i])) for i in chosen]
    ended = subprocess.run(["node", "read.js", mcap, *times], cwd=folder, text=True, capture_output=True, check=False)
    if ended.returncode != 0:
        failures.check(False, f"{mcap.name}: {ended.stderr}")
        return
    found = json.loads(ended.stdout)
    streamed, indexed = found["streamed"], found["indexed"]
    failures.check(streamed["done"] is True, f"{mcap.name}: the stream does not come to its end")
    failures.check(streamed["counts"] == indexed["counts"] == indexed["told"],
                   f"{mcap.name}: {streamed['counts']} in the stream, {indexed['counts']} by index, told {indexed['told']}")
    for topic, count in (("/tenon/cycle", len(run.time_s)), ("/tenon/step", len(run.steps)),
                         ("/tenon/status", len(run.statuses)), ("/tenon/run", 1)):
        failures.check(indexed["counts"].get(topic) == count, f"{mcap.name}: {topic}: not {count}")
    failures.check(indexed["ascending"], f"{mcap.name}: by its index its messages do not ascend in time")
    failures.check(len(indexed["at"]) == len(chosen), f"{mcap.name}: {len(indexed['at'])} of {len(chosen)} times")
    for i, said in zip(chosen, indexed["at"]):
        check_row(said, expected_cycle(run, i), f"{mcap.name}: cycle {i}", failures)
    for topic, name in (("/tenon/events", "Log"), ("/tenon/frames/tool", "FrameTransform"),
                        ("/tenon/frames/commanded", "FrameTransform")):
        validator = jsonschema.Draft7Validator(found["schemas"][f"foxglove.{name}"])
        for error in validator.iter_errors(indexed["examples"][topic]):
            failures.check(False, f"{mcap.name}: {topic}: {error.message}")
    print(f"{mcap.name}: {sum(indexed['counts'].values())} messages in {indexed['chunks']} chunks, {len(chosen)} cycles "
          f"found by time, made by {indexed['library']}")


def main(failures):
    monitor, runs, source = sys.argv[1:4]
    sys.path.insert(0, str(pathlib.Path(source) / "shared/python"))
    import tenon  # pylint: disable=import-outside-toplevel
    with tempfile.TemporaryDirectory(prefix="tenon_mcap_core_") as scratch:
        folder = pathlib.Path(scratch)
        install(folder)
        subprocess.run([runs, folder], check=True, stdout=subprocess.DEVNULL)
        for name in ("box", "fault", "missed"):
            log, mcap = folder / f"{name}.lcmlog", folder / f"{name}.mcap"
            made = export(monitor, log, "--mcap", mcap)
            failures.check(made.returncode == 0, f"{name}: {made.stderr}")
            check_file(tenon, log, mcap, folder, failures)
        # A checksum that is wrong is noticed by that reader, too.
        damaged = bytearray((folder / "box.mcap").read_bytes())
        damaged[damaged.index(b'"cycle":100,')] ^= 1
        (folder / "damaged.mcap").write_bytes(damaged)
        ended = subprocess.run(["node", "read.js", folder / "damaged.mcap"], cwd=folder, text=True, capture_output=True,
                               check=False)
        failures.check(ended.returncode == 1 and "CRC" in ended.stderr, f"damaged.mcap: {ended.stderr}")


if __name__ == "__main__":
    run_test(main)
