"""What a test that is a script found wrong: a line each, and at its end how many they are.

A script finds this module by `sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))`.
"""
import sys


class Failures:
    def __init__(self):
        self.count = 0

    def check(self, good, what):
        if not good:
            self.count += 1
            print(f"FAILED: {what}")


def run_test(test, *errors):
    """Runs a test and ends the program: with exit status 1 where something failed, or the test ended by an error.

    @param test: is given the Failures, and returns what it looked at, in words, or None
    @param errors: kinds of exceptions that are failures like others
    """
    failures = Failures()
    seen = None
    try:
        seen = test(failures)
    except errors as error:
        failures.check(False, error)
    print(f"{seen}, {failures.count} failures" if seen else f"{failures.count} failures")
    sys.exit(1 if failures.count else 0)
