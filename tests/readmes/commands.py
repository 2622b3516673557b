#!/usr/bin/env python3
"""Every command of the READMEs and how-tos: typed here word by word, or run by a test that is named, or exempt for a
reason that is printed. A command that nobody has thought of fails, and so does a word about a command that no document
has. What a how-to marks as typed (```sh) tests/howto types, and it has to know the how-to.

  commands.py BIN RUNS SOURCE BUILD          types what takes seconds
  commands.py BIN RUNS SOURCE BUILD --slow   types what takes minutes

Links of all documents lead somewhere.

RUNS: the program that executes the runs and writes their logs. Commands are typed in a folder that looks like a clone,
with the programs on the path and plan.tnp, run.lcmlog and result.json as the READMEs' commands before them leave them.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from how_to import BLOCK, DRAWN, FILES, file_name, is_job, job_commands  # pylint: disable=wrong-import-position
from markdown_links import dead_links  # pylint: disable=wrong-import-position

STARTS = re.compile(r"(\./|build/|sim/|tests/|tenon-|cmake |ctest |apt-get |ip link |slcand |parallel |sbatch |mkdir |unshare "
                    r"|lcm-gen |[A-Z_]+=\S)")
FOLDERS = ("planner", "executor", "hw", "sim", "shared", "lcmtypes", "tests")
# No documents for those who use it: what has been, and files byte by byte.
NO_HOW_TOS = {"CHANGELOG.md", "PROTOCOL.md", "FORMAT.md"}

# The plan of the READMEs is one that the build makes by the READMEs' own words, see tests/plans/CMakeLists.txt.
PLAN = "box_4_gantry3"
PLANNED = "tenon-plan planner/tasks/box_on_table_2d.yaml --start 4 --cell hw/cells/gantry3.yaml -o plan.tnp"

TYPED = {
    "tenon-plan --check planner/tasks/box_on_table_2d.yaml --report task.html": "task.html",
    "tenon-inspect plan.tnp": None,
    "tenon-inspect plan.tnp --task planner/tasks/box_on_table_2d.yaml --cell hw/cells/gantry3.yaml --report plan.html":
        "plan.html",
    "tenon-inspect plan.tnp --task planner/tasks/box_on_table_2d.yaml --cell hw/cells/gantry3.yaml "
    "--run result.json --log run.lcmlog --report run.html": "run.html",
    "tenon-inspect plan.tnp --recertify planner/tasks/box_on_table_2d.yaml --cell hw/cells/gantry3.yaml": None,
    "tenon-exec --cell hw/cells/gantry3.yaml --plan plan.tnp --dry-run": None,
    "tenon-monitor --lcm-url 'file://run.lcmlog?speed=4'": None,
    "tenon-inspect plan.tnp --log run.lcmlog --report run.html": "run.html",
    "tenon-monitor export run.lcmlog --csv run.csv --mcap run.mcap": "run.mcap",
    "lcm-gen --cpp lcmtypes/*.lcm": None,
    "tenon-can check hw/robots/gantry3/robot.yaml": None,
}
SLOW = {
    PLANNED: "plan.tnp",
    "tenon-plan planner/tasks/box_on_table_2d.yaml --start 5 --method contact-greedy -o greedy.tnp": "greedy.tnp",
    "tenon-evaluate --cell hw/cells/gantry3.yaml --task planner/tasks/box_on_table_2d.yaml --plan plan.tnp "
    "--experiment sim/experiments/box_on_table.yaml -n 1000 --seed 1 --threads 2 --json out.json --report out.html":
        "out.html",
}
# By this test, in its own way of getting there.
BY_TEST = {
    "./demo.sh": "package.DebianPackagesRunTheDemoInACleanRoot",
    "cmake --install build/release --prefix /usr/local": "package.InstalledProgramsAndLibrariesServeAnotherProject",
    'DEBFULLNAME="Your Name" DEBEMAIL=you@your.org cpack --config build/release/CPackConfig.cmake -B build/packages':
        "package.DebianPackagesRunTheDemoInACleanRoot",
    "apt-get install ./build/packages/*.deb": "package.DebianPackagesRunTheDemoInACleanRoot",
    "apt-get install ./build/packages/python3-tenon_*.deb": "package.DebianPackagesRunTheDemoInACleanRoot",
    "tenon-sim --cell hw/cells/gantry3.yaml --task planner/tasks/box_on_table_2d.yaml --start 4 --seed 1 "
    "--can slcan-listen://127.0.0.1:29536 --json truth.json": "readmes.TheVirtualArmAndItsExecutor",
    "tenon-exec --cell hw/cells/gantry3.yaml --plan plan.tnp --can slcan://127.0.0.1:29536 --log run.lcmlog "
    "--json result.json": "readmes.TheVirtualArmAndItsExecutor",
    "tenon-monitor": "monitor.TheDashboardBesideARealRun",
    "tenon-plan --new-task plug.stl socket.obj --uniform-mm 2 -o task.yaml": "planning.Assemblies",
    "tenon-plan task.yaml -o plan.tnp": "planning.Assemblies",
    "sim/experiments/assemblies.sh FOLDER": "planning.Assemblies",
}
# (pattern, reason)
EXEMPT = [
    (r"\./test\.sh.*", "runs all tests, this one among them"),
    (r"ctest .*", "runs tests, this one among them"),
    (r"cmake --(preset|build) .*", "how this build was made"),
    (r"build/\S+/bin/(tests|bench|paper)_\w+.*", "a test program, a benchmark or a study of this build by its name"),
    (r"mkdir -p build/found|build/fuzz/bin/.*", "./test.sh fuzz runs the fuzzers; ten minutes each"),
    (r"(sudo )?ip link set can0 .*|slcand .*", "needs a CAN adapter"),
    (r"tenon-can --can socketcan:can0 .*", "needs a CAN adapter; hw's tests do the same over a virtual bus"),
    (r"tenon-exec --cell \S+ (--plan \S+ )?--can socketcan:can0 .*",
     "needs an arm; the tests of realtime do the same on the virtual one"),
    (r"tenon-plan (TASK\.yaml|--check TASK\.yaml|--new-task PLUG SOCKET) \[.*", "a synopsis; package's tests hold options"),
    (r'ARGS=".*|parallel tenon-evaluate \$ARGS .*|tenon-evaluate \$ARGS .*|sbatch .*',
     "needs GNU parallel or Slurm and hours; chain's tests shard and merge"),
    (r"apt-get update|apt-get install --yes \./packages/tenon_\*\.deb",
     "a CI machine's own preparation; package's tests install the packages in a clean root"),
    (r"tests/guest/.*|unshare --net --map-root-user .*", "./test.sh guest is this"),
]
# Blocks of a language, by their first words, and the test that runs them.
LANGUAGES = {
    ("cmake", "find_package(tenon"): "package.InstalledProgramsAndLibrariesServeAnotherProject",
    ("python", "import can"): "realtime.ReadmeExample",
    ("python", "import numpy as np"): "interop.ThePythonPackageReadsWhatTheProgramsWrite",
    ("yaml", "# yaml-language-server"): "schemas.ShippedFilesValidateAndMistakesDoNot",
    ("yaml", "variants:"): "shared.TaskVariant",
}


def readmes(source):
    return [file for file in documents(source) if file.name == "README.md"]


def how_tos(source):
    return [file for file in documents(source) if file.name not in {"README.md", *NO_HOW_TOS}]


def documents(source):
    return sorted([*source.glob("*.md"), *(file for folder in FOLDERS for file in (source / folder).rglob("*.md"))])


def commands_of(text):
    """The commands of a block: lines joined at backslashes, what stands behind # left out."""
    joined = re.sub(r"[ \t]*\\\n\s*", " ", text)
    for line in joined.splitlines():
        command = re.sub(r"(^|\s+)#.*", "", line).strip()
        if line.startswith(" " * 11) or not command:
            continue  # a synopsis goes on
        for part in command.split(" && "):
            yield part.strip()


