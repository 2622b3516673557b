#!/usr/bin/env python3
"""The schemas of task, cell, robot, drive and experiment: every shipped file validates, with each of its variants laid
over it, and mistakes that an editor is to mark do not. That keys agree with the loaders is tests/shared's.

  validate.py SOURCE
"""
import copy
import json
import pathlib
import sys

import jsonschema
import yaml

FILES = {
    "task": "planner/tasks/*.yaml",
    "cell": "hw/cells/*.yaml",
    "robot": "hw/robots/*/*.yaml",
    "drive": "hw/drives/*.yaml",
    "sensor": "hw/sensors/*.yaml",
    "experiment": "sim/experiments/*.yaml",
}
# (kind, file, path of keys, what is put there)
MISTAKES = [
    ("task", "planner/tasks/toy_1d.yaml", ["enviroment"], []),
    ("task", "planner/tasks/toy_1d.yaml", ["goal", "tolerance_m"], "0,002"),
    ("task", "planner/tasks/toy_1d.yaml", ["goal", "tolerance_m"], -0.002),
    ("task", "planner/tasks/toy_1d.yaml", ["speeds", "approach_mps"], 100),
    ("task", "planner/tasks/toy_1d.yaml", ["coordinates"], ["theta"]),
    ("task", "planner/tasks/toy_1d.yaml", ["held", 0, "cylinder"], {"diameter_m": 1, "length_m": 1}),
    ("task", "planner/tasks/toy_1d.yaml", ["starts", 0, "uniform_m"], [0.01]),
    ("cell", "hw/cells/gantry3.yaml", ["faults", "force_N"], 0),
    ("cell", "hw/cells/gantry3.yaml", ["robot"], None),
    ("robot", "hw/robots/gantry3/robot.yaml", ["bus", "bitrate_bps"], 333),
    ("robot", "hw/robots/gantry3/robot.yaml", ["joints", 0, "kp_Nmprad"], 1),
    ("drive", "hw/drives/maxon_epos4.yaml", ["objects", "9999h"], "absent"),
    ("robot", "hw/robots/gantry3/robot.yaml", ["sensor", "node"], None),
    ("sensor", "hw/sensors/robotous_rft.yaml", ["rate_hz"], 250),
    ("sensor", "hw/sensors/robotous_rft.yaml", ["identifiers", "first"], 2048),
    ("experiment", "sim/experiments/box_on_table.yaml", ["friction"], 0.3),
]


class Loader(yaml.SafeLoader):
    """YAML 1.2's numbers, as the loaders read them: 1e-3 is one."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", __import__("re").compile(
    r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$"), list("-+0123456789."))
# Found first, what is a whole number stays one.
for character, resolvers in Loader.yaml_implicit_resolvers.items():
    Loader.yaml_implicit_resolvers[character] = sorted(resolvers, key=lambda resolver: resolver[0].endswith("float"))
# What the loaders take, and so no editor may mark, likewise.
TAKEN = [
    ("task", "planner/tasks/toy_1d.yaml", ["name"], 12),
    ("task", "planner/tasks/toy_1d.yaml", ["held", 0, "name"], 12),
    ("task", "planner/tasks/toy_1d.yaml", ["variants"], None),
    ("cell", "hw/cells/gantry3.yaml", ["name"], 3),
]


def read(file):
    with open(file, encoding="utf-8") as text:
        return yaml.load(text, Loader)


def overlaid(value, over):
    """Mappings key by key; over a list, entries by their name; anything else takes its place."""
    if isinstance(value, dict) and isinstance(over, dict):
        return {**value, **{key: overlaid(value.get(key), entry) for key, entry in over.items()}}
    if isinstance(value, list) and isinstance(over, dict):
        return [overlaid(entry, over.get(entry["name"], {})) for entry in value]
    return over


def variants_of(document):
    variants = document.get("variants", {}) if isinstance(document, dict) else {}
    return [document] + [overlaid(document, variant) for variant in variants.values()]


def main():
    source = pathlib.Path(sys.argv[1])
    failures = 0
    validators = {}
    for kind, pattern in FILES.items():
        schema = json.loads((source / f"shared/config/schemas/{kind}.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        validators[kind] = jsonschema.Draft202012Validator(schema)
        files = sorted(source.glob(pattern))
        count = 0
        for file in files:
            for document in variants_of(read(file)):
                count += 1
                for error in validators[kind].iter_errors(document):
                    failures += 1
                    print(f"FAILED: {file}: {error.json_path}: {error.message}")
        if not files:
            failures += 1
        print(f"{kind}: {len(files)} files, {count} with their variants")
    for right, changes in ((False, MISTAKES), (True, TAKEN)):
        for kind, file, path, value in changes:
            document = copy.deepcopy(read(source / file))
            place = document
            for key in path[:-1]:
                place = place[key]
            place[path[-1]] = value
            if validators[kind].is_valid(document) != right:
                failures += 1
                print(f"FAILED: {file} with {path} = {value} {'is refused' if right else 'validates'}")
    print(f"{len(MISTAKES)} mistakes, {len(TAKEN)} that are none, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
