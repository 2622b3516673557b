#!/usr/bin/env python3
"""Shows that an include which the table of dependencies forbids does not compile.

With the flags of each target the preprocessor is asked for every header of the house whether it is there.
With each, a header that everybody may have is included and must compile, one that is not there must not.

  forbidden_includes.py BUILD
"""
import sys

from build_tree import FOLDERS, SOURCE, BuildTree

# Short, so that compiling it takes no time.
ALLOWED_TO_ALL = "shared/base/error.h"

# For each target, the targets whose headers it may include beside its own. Written down a second time on
# purpose: this is what the design says, and CMake's table is what is being checked.
PLANNER = {"shared", "planner_belief", "planner_search", "planner_judge", "planner_cell_fit"}
CONTROL = {"shared", "executor_faults", "executor_states", "executor_record", "executor_motion", "executor_sensing"}
LOOP = CONTROL | {"executor_dry_run"}
HW_ARM = {"shared", "shared_canopen", "hw_canopen", "hw_cia402", "hw_sensors"}
MAY_INCLUDE = {
    "shared": set(),
    "shared_canopen": {"shared"},
    "shared_mit": {"shared"},
    "shared_system": {"shared"},
    "shared_drawing": {"shared"},
    "shared_eds": {"shared"},
    "shared_config": {"shared", "shared_canopen", "shared_mit", "shared_system"},
    "planner_cell_fit": {"shared"},
    "planner_belief": {"shared", "shared_system"},
    "planner_search": {"shared", "planner_belief"},
    "planner_judge": {"shared", "planner_belief", "planner_cell_fit"},
    "planner": PLANNER,
    "planner_check": {"shared", "planner_belief", "planner_search"},
    "planner_new_task": {"shared"},
    "planner_report": PLANNER | {"shared_drawing", "planner", "planner_check"},
    "sim_physics": {"shared"},
    "sim_cell": {"shared", "shared_canopen", "shared_mit", "shared_eds", "sim_physics"},
    "sim_view": {"shared", "shared_canopen", "shared_mit", "shared_eds", "shared_system", "shared_drawing", "sim_cell"},
    "sim_evaluation": {"shared", "shared_canopen", "shared_mit", "shared_eds", "shared_system", "shared_drawing", "sim_cell"},
    "sim_evaluation_chain": LOOP | HW_ARM | {"shared_mit", "hw_robot_arm", "shared_eds", "shared_system", "sim_cell", "sim_evaluation",
                                             "executor_loop",
                                             "executor_identification", "executor_telemetry", "hw_arm"},
    "executor": {"shared", "executor_faults", "executor_states", "executor_motion"},
    "executor_faults": {"shared"},
    "executor_states": {"shared", "executor_faults"},
    "executor_record": {"shared", "shared_system", "executor_faults", "executor_states"},
    "executor_motion": {"shared", "executor_faults", "executor_states"},
    "executor_sensing": {"shared", "executor_faults", "executor_states"},
    "executor_dry_run": {"shared", "executor_faults", "executor_states", "executor_motion"},
    "executor_loop": LOOP | {"shared_system"},
    "executor_identification": LOOP | {"executor_loop"},
    "executor_telemetry": LOOP | {"shared_system", "executor_loop", "executor_identification", "lcmtypes",
                                  "lcmtypes_received"},
    "executor_monitor": LOOP | {"shared_system", "executor_loop", "executor_identification", "executor_telemetry",
                                "lcmtypes", "lcmtypes_received"},
    "executor_recorded": {"shared", "shared_system", "executor_faults", "executor_states", "executor_record", "lcmtypes",
                          "lcmtypes_received"},
    "executor_export": {"shared", "shared_system", "executor_faults", "executor_states", "executor_record",
                        "executor_recorded", "lcmtypes", "lcmtypes_received"},
    "sim_listener": {"shared", "shared_system", "lcmtypes", "lcmtypes_received"},
    "lcmtypes_received": {"shared", "lcmtypes"},
    "hw_can": {"shared", "shared_system"},
    "hw_canopen": {"shared", "shared_canopen"},
    "hw_cia402": {"shared", "shared_canopen"},
    "hw_sensors": {"shared"},
    "hw_arm": HW_ARM,
    "hw_mit": HW_ARM | {"shared_mit", "hw_arm"},
    "hw_robot_arm": HW_ARM | {"shared_mit", "hw_arm", "hw_mit"},
    "hw_load": HW_ARM | {"shared_mit", "hw_arm", "hw_mit"},
    "hw_check": HW_ARM | {"shared_mit", "hw_mit", "shared_eds", "hw_arm", "hw_load"},
    "tenon-plan": PLANNER | {"shared_config", "shared_system", "planner", "planner_check", "planner_report",
                             "planner_new_task",
                             "sim_physics", "executor_dry_run", "executor_motion", "executor_states",
                             "executor_faults"},
    "tenon-inspect": PLANNER | {"shared_config", "shared_system", "planner", "planner_check", "planner_report", "sim_physics",
                                "executor_recorded", "executor_faults"},
    "tenon-exec": LOOP | HW_ARM | {"shared_config", "shared_system", "executor", "executor_loop",
                                   "executor_identification", "executor_telemetry", "hw_can", "hw_arm", "hw_robot_arm", "hw_load"},
    "tenon-monitor": LOOP | {"shared_config", "shared_system", "executor_loop", "executor_identification",
                             "executor_telemetry", "executor_monitor", "executor_export", "lcmtypes"},
    "tenon-sim": {"shared", "shared_canopen", "shared_mit", "shared_eds", "shared_config", "shared_system", "sim_cell",
                  "sim_listener", "sim_view", "hw_can"},
    "tenon-evaluate": HW_ARM | {"shared_mit", "shared_eds", "shared_config", "shared_system", "sim_evaluation_chain",
                                "sim_evaluation", "sim_cell", "hw_arm", "hw_load"},
    "tenon-can": HW_ARM | {"shared_mit", "shared_eds", "shared_config", "shared_system", "hw_can", "hw_arm", "hw_mit",
                           "hw_load", "hw_check"},
}


