"""A run's log (.lcmlog): LCM's event log with the messages of lcmtypes/ in it."""

import dataclasses
import struct
import typing
import warnings

import numpy as np

from . import messages
from .errors import FileError, LogWarning, read_bytes
from .plan import OUTCOMES
from .records import Record, Records

_SYNC = 0xEDA1DA01
_HEADING = struct.Struct(">Iqqii")
_NAME_MAX = 255

# Of Run.state.
STATES = ("waiting", "taring", "approaching", "running", "stopping", "quick stopping", "holding", "disabling", "finished",
          "watching the brakes", "catching what a brake does not hold")
_WAITING, _TARING, _APPROACHING, _RUNNING, _STOPPING, _HOLDING = 0, 1, 2, 3, 4, 6


class Event(typing.NamedTuple):
    """A message as a log has it."""

    time_us: int  # when it was logged, since 1970
    channel: str
    data: bytes


@dataclasses.dataclass(frozen=True)
class Run:
    """A run: arrays of one row a control cycle, N in all, J joints.

    What means nothing in a cycle's state (forces before the tare, commands while nothing is commanded) is not a number.

    Attributes:
        time_s: (N,) since the first cycle
        log_time_us: (N,) int64, when it was logged, since 1970
        cycle: (N,) int64, cycles since the start of the run
        state: (N,) int8, index into STATES
        step: (N,) int16 of the plan, -1 where none runs
        phase: (N,) int8: 0 moving, 1 probing, 2 settling, 3 done
        contact_bits: (N,) uint16, see contacts()
        end_reason: (N,) int8, 0 while the run goes on
        tool_position_m: (N, 3) measured, in the task frame
        tool_orientation_wxyz: (N, 4)
        setpoint_position_m: (N, 3) of the compliance law
        setpoint_orientation_wxyz: (N, 4)
        commanded_position_m: (N, 3) what the compliance law made of it
        commanded_orientation_wxyz: (N, 4)
        velocity: (N, 6) commanded, m/s and rad/s
        force_N: (N, 3) on the tool by the environment, task axes at the tip
        torque_Nm: (N, 3)
        wrench_fresh: (N,) bool: a new sample of the sensor
        joint_position: (N, J) measured, m or rad
        joint_commanded: (N, J) commanded, m or rad
        joints_fresh: (N,) int32, bit i: joint i answered
        wakeup_late_s: (N,) from the due time to being awake
        compute_s: (N,) from the last feedback to the last setpoint
        late_cycles: (N,) int32, periods skipped so far
        joint_names: J; their numbers where the log does not name them
        joint_linear: J; m, else rad; None where the log does not say
        steps: as they ended: time_s, step, outcome, successor, travelled, duration_s, peak_force_N, ...
        statuses: about ten a second: time_s, pace, bus_load, ...
        setup: limits and thresholds; None where the log has none
        summary: the end of the run; None where it is not in the log
    """

    time_s: np.ndarray
    log_time_us: np.ndarray
    cycle: np.ndarray
    state: np.ndarray
    step: np.ndarray
    phase: np.ndarray
    contact_bits: np.ndarray
    end_reason: np.ndarray
    tool_position_m: np.ndarray
    tool_orientation_wxyz: np.ndarray
    setpoint_position_m: np.ndarray
    setpoint_orientation_wxyz: np.ndarray
    commanded_position_m: np.ndarray
    commanded_orientation_wxyz: np.ndarray
    velocity: np.ndarray
    force_N: np.ndarray
    torque_Nm: np.ndarray
    wrench_fresh: np.ndarray
    joint_position: np.ndarray
    joint_commanded: np.ndarray
    joints_fresh: np.ndarray
    wakeup_late_s: np.ndarray
    compute_s: np.ndarray
    late_cycles: np.ndarray
    joint_names: typing.Tuple[str, ...]
    joint_linear: typing.Tuple[typing.Optional[bool], ...]
    steps: Records
    statuses: Records
    setup: typing.Optional[Record]
    summary: typing.Optional[Record]

    @property
    def state_names(self):
        """(N,) of str."""
        return np.array(STATES)[self.state]


@dataclasses.dataclass(frozen=True)
class Log:
    """All runs of a log, and how far it could be read.

    Attributes:
        file: its name
        runs: of Run, those that have a cycle
        malformed: messages that make no sense and are left out
        breaks_off: the file ends within a message
        damage: where it is no log any more; what stands before is read
    """

    file: str
    runs: typing.List[Run]
    malformed: int
    breaks_off: bool
    damage: typing.Optional[FileError]


