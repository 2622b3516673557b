#!/usr/bin/env python3
"""Installs a build into an empty folder: programs that run from there, a manual page and a completion that name
every option of each, documents without a dead link, a project that finds the libraries, plans with them and executes the
plan, and the Python package.

  installed.py CMAKE BUILD SOURCE
"""
import gzip
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from failures import run_test  # pylint: disable=wrong-import-position
from markdown_links import dead_links  # pylint: disable=wrong-import-position

PROGRAMS = ["tenon-can", "tenon-evaluate", "tenon-exec", "tenon-inspect", "tenon-monitor", "tenon-plan", "tenon-sim"]
# (program, the line so far, what bash must offer for its last word)
COMPLETIONS = [
    ("tenon-plan", ["--ch"], {"--check"}),
    ("tenon-plan", ["--method", "contact"], {"contact-greedy"}),
    ("tenon-plan", ["--method", "=", "s"], {"single-particle"}),
    ("tenon-plan", ["--method=s"], {"--method=single-particle"}),
    ("tenon-plan", ["--method", "="], {"mha", "single-particle", "contact-greedy"}),
    ("tenon-plan", ["--cell", "=", "my"], {"my task.yaml"}),
    ("tenon-exec", ["--identify-contact", "-"], {"-x", "-y", "-z"}),
    ("tenon-evaluate", ["--corner", "low"], {"low,drawn", "low,largest"}),
    ("tenon-plan", ["--threads", ""], set()),
    ("tenon-plan", ["--threads", "=", "m"], set()),
    ("tenon-plan", ["--threads=m"], set()),
    ("tenon-plan", ["--start", ""], set()),
    ("tenon-plan", ["--goal", ""], set()),
    ("tenon-plan", ["--new-task", ""], {"my task.yaml"}),
    ("tenon-plan", ["--threads", "4", "my"], {"my task.yaml"}),
    ("tenon-sim", ["--view", ""], set()),
    ("tenon-sim", ["--view", "--on"], {"--once"}),
    ("tenon-evaluate", ["-n", ""], set()),
    ("tenon-can", ["read", ""], set()),
    ("tenon-can", ["write", "3", "0x6083", "0", ""], {"u8", "u16", "u32", "i8", "i16", "i32", "str"}),
    ("tenon-can", ["write", "3", "0x6083", "0", "u32", ""], set()),
    ("tenon-can", ["check", ""], {"my task.yaml"}),
    ("tenon-can", ["check", "my", "--eds", "my"], {"my task.yaml"}),
    ("tenon-can", ["sc"], {"scan"}),
    ("tenon-can", ["--can", "slcan", ":", "//127.0.0.1", ":", "29536", "sc"], {"scan"}),
    ("tenon-can", ["--bitrate", "=", "500000", "--can", "socketcan", ":", "can0", "sc"], {"scan"}),
    ("tenon-can", ["--can", "my"], {"my task.yaml"}),
    ("tenon-monitor", ["--lines", "--lcm-url", "none", "e"], {"export"}),
    ("tenon-plan", ["my"], {"my task.yaml"}),
    ("tenon-can", ["scan", "my"], {"my task.yaml"}),
    ("tenon-can", ["--c"], {"--can"}),
    ("tenon-can", ["--can", "my", "check", "--"], {"--eds", "--help"}),
    ("tenon-monitor", ["export", "--"], {"--csv", "--help", "--mcap", "--run"}),
]


def run(*command, **options):
    ended = subprocess.run([str(word) for word in command], text=True, capture_output=True, check=False, **options)
    if ended.returncode != 0:
        raise SystemExit(f"FAILED: {' '.join(map(str, command))}:\n{ended.stdout}{ended.stderr}")
    return ended.stdout