def headers_by_room(tree):
    """The include paths of all headers of the house, by the target that shows them."""
    found = {}
    for folder in (*FOLDERS, "lcmtypes"):
        for header in sorted((SOURCE / folder).rglob("*.h")):
            if header.name.startswith("main_"):
                continue  # a main's own part
            path = str(header.relative_to(SOURCE))
            found.setdefault(tree.room_of(path), []).append(path)
    generated = tree.path / "roots/lcmtypes"
    found["lcmtypes"] = [str(h.relative_to(generated)) for h in sorted(generated.rglob("*.hpp"))]
    return found


def seen_by(tree, target, headers):
    """Those of `headers` that an include in a file of `target` would find."""
    text = "".join(f'#if __has_include("{header}")\nseen {header}\n#endif\n' for header in headers)
    return {line.split()[1] for line in tree.preprocessed(target, text).splitlines()
            if line.startswith("seen ")}


def main():
    tree = BuildTree(sys.argv[1])
    rooms = headers_by_room(tree)
    everything = [header for headers in rooms.values() for header in headers]
    failures = 0
    refused = 0
    accepted = 0

    def fail(what):
        nonlocal failures
        failures += 1
        print("FAILED: " + what)

    for room in rooms.keys() - MAY_INCLUDE.keys() - {"lcmtypes"}:
        fail(f"room '{room}' has no row here")
    for target, allowed in MAY_INCLUDE.items():
        if tree.flags_of(target) is None:
            fail(f"there is no target '{target}' in the build")
            continue
        seen = seen_by(tree, target, everything)
        for room, headers in rooms.items():
            for header in headers:
                if room in allowed | {target} and header not in seen:
                    fail(f"{target}: #include \"{header}\" is allowed and is not found")
                elif room not in allowed | {target} and header in seen:
                    fail(f"{target}: #include \"{header}\" is forbidden and is found")
        hidden = [header for header in everything if header not in seen]
        refused += len(hidden)
        accepted += len(seen)
        if hidden and tree.compiles(target, f'#include "{hidden[0]}"\n')[0]:
            fail(f"{target}: #include \"{hidden[0]}\" compiles")
        ok, messages = tree.compiles(target, f'#include "{ALLOWED_TO_ALL}"\n')
        if not ok:
            fail(f"{target}: #include \"{ALLOWED_TO_ALL}\" does not compile:\n{messages}")
    print(f"{len(MAY_INCLUDE)} targets: {refused} forbidden includes refused, {accepted} allowed ones found, "
          f"{failures} failures")
    return 1 if failures or not refused or not accepted else 0


if __name__ == "__main__":
    sys.exit(main())
