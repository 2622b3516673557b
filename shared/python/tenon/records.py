"""Results (tenon-exec --json) and truths (tenon-sim --json)."""

import json

import numpy as np

from .errors import FileError, read_bytes

_AXIS_KEYS = ("x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad")


class Record(dict):
    """Keys of a file, which are attributes as well: record["status"] is record.status."""

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no '{name}'; there are: {', '.join(self)}") from None


class Records(list):
    """Records one after the other, such as the steps of a run."""

    def array(self, key):
        """(len, ...) of one value of each."""
        return np.array([record[key] for record in self])


def _converted(value):
    """Objects as Record, lists of numbers as arrays, lists of objects as Records."""
    if isinstance(value, dict):
        if set(value) == set(_AXIS_KEYS):
            return np.array([float(value[key]) for key in _AXIS_KEYS])
        return Record({key: _converted(entry) for key, entry in value.items()})
    if isinstance(value, list):
        if value and all(isinstance(entry, (int, float)) and not isinstance(entry, bool) for entry in value):
            return np.array(value, dtype=float)
        if all(isinstance(entry, dict) for entry in value):
            return Records(_converted(entry) for entry in value)
        return [_converted(entry) for entry in value]
    return value


def _read(file, keys, give):
    data = read_bytes(file)
    try:
        value = json.loads(data.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise FileError(file, f"is no text; {give}", error.start) from error
    except json.JSONDecodeError as error:
        raise FileError(file, f"is no whole JSON ({error.msg}); {give}",
                        len(error.doc[:error.pos].encode("utf-8"))) from error
    if not isinstance(value, dict):
        raise FileError(file, f"must be an object; {give}")
    for key in keys:
        if key not in value:
            raise FileError(file, f"{key} is missing; {give}")
    return _converted(value)


def read_result(file):
    """A result as a Record, its keys as executor/README.md has them; steps are Records.

    result.status, result.duration_s, result.steps.array("travelled") of shape (steps, 6), m and rad, ...
    Raises FileError.
    """
    return _read(file, ("status", "reason", "message", "task", "start", "steps", "duration_s", "cycle"),
                 "give the file that tenon-exec wrote with --json")


def read_truth(file):
    """A truth as a Record, its keys as sim/README.md has them; offset, tool and error are (6,), m and rad.

    truth.offset, truth.error_norm_m, truth.within_tolerance, ... Raises FileError.
    """
    return _read(file, ("task", "start", "offset", "tool", "error", "error_norm_m", "within_tolerance"),
                 "give the file that tenon-sim wrote with --json")
