"""What the house tests ask a build tree: how each file is compiled, and which headers it used."""
import json
import os
import pathlib
import shlex
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("shared", "planner", "executor", "hw", "sim")


class BuildTree:
    def __init__(self, path):
        self.path = pathlib.Path(path).resolve()
        with open(self.path / "compile_commands.json", encoding="utf-8") as stream:
            self.commands = json.load(stream)

    def target_of(self, entry):
        """The CMake target that an entry belongs to: .../CMakeFiles/TARGET.dir/..."""
        output = entry["command"].split(" -o ", 1)[1]
        return output.split("CMakeFiles/", 1)[1].split(".dir/", 1)[0]

    def flags_of(self, target):
        """The compiler and the flags of a target, without input, output and launcher."""
        for entry in self.commands:
            if self.target_of(entry) == target:
                words = shlex.split(entry["command"])
                if os.path.basename(words[0]) == "ccache":
                    words = words[1:]
                output = words.index("-o")
                return words[:output]
        return None

    def compiles(self, target, text, folder):
        """Compiles `text` as if it were a file of `target`. Returns (ok, messages)."""
        run = subprocess.run(
            [*self.flags_of(target), "-Wno-unused", "-fsyntax-only", "-x", "c++", "-"],
            input=text, text=True, capture_output=True, cwd=SOURCE / folder, check=False)
        return run.returncode == 0, run.stderr

    def dependencies(self):
        """Pairs (target, object file, set of absolute paths of the files that it was made from)."""
        run = subprocess.run(["ninja", "-C", str(self.path), "-t", "deps"], text=True,
                             capture_output=True, check=True)
        result = []
        for block in run.stdout.split("\n\n"):
            lines = [line for line in block.splitlines() if line and "Entering directory" not in line]
            if not lines or "CMakeFiles/" not in lines[0]:
                continue
            name = lines[0].split(":", 1)[0]
            target = name.split("CMakeFiles/", 1)[1].split(".dir/", 1)[0]
            files = {os.path.normpath(self.path / line.strip()) for line in lines[1:]}
            result.append((target, name, files))
        return result
