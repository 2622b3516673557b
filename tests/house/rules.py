#!/usr/bin/env python3
"""The rules of the house that can be seen in the text of a file.

  rules.py               checks the repository; one line a finding; exit status 1 if there is any
  rules.py --self-test   plants a breach of each rule in a copy and shows that it is found
"""
import argparse
import pathlib
import re
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LIBRARIES = ("shared", "planner", "executor", "hw", "sim")
MAX_LINES = 400
MAX_FUNCTION_LINES = 60
PASSAGE_LINES = 6

TOP_LEVEL = {
    "CMakeLists.txt", "CMakePresets.json", "CMakeUserPresets.json", "README.md", "CHANGELOG.md",
    "LICENSE", "demo.sh", "test.sh", "planner", "executor", "shared", "lcmtypes", "hw", "sim", "tests",
    "build", "compile_commands.json",
}

# Where shared/ may have the operating system.
SYSTEM = ("shared/system/", "shared/config/")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
IS_MAIN = re.compile(r"^[a-z]+/main_[a-z_]+\.cpp$")

# What a folder may include of the others, as path prefixes; rooms within a folder are kept apart by what
# their targets show. Mains and tests compose freely here: what
# they may use is decided by what their targets link.
MAY_INCLUDE = {
    "shared": ("shared/",),
    "shared/config": ("shared/",),
    "planner": ("shared/", "planner/"),
    "hw": ("shared/", "hw/"),
    "sim": ("shared/", "sim/"),
    # One run of an evaluation: the executor over the master and the bus on the virtual cell.
    "sim/evaluation_chain": ("shared/", "sim/", "executor/", "hw/"),
    # What an executor in another process tells.
    "sim/listener": ("shared/", "sim/", "lcmtypes/"),
    "executor": ("shared/", "executor/", "lcmtypes/"),
    "lcmtypes": ("shared/", "lcmtypes/"),
    "tests": ("shared/", "planner/", "executor/", "hw/", "sim/", "lcmtypes/", "tests/"),
}

# (what, includes it matches, who may have it: a predicate over the file's path, is a main?)
RESERVED = [
    ("ODE", re.compile(r"^ode/"), lambda path, main: path.startswith(("sim/", "tests/")) and not main),
    ("LCM", re.compile(r"^(lcm|lcmtypes)/"),
     lambda path, main: path.startswith("tests/") or path == "executor/main_monitor.cpp"
     or path.startswith(("executor/telemetry/", "executor/monitor/", "executor/recorded/", "executor/export/",
                         "sim/listener/", "lcmtypes/"))),
    ("ncurses", re.compile(r"^n?curses"), lambda path, main: path == "executor/main_monitor_screen.cpp"),
    ("libmicrohttpd", re.compile(r"^microhttpd"), lambda path, main: path.startswith("sim/view/")),
    ("yaml-cpp", re.compile(r"^yaml-cpp/"),
     lambda path, main: path.startswith(("shared/config/", "tests/"))),
    ("urdfdom", re.compile(r"^urdf"), lambda path, main: path.startswith("shared/config/")),
    ("CLI11", re.compile(r"^CLI/"),
     lambda path, main: main or path.startswith("shared/config/command_line")),
    ("nlohmann-json", re.compile(r"^nlohmann/"),
     lambda path, main: not path.startswith("shared/") or path.startswith("shared/config/")),
    ("CANopen", re.compile(r"^shared/canopen/"),
     lambda path, main: path.startswith(("shared/canopen/", "shared/config/", "hw/", "sim/cell/", "tests/"))),
    ("GoogleTest", re.compile(r"^(gtest|gmock|benchmark)/"), lambda path, main: path.startswith("tests/")),
    ("threads, clocks and the operating system",
     re.compile(r"^(thread|mutex|shared_mutex|condition_variable|future|semaphore|latch|barrier|"
                r"stop_token|chrono|ctime|time\.h|pthread\.h|sched\.h|signal\.h|csignal|unistd\.h|"
                r"fcntl\.h|poll\.h|netdb\.h|termios\.h|pty\.h|(sys|net|netinet|arpa|linux)/.*)$"),
     lambda path, main: not path.startswith("shared/") or path.startswith(SYSTEM)),
    ("starts threads; shared/system/fan_out.h does", re.compile(r"^(thread|future|stop_token)$"),
     lambda path, main: main or path.startswith(("shared/system/", "executor/telemetry/", "sim/view/", "tests/"))),
]