def events(file):
    """The events of a log, and after the last (None, breaks_off). Raises FileError where something else begins."""
    data = read_bytes(file)
    if len(data) < 4 or struct.unpack_from(">I", data)[0] != _SYNC:
        raise FileError(file, "is no LCM log: its first bytes are not eda1da01", 0)
    at = 0
    while at < len(data):
        if at + _HEADING.size > len(data):
            yield None, True
            return
        sync, _, time_us, name_size, data_size = _HEADING.unpack_from(data, at)
        if sync != _SYNC or not 0 <= name_size <= _NAME_MAX or data_size < 0:
            raise FileError(file, "no event of an LCM log begins here: the file is damaged", at)
        end = at + _HEADING.size + name_size + data_size
        if end > len(data):
            yield None, True
            return
        at += _HEADING.size
        channel = data[at:at + name_size].decode("utf-8", "replace")
        yield Event(time_us, channel, data[at + name_size:end]), False
        at = end
    yield None, False


class _Gathered:
    """The messages of one run, as they come."""

    def __init__(self):
        self.cycles = []  # (time_us, bytes)
        self.first_cycle = None
        self.last_sequence = -1
        self.steps, self.statuses = [], []
        self.setup = self.summary = None

    def add_cycle(self, event, joint_count):
        sequence, = struct.unpack_from(">q", event.data, messages.HASH_BYTES + 8)
        if sequence <= self.last_sequence or (self.cycles and joint_count != self.joint_count):
            return  # what the network has brought twice, or late, is no new cycle
        self.joint_count = joint_count
        self.last_sequence = sequence
        self.cycles.append((event.time_us, event.data))

    def since_s(self, monotonic_ns):
        start_ns, = struct.unpack_from(">q", self.cycles[0][1], messages.HASH_BYTES + 16)
        return max(0, monotonic_ns - start_ns) / 1e9

    def timed(self, values):
        return Record({"time_s": self.since_s(values["monotonic_ns"]), **values})


_CYCLE_HASH = messages.type_hash(messages.CYCLE)
_CYCLE_FIXED = messages.dtype_of(messages.CYCLE, {"joint_count": 0}).itemsize
_JOINT_COUNT_AT = messages.dtype_of(messages.CYCLE, {"joint_count": 0}).fields["joint_count"][1]


def _joints_of(data):
    """The number of joints of a cycle's bytes; raises Malformed."""
    if data[:messages.HASH_BYTES] != _CYCLE_HASH or len(data) < _CYCLE_FIXED:
        raise messages.Malformed("is no cycle")
    count, = struct.unpack_from(">b", data, _JOINT_COUNT_AT)
    if count < 0 or len(data) != _CYCLE_FIXED + 16 * count:
        raise messages.Malformed(f"has {count} joints in {len(data)} bytes")
    return count


class _Reader:
    """Gathers runs out of events."""

    def __init__(self):
        self.runs = [_Gathered()]
        self.malformed = 0

    def take(self, event):
        fields = messages.BY_CHANNEL.get(event.channel)
        if fields is None:
            return
        try:
            if fields is messages.CYCLE:
                joint_count = _joints_of(event.data)
                self.begin_anew(struct.unpack_from(">q", event.data, messages.HASH_BYTES + 8)[0])
                self.runs[-1].add_cycle(event, joint_count)
            else:
                self.take_other(event.channel, messages.decode(fields, event.data))
        except messages.Malformed:
            self.malformed += 1

    def begin_anew(self, sequence):
        """A run begins at 0; what was told before its first cycle is its own."""
        if sequence == 0 and self.runs[-1].cycles:
            self.runs.append(_Gathered())

    def take_other(self, channel, values):
        if channel == "TENON_SETUP":
            self.begin_anew(values["sequence"])
        run = self.runs[-1]
        if channel == "TENON_SETUP" and run.setup is None:
            run.setup = values
        if channel == "TENON_RUN":
            run.summary = values
        if channel == "TENON_STEP" and values["sequence"] == len(run.steps):
            run.steps.append(values)
        if channel == "TENON_STATUS":
            run.statuses.append(values)


def _masked(values, known):
    """Doubles of the machine's order, not a number where nothing is known."""
    values = values.astype(float)
    values[~known] = np.nan
    return values


