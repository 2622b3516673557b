"""Pages that a test looked at before and passed are not looked at again while they are byte for byte the same: without
a graphics card a browser takes a minute for a few of them.

A release looks at all of them, whatever was: TENON_EVERY_WINDOW is set.
"""
import hashlib
import os
import pathlib
import subprocess

from browser import program

HERE = pathlib.Path(__file__).resolve().parent


class LookedAt:
    """@param script: the test's own file  @param plans: the folder of the plans that the tests share; beside it is
    kept what passed  @param pages: all that are looked at, in an order that stays  @param pictures: are wanted anew"""

    def __init__(self, script, plans, pages, pictures):
        digest = hashlib.sha256(subprocess.run([program(), "--version"], capture_output=True, check=True).stdout)
        for file in [*sorted(HERE.glob("*.py")), HERE.parent / "support/failures.py", *pages]:
            digest.update(hashlib.sha256(pathlib.Path(file).read_bytes()).digest())
        self.bytes = digest.hexdigest()
        self.file = pathlib.Path(plans).resolve().parent / "looked_at" / pathlib.Path(script).stem
        self.wanted = bool(pictures) or "TENON_EVERY_WINDOW" in os.environ

    def before(self):
        """Whether these very pages passed, when the very same was asked of them."""
        return not self.wanted and self.file.exists() and self.file.read_text() == self.bytes

    def now(self, failures):
        """The pages were looked at: what had no failure is remembered."""
        if failures.count == 0:
            self.file.parent.mkdir(exist_ok=True)
            self.file.write_text(self.bytes)
