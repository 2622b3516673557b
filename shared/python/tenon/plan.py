"""The plan file (.tnp), versions 1 to 4, as shared/plan/FORMAT.md has it byte by byte."""

import dataclasses
import math
import struct
import typing

import numpy as np

from .contacts import contacts
from .errors import FileError, read_bytes

OUTCOMES = ("reached", "contact", "release", "blocked", "timeout")
METHODS = ("mha", "single-particle", "contact-greedy")
AXES = ("x", "y", "z", "rx", "ry", "rz")

_MAGIC = b"TNP\x1a"
_VERSIONS = (1, 2, 3, 4)
_HEADER_BYTES = 205
_CHECKSUM_BYTES = 4
_ALL_AXES = 0x3F
_ALL_CONTACTS = 0x0FFF
_DONE = 0xFE
_COUNT_MAX = 200
_NAME_MAX = 63
_QUATERNION_SLACK = 1e-9

# Ranges; (low, high, whether low itself is outside).
_POSITION = (-1e3, 1e3, False)
_TRAVEL = (-10.0, 10.0, False)
_UP_TO_10 = (0.0, 10.0, True)
_UP_TO_1E4 = (0.0, 1e4, True)
_UP_TO_1E7 = (0.0, 1e7, True)


@dataclasses.dataclass(frozen=True)
class OutcomeRule:
    """Where an outcome leads, and what validation saw of it.

    Attributes:
        successor: step, or "done"
        always: contacts that every settled signature had, as contacts() has them
        possible: contacts that some had
        travelled_min: (6,) m and rad
        travelled_max: (6,) m and rad
        place_min: (6,) m and rad, from where the tool stood when the plan began; zero where the plan says none
        place_max: (6,) m and rad
    """

    successor: typing.Union[int, str]
    always: str
    possible: str
    travelled_min: np.ndarray
    travelled_max: np.ndarray
    place_min: np.ndarray
    place_max: np.ndarray


@dataclasses.dataclass(frozen=True)
class Step:
    """A guarded move.

    Attributes:
        parameter_set: index into Plan.parameter_sets
        slow_from_m: way after which the contact speed holds
        displacement: (6,) m and rad
        outcomes: by name; every other outcome leads to fail
    """

    parameter_set: int
    slow_from_m: float
    displacement: np.ndarray
    outcomes: typing.Dict[str, OutcomeRule]


@dataclasses.dataclass(frozen=True)
class ParameterSet:
    """Speeds, thresholds and what ends a move; units in the names.

    Attributes:
        approach_mps: speed up to slow_from_m
        contact_mps: speed from there on
        acceleration_mps2
        jerk_mps3
        approach_radps
        contact_radps
        acceleration_radps2
        jerk_radps3
        force_on_N: a contact begins above it
        force_keep_N: that a contact is held with
        force_off_N: a contact ends below it
        torque_on_Nm
        torque_keep_Nm
        torque_off_Nm
        debounce_us: that a contact has to last
        timeout_us: of a move
        trigger_mask: contacts that end a move, as contacts() has them
        sensed_axes: on which contacts are decided from the wrench, such as "x y"
        carried_axes: displacements, contacts and envelopes are in axes that the tool carries
        aligns: where rotations yield, a contact is pressed until the tool lies flat on it
    """

    approach_mps: float
    contact_mps: float
    acceleration_mps2: float
    jerk_mps3: float
    approach_radps: float
    contact_radps: float
    acceleration_radps2: float
    jerk_radps3: float
    force_on_N: float
    force_keep_N: float
    force_off_N: float
    torque_on_Nm: float
    torque_keep_Nm: float
    torque_off_Nm: float
    debounce_us: int
    timeout_us: int
    trigger_mask: str
    sensed_axes: str
    carried_axes: bool
    aligns: bool