def collect(source):
    """(where, command) of all documents, (where, language, text) of blocks in a language, and how many are drawings."""
    commands, blocks, pictures = [], [], 0
    for file in readmes(source) + how_tos(source):
        text = file.read_text(encoding="utf-8")
        before = ""
        for match in BLOCK.finditer(text):
            where = f"{file.relative_to(source)}:{text.count(chr(10), 0, match.start()) + 2}"
            printed, before = before == "sh" and not match[1], match[1]
            if match[1] == DRAWN:
                pictures += 1
            elif match[1]:
                blocks.append((where, match[1], match[2]))
                commands += [(where, command) for command in (job_commands(match[2], "before_script")
                                                              if match[1] in FILES and is_job(match[2]) else ())]
            elif STARTS.match(match[2]) or match[2].startswith("#!"):
                commands += [] if printed else [(where, command) for command in commands_of(match[2])]
            else:
                pictures += not printed
    return commands, blocks, pictures


def typed_how_tos(source):
    """Those that tests/howto types, in its order."""
    lists = (source / "tests/howto/CMakeLists.txt").read_text(encoding="utf-8")
    return re.findall(r"\$\{PROJECT_SOURCE_DIR\}/(\S+\.md)", lists)


def account(source):
    """Prints how each command is taken care of. @return the commands that are not, and the words that no document has"""
    commands, blocks, pictures = collect(source)
    failures = []
    unused = {*TYPED, *SLOW, *BY_TEST}
    exempt = {}
    counts = {"typed": 0, "by a test": 0}
    for where, command in commands:
        reason = next((reason for pattern, reason in EXEMPT if re.fullmatch(pattern, command)), None)
        if command in TYPED or command in SLOW:
            counts["typed"] += 1
        elif command in BY_TEST:
            counts["by a test"] += 1
        elif reason:
            exempt.setdefault(reason, []).append(f"{where}: {command}")
        else:
            failures.append(f"{where}: nobody types '{command}', and no reason says why not")
        unused.discard(command)
    failures += [f"no document has '{command}' any more" for command in sorted(unused)]
    typed = typed_how_tos(source)
    by_how_to = 0
    for where, language, text in blocks:
        if where.split(":")[0] in typed and (language == "sh" or (language in FILES and file_name(text))):
            by_how_to += language == "sh"
            continue
        named = [test for (kind, begin), test in LANGUAGES.items() if kind == language and text.startswith(begin)]
        if not named:
            failures.append(f"{where}: no test runs this block of {language}")
    failures += [f"{name}: no how-to, and tests/howto types it" for name in typed if source / name not in how_tos(source)]
    failures += [f"a dead link: {link}" for link in dead_links(documents(source))]
    for name in sorted({*BY_TEST.values(), *LANGUAGES.values()}):
        if not is_there(source, name):
            failures.append(f"there is no test '{name}'")
    print(f"{len(commands)} commands of {len(readmes(source))} READMEs and {len(how_tos(source))} how-tos: {counts['typed']} typed, "
          f"{counts['by a test']} run by a test of their own, {sum(map(len, exempt.values()))} exempt; {by_how_to} blocks that "
          f"tests/howto types; {len(blocks) - by_how_to} blocks of another language, {pictures} pictures")
    for reason, of in exempt.items():
        print(f"exempt, {reason}:")
        for line in of:
            print(f"    {line}")
    return failures


