#!/usr/bin/env python3
"""How-tos, typed word by word, one after the other in one folder: their ```yaml blocks are saved under the name in
their first line, their ```sh blocks are run in order, and every line of the ``` block that follows one must begin a
line of what was printed. Of a CI file the jobs' `script` is run as well.

  typed.py BIN SOURCE HOWTO...     in a network namespace of its own, where all ports are free

A run in real time that ended because the machine was too busy is made again.
"""
import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from how_to import BLOCK, FILES, is_job, job_commands, save  # pylint: disable=wrong-import-position

ATTEMPTS = 10
# Where the virtual arm got no time, the executor hears nobody.
EXCUSES = {"overruns", "blind", "bus_silent", "feedback_missing", "feedback_poor"}


def was_too_busy(folder):
    result = folder / "result.json"
    if not result.exists():
        return False
    said = json.loads(result.read_text())
    return said.get("arm_fault", said.get("reason", "")) in EXCUSES


def run_in_bash(text, folder, environment):
    """@return the exit status and what was printed. What a failed line leaves running in the background is ended."""
    with tempfile.TemporaryFile("w+") as said:
        bash = subprocess.Popen(["bash", "-e", "-c", text], cwd=folder, env=environment, stdout=said,
                                stderr=subprocess.STDOUT, start_new_session=True)
        status = bash.wait()
        if status != 0:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(bash.pid, signal.SIGKILL)
        said.seek(0)
        return status, said.read()


def type_in(text, folder, environment):
    """@return what it printed"""
    runs = "--can" in text
    for attempt in range(1, ATTEMPTS + 1):
        if runs:
            (folder / "result.json").unlink(missing_ok=True)
        status, said = run_in_bash(text, folder, environment)
        if status == 0:
            return said
        if not runs or not was_too_busy(folder):
            raise SystemExit(f"FAILED: status {status} of\n{text}\n{said}")
        print(f"attempt {attempt}: the machine was too busy")
        time.sleep(attempt)
    raise SystemExit(f"FAILED: always too busy for\n{text}")


def main():
    binaries, source, *howtos = sys.argv[1:]
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    environment = {**os.environ, "PATH": f"{pathlib.Path(binaries).resolve()}:{os.environ['PATH']}"}
    typed = told = 0
    with tempfile.TemporaryDirectory(prefix="tenon_howto_") as name:
        folder = pathlib.Path(name)
        for room in ("hw", "planner"):
            (folder / room).symlink_to(pathlib.Path(source).resolve() / room)
        printed = before = ""
        for kind, text in BLOCK.findall("\n".join(pathlib.Path(howto).read_text() for howto in howtos)):
            if kind in FILES:
                save(text, folder)
                for command in job_commands(text, "script") if is_job(text) else ():
                    printed = type_in(command, folder, environment)
                    typed += 1
            elif kind == "sh":
                printed = type_in(text, folder, environment)
                typed += 1
            elif before == "sh":
                lines = printed.splitlines()
                for line in text.splitlines():
                    told += 1
                    if not any(one.startswith(line) for one in lines):
                        raise SystemExit(f"FAILED: nothing begins with\n{line}\nin\n{printed}")
            before = kind
        pages = sorted(page.name for page in folder.glob("*.html"))
        print(f"{typed} blocks typed, {told} lines came as told; pages: {', '.join(pages)}")
    return 0 if typed and told else 1


if __name__ == "__main__":
    sys.exit(main())