# (what, pattern in the code, who may have it)
CODE = [
    ("reads a clock or sleeps; time is an argument",
     re.compile(r"_clock\s*::\s*now\b|\b(clock_gettime|gettimeofday|timespec_get|clock_nanosleep|"
                r"nanosleep|usleep|sleep_for|sleep_until)\b|\bstd::time\s*\(|\btime\s*\(\s*(nullptr|NULL|0)"),
     lambda path, main: path.startswith(("shared/system/", "tests/"))),
    ("draws numbers that no seed repeats", re.compile(r"\brandom_device\b|\bs?rand\s*\("),
     lambda path, main: main),
    ("skips a test; what a test needs is set up, or it fails", re.compile(r"\bGTEST_SKIP\b"),
     lambda path, main: False),
    ("switches assertions off", re.compile(r"#\s*define\s+NDEBUG\b"), lambda path, main: False),
]
# (what, pattern in the text, comments and strings included, files that it is kept out of)
WORDS = [
    # The proof that another family of drives fits behind them.
    ("names CANopen, which ports and cells know nothing of",
     re.compile(r"can_?open|\bCiA\b|\b[RT]?PDOs?\b|\bSDO\b|\bNMT\b|\bEMCY\b|\bSYNC\b|\bCOB|\b[0-9A-F]{4}h\b|"
                r"\b(control|status)words?\b|\bDriveProfile\b", re.I),
     ("shared/ports/", "shared/cell/")),
]