@dataclasses.dataclass(frozen=True)
class Plan:
    """A plan: guarded moves, and for each outcome of each the step that follows.

    Attributes:
        version: of the format
        task_name: of the task that was planned
        start_name: name of the nominal start
        task_hash: FNV-1a of the task file that was planned
        method: "mha", "single-particle", "contact-greedy"
        check_envelopes: whether execution checks them
        coordinates: such as "x y rz"
        start_position_m: (3,) nominal, tool in the task frame
        start_orientation_wxyz: (4,)
        goal_position_m: (3,) likewise
        goal_orientation_wxyz: (4,)
        goal_tolerance_m: within which a draw is at the goal
        goal_axis_tolerances: (6,) m and rad, of axes that do not count in goal_tolerance_m; 0 where one does
        goal_free_axes: along which any end will do, such as "rz"
        mass_kg: of the compliance, as the next five
        damping_Nspm
        stiffness_Npm
        inertia_kgm2
        damping_Nmspr
        stiffness_Nmpr
        compliant_axes: that yield, such as "x y"
        force_limit_N: a held tool is pulled no harder
        torque_limit_Nm: the same
        contact_stiffness_Npm: that the plan was certified with
        latency_max_s: that the plan holds for
        cost: of the chain
        bound: cost <= bound times the optimum; 0: none claimed
        draws: of validation
        draws_at_goal: of which ended there
        parameter_sets: of ParameterSet
        steps: of Step
    """

    version: int
    task_name: str
    start_name: str
    task_hash: int
    method: str
    check_envelopes: bool
    coordinates: str
    start_position_m: np.ndarray
    start_orientation_wxyz: np.ndarray
    goal_position_m: np.ndarray
    goal_orientation_wxyz: np.ndarray
    goal_tolerance_m: float
    goal_axis_tolerances: np.ndarray
    goal_free_axes: str
    mass_kg: float
    damping_Nspm: float
    stiffness_Npm: float
    inertia_kgm2: float
    damping_Nmspr: float
    stiffness_Nmpr: float
    compliant_axes: str
    force_limit_N: float
    torque_limit_Nm: float
    contact_stiffness_Npm: float
    latency_max_s: float
    cost: float
    bound: float
    draws: int
    draws_at_goal: int
    parameter_sets: typing.List[ParameterSet]
    steps: typing.List[Step]

    @property
    def displacements(self):
        """(steps, 6) m and rad."""
        return np.array([step.displacement for step in self.steps])

    def thresholds(self, name):
        """(steps,) of one value of each step's parameter set, such as "force_on_N"."""
        return np.array([getattr(self.parameter_sets[step.parameter_set], name) for step in self.steps])


def _crc_table():
    table = []
    for byte in range(256):
        remainder = byte
        for _ in range(8):
            remainder = remainder >> 1 ^ (0x82F63B78 if remainder & 1 else 0)
        table.append(remainder)
    return table


_CRC_TABLE = _crc_table()


def crc32c(data):
    """CRC-32C of bytes; "123456789" gives 0xE3069283."""
    remainder = 0xFFFFFFFF
    for byte in data:
        remainder = remainder >> 8 ^ _CRC_TABLE[(remainder ^ byte) & 0xFF]
    return remainder ^ 0xFFFFFFFF


