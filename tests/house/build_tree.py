"""What the house tests ask a build tree: how each file is compiled, and which headers it used."""
import json
import os
import pathlib
import re
import shlex
import shutil
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
        """The compiler and the flags of a target, without launcher, precompiled header, input and output."""
        for entry in self.commands:
            if self.target_of(entry) == target:
                words = shlex.split(entry["command"])
                while not re.search(r"(\+\+|cc)(-\d+)?$", words[0]):
                    words.pop(0)
                words = words[: words.index("-o")]
                for i, word in enumerate(words):
                    if word == "-include" and "cmake_pch" in words[i + 1]:
                        return words[:i] + words[i + 2 :]
                return words
        return None

    def room_of(self, header):
        """The target that shows a header, given by its repository path, in its include root."""
        for root in sorted((self.path / "roots").iterdir()):
            if (root / header).exists():
                return root.name
        return None

    def preprocessed(self, target, text):
        """`text` as the preprocessor leaves it with the flags of `target`."""
        run = subprocess.run([*self.flags_of(target), "-E", "-P", "-x", "c++", "-"], input=text, text=True,
                             capture_output=True, cwd=self.path, check=True)
        return run.stdout

    def compiles(self, target, text, keep=None):
        """Compiles `text` as if it were a file of `target`. Returns (ok, messages).

        keep: a name that is the text's own. It is then compiled from a file below the build tree, through
        ccache where there is one, which knows it again.
        """
        words = [*self.flags_of(target), "-Wno-unused"]
        if keep is None:
            return self._run([*words, "-fsyntax-only", "-x", "c++", "-"], text)
        source = self.path / "house" / (re.sub(r"\W", "_", keep) + ".cpp")
        source.parent.mkdir(exist_ok=True)
        source.write_text(text, encoding="utf-8")
        launcher = [found] if (found := shutil.which("ccache")) else []
        return self._run([*launcher, *words, "-O0", "-g0", "-c", str(source), "-o", str(source) + ".o"], None)

    def _run(self, words, text):
        settings = {"CCACHE_BASEDIR": str(SOURCE), "CCACHE_NOHASHDIR": "1"}
        run = subprocess.run(words, input=text, text=True, capture_output=True, cwd=self.path, check=False,
                             env={**os.environ, **settings})
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
