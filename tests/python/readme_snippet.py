"""Runs the python example of sim/README.md as it stands there, beside a virtual arm on its port.

    readme_snippet.py README SIM CELL TASK      in a network namespace of its own, see the test

Exit status 0 where the example prints what its comment says.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import time


def main():
    readme, sim, cell, task = sys.argv[1:]
    example = re.search(r"```python\n(.*?)```", pathlib.Path(readme).read_text(), re.DOTALL)[1]
    port = re.search(r"127\.0\.0\.1:(\d+)", example)[1]
    identifier, data = re.search(r"# ([0-9A-F]{3}): ((?:[0-9A-F]{2} ?)+)", example).groups()

    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    with tempfile.TemporaryDirectory() as folder:
        ready = pathlib.Path(folder) / "ready"
        arm = subprocess.Popen(
            [sim, "--cell", cell, "--task", task]
            + ["--can", f"slcan-listen://127.0.0.1:{port}", "--ready-file", str(ready)],
            stdout=subprocess.DEVNULL,
        )
        try:
            while not ready.exists() and arm.poll() is None:
                time.sleep(0.01)
            output = subprocess.run(
                [sys.executable, "-c", example], capture_output=True, text=True, timeout=60
            )
        finally:
            arm.terminate()
            arm.wait()
    print(output.stdout, output.stderr)
    said = re.search(r"ID:\s+0*([0-9A-Fa-f]+)\s.*DL:\s*\d\s+((?:[0-9a-f]{2} ?)+)", output.stdout)
    if not said:
        sys.exit("the example printed no frame")
    if (said[1].upper(), said[2].upper().strip()) != (identifier, data.strip()):
        sys.exit(f"the example printed {said[0]}, and its comment says {identifier}: {data}")


if __name__ == "__main__":
    main()