class _Reader:
    """Fields one after the other; refuses by name and byte."""

    def __init__(self, file, data):
        self.file = file
        self.data = data
        self.at = 0
        self.field_at = 0

    def refuse(self, field, why):
        raise FileError(self.file, f"{field}: {why}", self.field_at)

    def take(self, field, form):
        size = struct.calcsize("<" + form)
        self.field_at = self.at
        if self.at + size > len(self.data) - _CHECKSUM_BYTES:
            self.refuse(field, "the file ends within it")
        value, = struct.unpack_from("<" + form, self.data, self.at)
        self.at += size
        return value

    def real(self, field, form, limits):
        value = self.take(field, form)
        low, high, open_below = limits
        if not math.isfinite(value):
            self.refuse(field, f"= {value}, must be finite")
        if not (low <= value <= high) or (open_below and value == low):
            self.refuse(field, f"= {value:g}, must be in {'(' if open_below else '['}{low:g}, {high:g}]")
        return value

    def f32(self, field, limits):
        return self.real(field, "f", limits)

    def f64(self, field, limits):
        return self.real(field, "d", limits)

    def whole(self, field, form, low, high):
        value = self.take(field, form)
        if not low <= value <= high:
            self.refuse(field, f"= {value}, must be in [{low}, {high}]")
        return value

    def bits(self, field, form, allowed):
        value = self.take(field, form)
        if value & ~allowed:
            self.refuse(field, f"= {value:#x}, must have no bits but {allowed:#x}")
        return value

    def name(self, field):
        size = self.whole(field, "B", 0, _NAME_MAX)
        self.field_at = self.at
        if self.at + size > len(self.data) - _CHECKSUM_BYTES:
            self.refuse(field, "the file ends within it")
        text = self.data[self.at:self.at + size]
        if any(byte < 0x20 or byte > 0x7E for byte in text):
            self.refuse(field, "must be printable ASCII")
        self.at += size
        return text.decode("ascii")


def _axes(bits):
    return " ".join(name for i, name in enumerate(AXES) if bits >> i & 1) or "none"


def _pose(reader, position, orientation):
    place = np.array([reader.f64(position, _POSITION) for _ in range(3)])
    x, y, z, w = (reader.f64(orientation, (-1.0, 1.0, False)) for _ in range(4))
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if not abs(norm - 1.0) <= _QUATERNION_SLACK:
        reader.refuse(orientation, f"has norm {norm!r}, must be within {_QUATERNION_SLACK:g} of 1")
    return place, np.array([w, x, y, z])


def _parameter_set(reader, version, force_limit_N):
    values = {}
    for name in ("approach_mps", "contact_mps"):
        values[name] = reader.f32(name, _UP_TO_10)
    values["acceleration_mps2"] = reader.f32("acceleration_mps2", _UP_TO_1E4)
    values["jerk_mps3"] = reader.f32("jerk_mps3", _UP_TO_1E7)
    for name in ("approach_radps", "contact_radps"):
        values[name] = reader.f32(name, _UP_TO_10)
    values["acceleration_radps2"] = reader.f32("acceleration_radps2", _UP_TO_1E4)
    values["jerk_radps3"] = reader.f32("jerk_radps3", _UP_TO_1E7)
    for kind, unit in (("force", "N"), ("torque", "Nm")):
        on, keep, off = (f"{kind}_{which}_{unit}" for which in ("on", "keep", "off"))
        values[on] = reader.f32(on, _UP_TO_1E4)
        # To be above a bound by no more than rounding is no excess.
        if kind == "force" and 1.5 * values[on] > force_limit_N * (1.0 + 1e-6):
            reader.refuse(on, f"= {values[on]:g}, 1.5 times it must be at most force_limit_N = {force_limit_N:g}")
        for name, above in ((keep, on), (off, keep)):
            values[name] = reader.f32(name, _UP_TO_1E4)
            if not values[name] < values[above]:
                reader.refuse(name, f"= {values[name]:g}, must be below {above} = {values[above]:g}")
    values["debounce_us"] = reader.whole("debounce_us", "I", 0, 1_000_000)
    values["timeout_us"] = reader.whole("timeout_us", "I", 1, 600_000_000)
    values["trigger_mask"] = contacts(reader.bits("trigger_mask", "H", _ALL_CONTACTS))
    sensed = reader.bits("sensed_axes", "B", _ALL_AXES) if version >= 2 else _ALL_AXES
    values["sensed_axes"] = _axes(sensed)
    flags = reader.bits("axes", "B", 3) if version >= 2 else 0
    values["carried_axes"] = bool(flags & 1)
    values["aligns"] = not flags & 2
    return ParameterSet(**values)