def options_of(program):
    """As the help of the program and of its subcommands has them: this reads no option table."""
    text = run(program, "--help")
    options = set(re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", text, re.M)) | set(re.findall(r"^  (-\w),", text, re.M))
    subcommands = text.partition("\nSubcommands:\n")[2]
    for name in re.findall(r"^  ([a-z]+) ", subcommands, re.M):
        more = run(program, name, "--help")
        options |= set(re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", more, re.M))
    return options


def check_help(program, failures):
    """Of the program and of each subcommand: its own name, its own examples, one way of writing."""
    text = run(program, "--help")
    subcommands = re.findall(r"^  ([a-z]+) ", text.partition("\nSubcommands:\n")[2].partition("\n\n")[0], re.M)
    for words in [[], *([name] for name in subcommands)]:
        shown = " ".join([program.name, *words])
        text = run(program, *words, "--help")
        failures.check(f"\nUsage: {shown} [OPTIONS]" in text, f"{shown}: its help gives its usage as {re.findall('Usage.*', text)}")
        examples = re.findall(r"^  (tenon.*)", text.partition("\nExamples:\n")[2], re.M)
        failures.check(examples, f"{shown}: its help has no example")
        for example in examples:
            failures.check(example.split()[0] == program.name and set(words) <= set(example.split()),
                           f"{shown}: its help has an example of something else: {example}")
        lines = text.partition("\nExit status:")[0].partition("\nExamples:")[0].splitlines()
        for line, following in zip(lines, [*lines[1:], ""]):
            # What is too long for its column is described in the line after it.
            beside = re.match(r"  \S.{25} (?=\S)", line) and not following.startswith(" " * 28)
            if beside or line.startswith(" " * 28):
                failures.check(not line[28:29].islower() and line[27] == " ", f"{shown}: its help describes without a capital: {line}")


def check_page(program, page, failures):
    """What a reader of the page would stumble over."""
    sections = re.findall(r"^\.SH (.*)$", page, re.M)
    wanted = ["NAME", "SYNOPSIS", "OPTIONS", "EXIT STATUS", "EXAMPLES", "FILES", "SEE ALSO"]
    failures.check([name for name in sections if name in wanted] == wanted, f"{program}: its page's sections are {sections}")
    named = page.partition(".SH NAME\n")[2].partition("\n.SH")[0]
    failures.check(re.fullmatch(r"[a-z\\-]+ \\- [a-z][^\n]*[^\n.]", named), f"{program}: apropos cannot read its NAME '{named}'")
    others = re.findall(r"^\.BR (\S+) \(1\),?$", page.partition(".SH SEE ALSO\n")[2].replace("\\-", "-"), re.M)
    failures.check(sorted([*others, program]) == PROGRAMS, f"{program}: its page sends its readers to {others}")
    for line in re.sub(r"^\.nf\n.*?^\.fi\n", "", page, flags=re.M | re.S).splitlines():
        failures.check(line == line.lstrip() != "", f"{program}: a line of its page is empty or begins with a blank: '{line}'")
    failures.check(not re.search(r"['`^~]|(?<!\\)-", page), f"{program}: its page has a character that man would change")


def check_texts(prefix, failures):
    named = 0
    for program in PROGRAMS:
        options = options_of(prefix / "bin" / program)
        check_help(prefix / "bin" / program, failures)
        failures.check({"--help", "--version", "--man"} <= options, f"{program}: its help names only {options}")
        page = gzip.decompress((prefix / f"share/man/man1/{program}.1.gz").read_bytes()).decode()
        check_page(program, page, failures)
        words = set(re.findall(r"(?<![\w-])--?[a-z][a-z-]*", page.replace("\\-", "-").replace("\\fB", " ")))
        completion = prefix / "share/bash-completion/completions" / program
        offered = set(re.findall(r"--?[a-z][a-z-]*", completion.read_text()))
        for option in sorted(options):
            named += 1
            failures.check(option in words, f"{program}: its manual page lacks {option}")
            failures.check(option in offered, f"{program}: its completion lacks {option}")
    print(f"{len(PROGRAMS)} manual pages and completions name {named} options")


def check_documents(prefix, failures):
    documents = sorted((prefix / "share/tenon").rglob("*.md"))
    failures.check(documents, "no documents are installed")
    for link in dead_links(documents):
        failures.check(False, f"a dead link: {link}")
    print(f"{len(documents)} documents are installed")


def check_completion(prefix, failures):
    for program, line, expected in COMPLETIONS:
        words = " ".join(f"'{word}'" for word in [program, *line])
        function = "_" + program.replace("-", "_")
        script = (f"source {prefix}/share/bash-completion/completions/{program}; COMP_WORDS=({words});"
                  f" COMP_CWORD={len(line)}; {function}; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "my task.yaml").touch()
            offered = set(run("bash", "-c", script, cwd=folder).splitlines()) - {""}
        failures.check(offered == expected, f"{program} {line}: bash offers {offered}, not {expected}")


def check_project(cmake, prefix, source, folder, failures):
    build = folder / "project"
    run(cmake, "-S", pathlib.Path(__file__).resolve().parent / "project", "-B", build, "-G", "Ninja",
        f"-DCMAKE_PREFIX_PATH={prefix}", f"-DEXAMPLES={source}/tests/examples", "-DCMAKE_BUILD_TYPE=Release")
    run(cmake, "--build", build)
    tasks = prefix / "share/tenon/planner/tasks"
    said = run(build / "plan_a_task", tasks / "box_on_table_2d.yaml", folder / "plan.tnp")
    failures.check("random starts end at the goal" in said, f"plan_a_task says {said}")
    said = run(build / "run_a_plan", folder / "plan.tnp")
    failures.check("contact after" in said, f"run_a_plan says {said}")
    print(run(prefix / "bin/tenon-inspect", folder / "plan.tnp").splitlines()[0])


def check_python(prefix, folder, failures):
    said = run("/usr/bin/python3", "-B", "-c", "import tenon; plan = tenon.read_plan('plan.tnp'); print(tenon.__file__, "
               "tenon.__version__, plan.task_name, len(plan.steps))", cwd=folder, env={"PYTHONPATH": str(prefix / "lib/python3/dist-packages")})
    file, version, task, _ = said.split()
    failures.check(file.startswith(str(prefix)) and task == "box_on_table_2d", f"the Python package says {said}")
    return version


def main(failures):
    cmake, build, source = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    with tempfile.TemporaryDirectory(prefix="tenon_installed_") as name:
        folder = pathlib.Path(name)
        prefix = folder / "usr"
        run(cmake, "--install", build, "--prefix", prefix)
        version = run(prefix / "bin/tenon-plan", "--version").strip()
        wanted = re.search(r"project\(tenon VERSION ([0-9.]+)", (source / "CMakeLists.txt").read_text()).group(1)
        failures.check(wanted in version, f"tenon-plan --version says {version}, not {wanted}")
        check_texts(prefix, failures)
        check_completion(prefix, failures)
        check_documents(prefix, failures)
        checked = run(prefix / "bin/tenon-plan", "--check", "planner/tasks/box_on_table_2d.yaml",
                      "--cell", "hw/cells/gantry3.yaml", cwd=prefix / "share/tenon")
        failures.check("nothing stands against" in checked, f"--check from the installation says {checked}")
        check_project(cmake, prefix, source, folder, failures)
        version = check_python(prefix, folder, failures)
        failures.check(version == wanted, f"tenon.__version__ is {version}, not {wanted}")


if __name__ == "__main__":
    run_test(main)
