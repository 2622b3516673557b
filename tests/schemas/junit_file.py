#!/usr/bin/env python3
"""What tenon-evaluate --junit writes, read by another parser: the structure that Jenkins' schema of JUnit files asks
for, the numbers of --json, and the exit status of --min-success.

  junit_file.py TENON_EVALUATE SOURCE PLAN

@param PLAN of start 1 of the box task on the gantry
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from failures import run_test  # pylint: disable=wrong-import-position

RUNS = 8
# element: (attributes that it must have, that it may have, elements in it in this order)
STRUCTURE = {
    "testsuites": ({"name"}, {"time", "tests", "failures", "disabled", "errors"}, ["testsuite"]),
    "testsuite": ({"name", "tests"}, {"failures", "errors", "time", "skipped", "id", "package"},
                  ["properties", "testcase"]),
    "properties": (set(), set(), ["property"]),
    "property": ({"name", "value"}, set(), []),
    "testcase": ({"name", "classname"}, {"time", "status"}, ["skipped", "error", "failure"]),
    "skipped": (set(), {"message", "type"}, []),
    "error": (set(), {"message", "type"}, []),
    "failure": (set(), {"message", "type"}, []),
}


def check_structure(element, check):
    must, may, inside = STRUCTURE[element.tag]
    check(must <= set(element.attrib), f"{element.tag} lacks {must - set(element.attrib)}")
    check(set(element.attrib) <= must | may, f"{element.tag} has {set(element.attrib) - must - may}")
    places = [inside.index(child.tag) if child.tag in inside else -1 for child in element]
    check(-1 not in places and places == sorted(places), f"{element.tag} holds {[child.tag for child in element]}")
    for child in element:
        check_structure(child, check)


def check_against(suite, plan, check):
    """That it says what the JSON says."""
    properties = {p.get("name"): p.get("value") for p in suite.find("properties")}
    success = plan["summary"]["success"]
    check(int(properties["succeeded"]) == success["succeeded"], f"{properties['succeeded']} succeeded")
    for name in ("wilson95_low", "wilson95_high"):
        check(abs(float(properties[name]) - success[name]) < 1e-6, f"{name} is {properties[name]}")
    cases = suite.findall("testcase")
    check(int(suite.get("tests")) == len(cases) == len(plan["runs"]), f"{len(cases)} cases")
    for kind, attribute in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
        found = len(suite.findall(f"testcase/{kind}"))
        check(int(suite.get(attribute)) == found, f"{found} are {kind}, {suite.get(attribute)} announced")
    for case, run in zip(cases, plan["runs"]):
        check(case.get("name") == f"run {run['run']}", f"{case.get('name')} is run {run['run']}")
        check(abs(float(case.get("time")) - run["duration_s"]) < 1e-3, f"{case.get('name')}: {case.get('time')} s")
        why = list(case)
        check(bool(why) == (run["class"] != "succeeded"), f"{case.get('name')}: {run['class']}, {why}")
        if why:
            check(run["reason"] in why[0].get("message"), f"{case.get('name')}: {why[0].get('message')}")
            again = why[0].tag == "skipped" or f"--only {run['run']}" in why[0].text
            check(again, f"{case.get('name')}: {why[0].text}")


def evaluate(arguments, folder, name, least):
    """@return exit status, what it said on standard error, the file's root"""
    tool, source, plan = arguments
    file = folder / f"{name}.xml"
    ended = subprocess.run(
        [tool, "--cell", f"{source}/hw/cells/gantry3.yaml", "--task", f"{source}/planner/tasks/box_on_table_2d.yaml",
         "--plan", plan, "--experiment", folder / "harsh.yaml", "--seed", "5", "-n", str(RUNS), "--json",
         folder / "out.json", "--junit", file, *(["--min-success", str(least)] if least is not None else [])],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return ended.returncode, ended.stderr, ElementTree.parse(file).getroot()


def main(failures):
    arguments, check = sys.argv[1:], failures.check
    with tempfile.TemporaryDirectory(prefix="tenon <junit> & 'co' ") as name:
        folder = pathlib.Path(name)
        folder.joinpath("harsh.yaml").write_text(
            "name: harsh <&> 'worlds'\nfriction: [0.1, 0.6]\nforce_drift_N_sqrts: [0.0, 1.2]\n")
        status, said, root = evaluate(arguments, folder, "plain", None)
        plan = json.loads(folder.joinpath("out.json").read_text())["plans"][0]
        rate = plan["summary"]["success"]["rate"]
        check(0.0 < rate < 1.0, f"all runs are alike: {rate}")
        check(status == 0 and said == "", f"exit status {status}, says '{said}'")
        check_structure(root, check)
        check_against(root.find("testsuite"), plan, check)
        check(root.findall(".//failure"), "no failure")

        status, said, root = evaluate(arguments, folder, "missed", rate + 0.01)
        check(status == 1 and said.count("\n") == 1, f"missed: exit status {status}, says '{said}'")
        check(f"{plan['summary']['success']['succeeded']} of {RUNS} runs succeeded" in said, f"missed: '{said}'")
        check(root.findall(".//failure"), "missed: no failure")

        status, said, root = evaluate(arguments, folder, "reached", rate)
        check(status == 0 and said == "", f"reached: exit status {status}, says '{said}'")
        check_structure(root, check)
        check_against(root.find("testsuite"), plan, check)
        check(not root.findall(".//failure") and root.findall(".//skipped"), "reached: failures all the same")
        left = sorted(file.name for file in folder.iterdir())
        wanted = ["harsh.yaml", "missed.xml", "out.json", "out.jsonl", "plain.xml", "reached.xml"]
        check(left == wanted, f"left: {left}")
    return f"3 files of {RUNS} runs"


if __name__ == "__main__":
    run_test(main)