def _range(reader, names, axes):
    low, high = np.zeros(6), np.zeros(6)
    for axis in axes:
        low[axis] = reader.f32(names[0], _TRAVEL)
        high[axis] = reader.f32(names[1], _TRAVEL)
        if low[axis] > high[axis]:
            reader.refuse(names[1], f"= {high[axis]:g}, must be at least {names[0]} = {low[axis]:g}")
    return low, high


def _goal_axes(reader, version, coordinates, axes):
    """Which of a goal's axes do not count in its one tolerance, and what each allows."""
    tolerances = np.zeros(6)
    if version < 4:
        return tolerances, "none"
    free = reader.bits("goal_free_axes", "B", coordinates)
    for axis in axes:
        tolerances[axis] = reader.f32("goal_axis_tolerance", (0.0, 10.0, False))
        if free >> axis & 1 and tolerances[axis]:
            reader.refuse("goal_axis_tolerance", f"= {tolerances[axis]:g}, must be 0 of a free axis")
    if not free and not tolerances.any():
        raise FileError(reader.file, "version: = 4, though a lower one says as much: no axis of the goal differs", 4)
    return tolerances, _axes(free)


def _outcome(reader, places, step, step_count, axes):
    successor = reader.take("successor", "B")
    if successor != _DONE and not step < successor < step_count:
        reader.refuse("successor", f"= {successor}, must be a step after {step}, below {step_count}, or {_DONE}")
    always = reader.bits("always", "H", _ALL_CONTACTS)
    possible = reader.bits("possible", "H", _ALL_CONTACTS)
    if always & ~possible:
        reader.refuse("possible", "must have every bit of always")
    travelled = _range(reader, ("travelled_min", "travelled_max"), axes)
    place = _range(reader, ("place_min", "place_max"), axes if places else [])
    return OutcomeRule("done" if successor == _DONE else successor, contacts(always), contacts(possible),
                       *travelled, *place)


def _step(reader, places, index, step_count, set_count, axes):
    parameter_set = reader.whole("parameter_set", "B", 0, set_count - 1)
    present = reader.bits("outcomes", "B", 0x1F)
    slow_from_m = reader.f32("slow_from_m", (0.0, 10.0, False))
    displacement = np.zeros(6)
    for axis in axes:
        displacement[axis] = reader.f32("displacement", _TRAVEL)
    outcomes = {name: _outcome(reader, places, index, step_count, axes)
                for bit, name in enumerate(OUTCOMES) if present >> bit & 1}
    return Step(parameter_set, slow_from_m, displacement, outcomes)


def _check_whole(file, data):
    """Magic, version, length and checksum, before anything else is believed."""
    if len(data) < _HEADER_BYTES + _CHECKSUM_BYTES:
        raise FileError(file, f"magic: {len(data)} bytes, a plan has at least {_HEADER_BYTES + _CHECKSUM_BYTES}", 0)
    if data[:4] != _MAGIC:
        raise FileError(file, f"magic: is {data[:4].hex(' ')}, a plan begins with {_MAGIC.hex(' ')}", 0)
    version, = struct.unpack_from("<H", data, 4)
    if version not in _VERSIONS:
        raise FileError(file, f"version: = {version}, this reads versions 1 to 4", 4)
    length, = struct.unpack_from("<I", data, 8)
    if length != len(data):
        raise FileError(file, f"length: = {length}, the file has {len(data)} bytes", 8)
    told, = struct.unpack_from("<I", data, len(data) - _CHECKSUM_BYTES)
    found = crc32c(data[:-_CHECKSUM_BYTES])
    if told != found:
        raise FileError(file, f"checksum: = {told:08x}, the bytes have {found:08x}: the file is damaged",
                        len(data) - _CHECKSUM_BYTES)
    return version


