"""The blocks of a document: what is saved as a file, what is typed, what it then prints.

A script finds this module by `sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))`.
"""
import re

import yaml

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)
# Blocks in these languages are files under the name in their first line.
FILES = ("yaml",)
# A drawing in letters.
DRAWN = "text"


def file_name(text):
    """Under which a block is saved; None where it has no name."""
    named = re.match(r"# (\S+)\n", text)
    return named[1] if named else None


def save(text, folder):
    """@return the file"""
    file = folder / file_name(text)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    return file


def job_commands(text, key):
    """What the jobs of a CI file list under a key: `script`, `before_script`."""
    return [command for job in yaml.safe_load(text).values() if isinstance(job, dict) for command in job.get(key, [])]


def is_job(text):
    return (file_name(text) or "").endswith("-ci.yml")
