"""The version, which the build states once."""

import pathlib
import re


def version():
    """Of an installed package as its install wrote it, in a source tree as its build says."""
    folder = pathlib.Path(__file__).resolve().parent
    installed = folder / "VERSION"
    if installed.exists():
        return installed.read_text().strip()
    build = folder.parents[2] / "CMakeLists.txt"
    return re.search(r"^project\(tenon VERSION ([0-9.]+)", build.read_text(), re.M).group(1)