def decode_plan(data, file="plan"):
    """A Plan from its bytes. Raises FileError; file is for its message alone."""
    version = _check_whole(file, data)
    reader = _Reader(file, data)
    reader.at = 6
    flags = reader.take("flags", "B")
    if flags & ~0x0f or (flags >> 1 & 3) >= len(METHODS):
        reader.refuse("flags", f"= {flags:#x}, must have bits 0 to 3 alone, and a method below {len(METHODS)}")
    places = flags & 0x08 != 0
    if version < 4 and places != (version == 3) or flags & 0x09 == 0x08:
        reader.refuse("flags", f"= {flags:#x}, must have bit 3, with bit 0, in version 3, may in 4, and nowhere else")
    coordinates = reader.whole("coordinates", "B", 1, _ALL_AXES)
    axes = [axis for axis in range(6) if coordinates >> axis & 1]
    reader.at = 12
    header = {"version": version, "task_hash": reader.take("task_hash", "Q"),
              "method": METHODS[flags >> 1 & 3], "check_envelopes": bool(flags & 1), "coordinates": _axes(coordinates)}
    for which in ("start", "goal"):
        place, orientation = _pose(reader, f"{which}_position_m", f"{which}_orientation")
        header[f"{which}_position_m"], header[f"{which}_orientation_wxyz"] = place, orientation
    for name, limits in (("goal_tolerance_m", _UP_TO_10), ("mass_kg", _UP_TO_1E4), ("damping_Nspm", _UP_TO_1E7),
                         ("stiffness_Npm", _UP_TO_1E7), ("inertia_kgm2", _UP_TO_1E4), ("damping_Nmspr", _UP_TO_1E7),
                         ("stiffness_Nmpr", _UP_TO_1E7)):
        header[name] = reader.f32(name, limits)
    header["compliant_axes"] = _axes(reader.bits("compliant_axes", "B", _ALL_AXES))
    for name, limits in (("force_limit_N", _UP_TO_1E4), ("torque_limit_Nm", _UP_TO_1E4),
                         ("contact_stiffness_Npm", (0.0, 1e9, True)), ("latency_max_s", (0.0, 1.0, False))):
        header[name] = reader.f32(name, limits)
    header["cost"] = reader.f64("cost", (0.0, 1e12, False))
    header["bound"] = reader.f64("bound", (0.0, 1e12, False))
    if 0.0 < header["bound"] < 1.0:
        reader.refuse("bound", f"= {header['bound']:g}, must be 0 or in [1, 1e12]")
    header["draws"] = reader.take("draws", "I")
    header["draws_at_goal"] = reader.whole("draws_at_goal", "I", 0, header["draws"])
    header["task_name"] = reader.name("task_name")
    header["start_name"] = reader.name("start_name")
    set_count = reader.whole("parameter_set_count", "B", 1, _COUNT_MAX)
    step_count = reader.whole("step_count", "B", 1, _COUNT_MAX)
    header["goal_axis_tolerances"], header["goal_free_axes"] = _goal_axes(reader, version, coordinates, axes)
    sets = [_parameter_set(reader, version, header["force_limit_N"]) for _ in range(set_count)]
    if version == 2 and all(s.sensed_axes == _axes(_ALL_AXES) and not s.carried_axes and s.aligns for s in sets):
        raise FileError(file, "version: = 2, though version 1 says as much: every axis is sensed, none is carried", 4)
    steps = [_step(reader, places, i, step_count, set_count, axes) for i in range(step_count)]
    if reader.at != len(data) - _CHECKSUM_BYTES:
        raise FileError(file, f"steps: {len(data) - _CHECKSUM_BYTES - reader.at} bytes are left over behind the last",
                        reader.at)
    return Plan(parameter_sets=sets, steps=steps, **header)


def read_plan(file):
    """A Plan from a .tnp file. Raises FileError that names the field and the byte."""
    return decode_plan(read_bytes(file), file)