def without_comments_and_strings(text):
    """Blanks out comments and literals, and keeps the lines where they are."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)

    def blank(match):
        kept = re.sub(r"[^\n]", " ", match.group(0))
        # A quote between digits separates thousands and opens nothing.
        return match.group(0) if match.group(0)[0] == "'" and len(match.group(0)) > 6 else kept

    text = re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "_", text)
    return pattern.sub(blank, text)


def functions(code):
    """Yields (line, number of lines) of every function in formatted code without comments and strings."""
    opened = []  # (kind, line of the opening brace's statement) of every scope that is open
    head = []  # the statement that has begun
    for number, line in enumerate(code.splitlines(), 1):
        text = line.strip()
        if not text or text.startswith("#") or text in ("public:", "private:", "protected:"):
            continue
        head.append((number, text))
        for character in text:
            if character == "{":
                statement = " ".join(part for _, part in head)
                outer = opened[-1][0] if opened else "namespace"
                if outer in ("namespace", "class") and re.match(r"(inline )?namespace\b|extern\b", statement):
                    kind = "namespace"
                elif outer in ("namespace", "class") and "(" in statement and "=" not in statement.split("(")[0]:
                    kind = "function"
                elif re.search(r"\b(class|struct|union|enum)\b", statement):
                    kind = "class"
                else:
                    kind = "block"
                opened.append((kind, head[0][0]))
            elif character == "}" and opened:
                kind, begin = opened.pop()
                if kind == "function":
                    yield begin, number - begin + 1
        if text[-1] in "{};":
            head = []


def check_include(path, main, quote, name):
    if "../" in name:
        yield "goes up a folder; write the path from the repository's root"
        return
    ours = re.match(r"^(shared|planner|executor|hw|sim|lcmtypes|tests)/", name)
    if quote == '"' and not ours:
        yield "is no repository path (\"folder/...\")"
    if quote == "<" and ours:
        yield "is ours and takes quotes"
    folder = max((f for f in MAY_INCLUDE if path.startswith(f + "/")), key=len)
    if ours and not main and not name.startswith(MAY_INCLUDE[folder]):
        yield f"is not for {folder}/"
    if name.startswith("shared/config/") and not main and not path.startswith(("shared/config/", "tests/")):
        yield "is for mains and tests alone"
    if path.endswith(".h") and name == "iostream":
        yield "has no place in a header"
    for what, pattern, allowed in RESERVED:
        if pattern.match(name) and not allowed(path, main):
            yield f"({what}) is not for this file"


def check_file(root, path):
    """Yields (line number, message) for one source file; `path` is relative to `root`."""
    main = bool(IS_MAIN.match(path))
    text = (root / path).read_text(encoding="utf-8")
    lines = text.splitlines()
    if len(lines) > MAX_LINES:
        yield len(lines), f"longer than {MAX_LINES} lines"
    if path.endswith(".h") and "#pragma once" not in lines:
        yield 1, "a header without #pragma once"
    if not re.match(r"^[a-z0-9_]+\.(h|cpp)$", pathlib.PurePath(path).name):
        yield 1, "a file's name is in snake_case"
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if match:
            for problem in check_include(path, main, match.group(1), match.group(2)):
                yield number, f"include of {match.group(2)} {problem}"
    for number, line in enumerate(lines, 1):
        for what, pattern, folders in WORDS:
            if path.startswith(folders) and pattern.search(line):
                yield number, what
    code = without_comments_and_strings(text)
    for number, length in functions(code):
        if length > MAX_FUNCTION_LINES:
            yield number, f"a function of {length} lines, more than {MAX_FUNCTION_LINES}"
    for number, line in enumerate(code.splitlines(), 1):
        for what, pattern, allowed in CODE:
            if pattern.search(line) and not allowed(path, main):
                yield number, what


def passages_that_stand_twice(root):
    """Findings for every passage of PASSAGE_LINES lines outside tests that stands in two places to the letter.

    Blank lines, lone braces and includes are no part of a passage; one finding a pair of places.
    """
    first = {}
    last = None
    for folder in LIBRARIES:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            path = str(file.relative_to(root))
            lines = [(number, line.strip()) for number, line in
                     enumerate(file.read_text(encoding="utf-8").splitlines(), 1)]
            lines = [(number, line) for number, line in lines
                     if re.search(r"\w", line) and not re.match(r"#|namespace\b|\} *// namespace", line)]
            for i in range(len(lines) - PASSAGE_LINES + 1):
                text = tuple(line for _, line in lines[i : i + PASSAGE_LINES])
                other = first.setdefault(text, (path, lines[i][0], i))
                if other[:2] == (path, lines[i][0]):
                    continue
                if last != (path, i - 1, other[0], other[2] - 1):
                    yield (f"{path}:{lines[i][0]}: {PASSAGE_LINES} lines and more stand in "
                           f"{other[0]}:{other[1]} too")
                last = (path, i, other[0], other[2])


def check_repository(root):
    findings = list(passages_that_stand_twice(root))
    for entry in sorted(root.iterdir()):
        if not entry.name.startswith(".") and entry.name not in TOP_LEVEL:
            findings.append(f"{entry.name}: does not belong at the top level")
    for folder in (*LIBRARIES, "tests"):
        for file in sorted((root / folder).rglob("*")):
            path = str(file.relative_to(root))
            if file.suffix in (".h", ".cpp"):
                findings += [f"{path}:{line}: {what}" for line, what in check_file(root, path)]
            elif file.suffix in (".hpp", ".cc", ".cxx", ".c", ".hh"):
                findings.append(f"{path}: sources are .h and .cpp")
    return findings


# (file, its text, part of the finding; None if it must be clean)
SELF_TEST = [
    ("planner/search.cpp", '#include "shared/plan/plan.h"\n#include "planner/search.h"\n', None),
    ("planner/a.cpp", '#include "../sim/world.h"\n', "goes up a folder"),
    ("planner/b.cpp", '#include "search.h"\n', "is no repository path"),
    ("planner/c.cpp", '#include "sim/world.h"\n', "is not for planner/"),
    ("shared/d.cpp", '#include "planner/search.h"\n', "is not for shared/"),
    ("hw/e.cpp", '#include "executor/cycle.h"\n', "is not for hw/"),
    ("planner/f.cpp", "#include <ode/ode.h>\n", "(ODE) is not for this file"),
    ("sim/f.cpp", "#include <ode/ode.h>\n", None),
    ("executor/g.cpp", "#include <lcm/lcm-cpp.hpp>\n", "(LCM) is not for this file"),
    ("executor/telemetry/g.cpp", '#include "lcmtypes/tenon/status_t.hpp"\n', None),
    ("executor/monitor/g.cpp", "#include <curses.h>\n", "(ncurses) is not for this file"),
    ("sim/evaluation/g.cpp", "#include <microhttpd.h>\n", "(libmicrohttpd) is not for this file"),
    ("executor/h.cpp", '#include "shared/config/load_task.h"\n', "is for mains and tests alone"),
    ("executor/main_exec.cpp", '#include "shared/config/load_task.h"\n#include <CLI/CLI.hpp>\n', None),
    ("shared/i.cpp", "#include <thread>\n", "is not for this file"),
    ("shared/j.cpp", "#include <sys/socket.h>\n", "is not for this file"),
    ("shared/k.cpp", "#include <yaml-cpp/yaml.h>\n", "(yaml-cpp)"),
    ("planner/l.cpp", "#include <CLI/CLI.hpp>\n", "(CLI11)"),
    ("planner/m.h", "int x();\n", "without #pragma once"),
    ("planner/n.h", "#pragma once\n#include <iostream>\n", "has no place in a header"),
    ("hw/o.cpp", "auto t = std::chrono::steady_clock::now();\n", "reads a clock"),
    ("hw/p.cpp", '// steady_clock::now()\nconst char* s = "clock_gettime"; int n = 1\'000;\n', None),
    ("shared/system/clock.cpp", "#include <time.h>\nint i = clock_gettime(1, nullptr);\n", None),
    ("hw/clock.cpp", "auto t = std::chrono::steady_clock::now();\n", "reads a clock"),
    ("executor/main_exec.cpp", "auto t = std::chrono::steady_clock::now();\n", "reads a clock"),
    ("shared/system/threads.cpp", "#include <thread>\n", None),
    ("planner/belief/pool.cpp", "#include <thread>\n", "starts threads"),
    ("executor/telemetry/recorder.h", "#pragma once\n#include <thread>\n", None),
    ("sim/q.cpp", "std::random_device seed;\n", "no seed repeats"),
    ("sim/r.cpp", "int x;\n" * 401, "longer than 400 lines"),
    ("sim/r2.cpp", "namespace a {\nint f(int x) {\n" + "  ++x;\n" * 59 + "}\n}\n", "a function of 61 lines"),
    ("sim/r3.cpp", "struct A {\n  int f(int x) {\n" + "".join(f"    x += {i};\n" for i in range(58))
     + "  }\n};\nint y[] = {\n" + "".join(f"  {i},\n" for i in range(70)) + "};\n", None),
    ("sim/BadName.cpp", "int x;\n", "snake_case"),
    ("sim/s.hpp", "int x;\n", "sources are .h and .cpp"),
    ("executor/loop/canopen.cpp", '#include "shared/canopen/constants.h"\n', "(CANopen) is not for this file"),
    ("shared/motion/canopen.cpp", '#include "shared/canopen/constants.h"\n', "(CANopen) is not for this file"),
    ("shared/cell/robot.h", '#pragma once\n#include "shared/canopen/constants.h"\n', "(CANopen) is not for this file"),
    ("shared/config/load.cpp", '#include "shared/canopen/constants.h"\n', None),
    ("shared/cell/sensor.h", "#pragma once\n// Two TPDOs of four values.\n", "names CANopen"),
    ("shared/ports/arm.h", "#pragma once\nint statusword = 0x1234;  // 6041h\n", "names CANopen"),
    ("shared/ports/can_bus.h", "#pragma once\nstruct CanBus {};  // opens nothing by itself\n", None),
    ("tests/hw/t.cpp", "TEST(A, B) { GTEST_SKIP(); }\n", "skips a test"),
    ("shared/t.cpp", "#include <shared/plan/plan.h>\n", "takes quotes"),
]


def self_test():
    failures = 0
    for path, text, expected in SELF_TEST:
        with tempfile.TemporaryDirectory(prefix="tenon_rules_") as folder:
            root = pathlib.Path(folder)
            (root / path).parent.mkdir(parents=True)
            (root / path).write_text(text)
            findings = check_repository(root)
            good = not findings if expected is None else any(expected in f for f in findings)
            if not good:
                failures += 1
                print(f"FAILED: {path}: expected {expected!r}, found {findings}")
    with tempfile.TemporaryDirectory(prefix="tenon_rules_") as folder:
        for path in ("planner/a.cpp", "hw/b.cpp"):
            (pathlib.Path(folder) / path).parent.mkdir()
            (pathlib.Path(folder) / path).write_text("".join(f"int x{i};\n\n" for i in range(7)))
        found = check_repository(pathlib.Path(folder))
        if len(found) != 1 or "stand in" not in found[0]:
            failures += 1
            print(f"FAILED: a passage that stands twice: {found}")
    with tempfile.TemporaryDirectory(prefix="tenon_rules_") as folder:
        (pathlib.Path(folder) / "notes.txt").write_text("")
        if not any("top level" in f for f in check_repository(pathlib.Path(folder))):
            failures += 1
            print("FAILED: a stray file at the top level was not found")
    print(f"{len(SELF_TEST) + 2} planted cases, {failures} failures")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--self-test", action="store_true")
    if parser.parse_args().self_test:
        return self_test()
    findings = check_repository(SOURCE)
    for finding in findings:
        print(finding)
    print(f"rules of the house: {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