def _step_record(gathered, values):
    record = gathered.timed(values)
    outcome = values["outcome"]
    record["outcome"] = OUTCOMES[outcome] if 0 <= outcome < len(OUTCOMES) else "?"
    record["successor"] = {254: "done", 255: "fail"}.get(values["successor"], values["successor"])
    return record


def _run_of(gathered):
    joint_count = gathered.joint_count
    dtype = messages.dtype_of(messages.CYCLE, {"joint_count": joint_count})
    table = np.frombuffer(b"".join(data for _, data in gathered.cycles), dtype)
    state = table["state"].astype(np.int8)
    joints_known = state != _WAITING
    forces_known = joints_known & (state != _TARING)
    commands = np.isin(state, (_APPROACHING, _RUNNING, _STOPPING, _HOLDING))
    native = lambda name: table[name].astype(table[name].dtype.newbyteorder("="))
    monotonic_ns = native("monotonic_ns")
    names, linear = tuple(str(i) for i in range(joint_count)), (None,) * joint_count
    if gathered.setup is not None and gathered.setup["joint_count"] == joint_count:
        names = tuple(gathered.setup["joint_names"].split("\n")[:joint_count])
        linear = tuple(bool(value) for value in gathered.setup["joint_linear"])
    return Run(
        time_s=np.maximum(monotonic_ns - monotonic_ns[0], 0) / 1e9,
        log_time_us=np.array([time_us for time_us, _ in gathered.cycles], dtype=np.int64),
        cycle=native("sequence"), state=state, step=native("step"), phase=native("phase"),
        contact_bits=native("signature").astype(np.uint16), end_reason=native("end_reason"),
        tool_position_m=_masked(table["pose_position_m"], joints_known),
        tool_orientation_wxyz=_masked(table["pose_orientation_wxyz"], joints_known),
        setpoint_position_m=_masked(table["setpoint_position_m"], commands),
        setpoint_orientation_wxyz=_masked(table["setpoint_orientation_wxyz"], commands),
        commanded_position_m=_masked(table["commanded_position_m"], commands),
        commanded_orientation_wxyz=_masked(table["commanded_orientation_wxyz"], commands),
        velocity=_masked(table["velocity"], commands),
        force_N=_masked(table["wrench"][:, :3], forces_known), torque_Nm=_masked(table["wrench"][:, 3:], forces_known),
        wrench_fresh=table["wrench_fresh"].copy(),
        joint_position=_masked(table["joint_position"], joints_known),
        joint_commanded=_masked(table["joint_commanded"], commands),
        joints_fresh=native("joints_fresh"), wakeup_late_s=native("wakeup_late_s"), compute_s=native("compute_s"),
        late_cycles=native("late_cycles"), joint_names=names, joint_linear=linear,
        steps=Records(_step_record(gathered, values) for values in gathered.steps),
        statuses=Records(gathered.timed(values) for values in gathered.statuses),
        setup=None if gathered.setup is None else Record(gathered.setup),
        summary=None if gathered.summary is None else Record(gathered.summary))


def read_log(file):
    """All runs of a log, a Log. Read as far as it goes; Log.breaks_off, .damage and .malformed say how far that is.

    Raises FileError where the file cannot be read, is no log, or holds no cycle of a run.
    """
    reader = _Reader()
    breaks_off, damage = False, None
    try:
        for event, off in events(file):
            if event is None:
                breaks_off = off
            else:
                reader.take(event)
    except FileError as error:
        if not any(run.cycles for run in reader.runs):
            raise
        damage = error
    runs = [_run_of(gathered) for gathered in reader.runs if gathered.cycles]
    if not runs:
        raise FileError(file, "holds no cycle of a run; give a log of tenon-exec or tenon-monitor")
    return Log(str(file), runs, reader.malformed, breaks_off, damage)


def read_run(file, run=-1):
    """One Run of a log: the last, or by its number from 0. Warns (LogWarning) of what of the log is missing."""
    log = read_log(file)
    if not -len(log.runs) <= run < len(log.runs):
        raise FileError(file, f"has no run {run}: it holds {len(log.runs)}")
    if log.damage is not None:
        warnings.warn(f"{log.damage}; what stands before is read", LogWarning, stacklevel=2)
    if log.breaks_off:
        warnings.warn(f"{log.file}: breaks off within a message; what stands before is read", LogWarning, stacklevel=2)
    if log.malformed:
        warnings.warn(f"{log.file}: {log.malformed} messages make no sense and are left out", LogWarning, stacklevel=2)
    return log.runs[run]
