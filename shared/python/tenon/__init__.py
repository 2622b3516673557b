"""What Tenon's programs write, as numpy arrays: plans, run logs, results, truths.

    import tenon
    run = tenon.read_run("run.lcmlog")          # tenon-exec --log
    plan = tenon.read_plan("plan.tnp")          # tenon-plan --output
    result = tenon.read_result("result.json")   # tenon-exec --json
    truth = tenon.read_truth("truth.json")      # tenon-sim --json

SI units, and names that end in them. Poses are of the tool in the task frame, quaternions w x y z; six numbers are
x y z rx ry rz. What cannot be read raises FileError, which names the file, the place and what is allowed there.
"""

from .contacts import contacts
from .errors import FileError, LogWarning
from .log import Log, Run, read_log, read_run
from .plan import OUTCOMES, OutcomeRule, ParameterSet, Plan, Step, read_plan
from .records import Record, Records, read_result, read_truth
from .version import version

__version__ = version()

__all__ = [
    "FileError", "LogWarning", "Log", "Run", "read_log", "read_run", "OUTCOMES", "OutcomeRule", "ParameterSet", "Plan",
    "Step", "read_plan", "Record", "Records", "read_result", "read_truth", "contacts",
]