def is_there(source, test):
    """Whether tests/ has a test, AREA.Suite of GoogleTest or AREA.Name of a script."""
    area, name = test.split(".")[:2]
    suites = "".join(file.read_text(encoding="utf-8") for file in (source / "tests" / area).rglob("*.cpp"))
    scripts = (source / f"tests/{area}/CMakeLists.txt")
    listed = scripts.exists() and re.search(rf"\b{name}\b", scripts.read_text(encoding="utf-8"))
    return bool(listed or re.search(rf"^TEST\w*\({name},", suites, re.M))


def type_all(arguments, wanted, folder):
    failures = []
    for name in ("planner", "hw", "sim", "shared", "lcmtypes"):
        (folder / name).symlink_to(arguments.source / name)
    shutil.copy(arguments.build / "plans" / f"{PLAN}.tnp", folder / "plan.tnp")
    with tempfile.TemporaryDirectory(prefix="tenon_runs_") as scratch:
        runs = pathlib.Path(scratch)
        subprocess.run([arguments.runs, runs], check=True, stdout=subprocess.DEVNULL)
        shutil.copy(runs / "box.lcmlog", folder / "run.lcmlog")
        shutil.copy(runs / "box.json", folder / "result.json")
    environment = {**os.environ, "PATH": f"{arguments.bin}:{os.environ['PATH']}"}
    for command, leaves in wanted.items():
        before = (folder / "plan.tnp").read_bytes()
        ended = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True, capture_output=True, check=False)
        print(f"{ended.returncode}: {command}")
        if ended.returncode != 0 or ended.stderr:
            failures.append(f"{command}: exit status {ended.returncode}: {ended.stderr}")
        if leaves and not (folder / leaves).exists():
            failures.append(f"{command}: leaves no {leaves}")
        elif leaves and leaves != "plan.tnp":
            (folder / leaves).unlink()
        if command == PLANNED and (folder / "plan.tnp").read_bytes() != before:
            failures.append(f"{command}: makes another plan than the build's {PLAN}.tnp")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("runs")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--slow", action="store_true")
    arguments = parser.parse_args()
    failures = [] if arguments.slow else account(arguments.source)
    with tempfile.TemporaryDirectory(prefix="tenon_readmes_") as scratch:
        failures += type_all(arguments, SLOW if arguments.slow else TYPED, pathlib.Path(scratch))
    for failure in failures:
        print(f"FAILED: {failure}")
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
