#!/usr/bin/env python3
"""Shows that a dependency outside the table stops the configure step, whichever way it comes in.

Works on a skeleton: the real CMake files, and every source a dummy.

  forbidden_links.py CMAKE
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

from build_tree import FOLDERS, SOURCE

# (what is tried, file, text to replace or None to append, new text, what the message must name)
CASES = [
    ("planner declares physics", "planner/CMakeLists.txt", "PUBLIC shared planner_cell_fit planner_belief",
     "PUBLIC shared sim_physics planner_cell_fit planner_belief", "'planner' may not use 'sim_physics'"),
    ("shared declares ODE", "shared/CMakeLists.txt", "PUBLIC Eigen3::Eigen",
     "PUBLIC Eigen3::Eigen ODE::ODE", "'shared' may not use 'ODE::ODE'"),
    ("shared declares clock and threads", "shared/CMakeLists.txt", "PUBLIC Eigen3::Eigen",
     "PUBLIC Eigen3::Eigen shared_system", "'shared' may not use 'shared_system'"),
    ("the control law declares clock and threads", "executor/CMakeLists.txt",
     "(executor_motion FOLDER executor/motion\n  PUBLIC shared",
     "(executor_motion FOLDER executor/motion\n  PUBLIC shared shared_system",
     "'executor_motion' may not use 'shared_system'"),
    ("the executor links what reports are drawn with", "executor/CMakeLists.txt", None,
     "target_link_libraries(executor_telemetry PRIVATE shared_drawing)\n",
     "'executor_telemetry' may not use 'shared_drawing'"),
    ("hw declares executor", "hw/CMakeLists.txt", "PUBLIC shared shared_canopen hw_canopen",
     "PUBLIC shared shared_canopen executor_loop hw_canopen",
     "'hw_arm' may not use 'executor_loop'"),
    ("the loop links what CANopen knows of drives", "executor/CMakeLists.txt", None,
     "target_link_libraries(executor_loop PRIVATE shared_canopen)\n",
     "'executor_loop' may not use 'shared_canopen'"),
    ("a room declares its neighbour", "planner/CMakeLists.txt", "(planner_judge FOLDER planner/judge\n  PUBLIC shared",
     "(planner_judge FOLDER planner/judge\n  PUBLIC shared planner_search",
     "'planner_judge' may not use 'planner_search'"),
    ("tenon-exec declares planner", "CMakeLists.txt", "executor_telemetry hw_can",
     "executor_telemetry planner hw_can", "'tenon-exec' may not use 'planner'"),
    ("planner links physics behind the functions' back", "CMakeLists.txt", "tenon_check_house()",
     "target_link_libraries(planner PRIVATE sim_physics)\ntenon_check_house()",
     "'planner' may not use 'sim_physics'"),
    ("executor links the loaders behind the functions' back", "executor/CMakeLists.txt", None,
     "target_link_libraries(executor_loop PRIVATE shared_config)\n",
     "'executor_loop' may not use 'shared_config'"),
    ("executor links a library by name", "executor/CMakeLists.txt", None,
     "target_link_libraries(executor_loop PRIVATE ode)\n", "'executor_loop' may not use 'ode'"),
    ("tests link a main", "tests/CMakeLists.txt", None,
     "target_link_libraries(tests_shared PRIVATE tenon-plan)\n",
     "'tests_shared' may not use 'tenon-plan'"),
    ("planner gets the repository as include directory", "planner/CMakeLists.txt", None,
     "target_include_directories(planner PRIVATE ${PROJECT_SOURCE_DIR})\n",
     "forbidden include directory: 'planner'"),
    ("a target outside the house", "hw/CMakeLists.txt", None,
     "add_library(stray STATIC main_can.cpp)\n", "'stray' was not declared with the functions"),
]


def make_skeleton(root):
    shutil.copy(SOURCE / "CMakeLists.txt", root)
    shutil.copytree(SOURCE / ".cmake", root / ".cmake")
    for path in SOURCE.glob("*/**/CMakeLists.txt"):
        relative = path.relative_to(SOURCE)
        if relative.parts[0] in (*FOLDERS, "lcmtypes", "tests"):
            (root / relative).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, root / relative)
    for folder in (*FOLDERS, "lcmtypes", "tests"):
        for path in (SOURCE / folder).rglob("*.cpp"):
            dummy = root / path.relative_to(SOURCE)
            dummy.parent.mkdir(parents=True, exist_ok=True)
            dummy.write_text("int main() { return 0; }\n")


def configure(cmake, root):
    # The build folder is kept between the cases: finding the compiler is the slow part.
    run = subprocess.run([cmake, "-G", "Ninja", "-S", str(root), "-B", str(root / "build")],
                         text=True, capture_output=True, check=False)
    # CMake wraps its messages; undo that.
    return run.returncode, " ".join((run.stdout + run.stderr).split())


def main():
    failures = 0
    with tempfile.TemporaryDirectory(prefix="tenon_house_") as folder:
        root = pathlib.Path(folder)
        make_skeleton(root)
        code, output = configure(sys.argv[1], root)
        if code != 0:
            print("the unchanged skeleton does not configure:\n" + output)
            return 1
        print("accepted: the unchanged tree")
        for what, file, old, new, message in CASES:
            path = root / file
            text = path.read_text()
            if old is not None and old not in text:
                print(f"FAILED: {what}: {file} holds no '{old}'")
                failures += 1
                continue
            path.write_text(text + new if old is None else text.replace(old, new, 1))
            code, output = configure(sys.argv[1], root)
            path.write_text(text)
            if code == 0 or "Tenon: " not in output or message not in output:
                print(f"FAILED: {what}: expected \"{message}\", got status {code} and:\n{output}")
                failures += 1
            else:
                print(f"refused: {what}")
        code, output = configure(sys.argv[1], root)
        if code != 0:
            print("FAILED: the skeleton does not configure any more:\n" + output)
            failures += 1
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
