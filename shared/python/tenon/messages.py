"""The messages of lcmtypes/, as tables, and how LCM puts them into bytes.

A message is the hash of its type (8 bytes) and its fields one after the other, big-endian, packed. A string has its
length with a final zero, i32, before it. The dimensions of an array are numbers, or names of fields before it.
"""

import struct

import numpy as np

# (type, name, dimensions); in the order of lcmtypes/*.lcm.
CYCLE = (
    ("int64_t", "utime"), ("int64_t", "sequence"), ("int64_t", "monotonic_ns"), ("int64_t", "motion_ns"),
    ("int8_t", "state"), ("int8_t", "arm_state"), ("int8_t", "end_reason"), ("int16_t", "step"), ("int8_t", "phase"),
    ("int16_t", "signature"), ("double", "pose_position_m", 3), ("double", "pose_orientation_wxyz", 4),
    ("double", "setpoint_position_m", 3), ("double", "setpoint_orientation_wxyz", 4),
    ("double", "commanded_position_m", 3), ("double", "commanded_orientation_wxyz", 4), ("double", "velocity", 6),
    ("double", "wrench", 6), ("boolean", "wrench_fresh"), ("int8_t", "joint_count"),
    ("double", "joint_position", "joint_count"), ("double", "joint_commanded", "joint_count"),
    ("int32_t", "joints_fresh"), ("double", "wakeup_late_s"), ("double", "compute_s"), ("int32_t", "late_cycles"),
    ("int64_t", "records_dropped"),
)
STEP = (
    ("int64_t", "utime"), ("int64_t", "sequence"), ("int64_t", "monotonic_ns"), ("int16_t", "step"),
    ("int8_t", "outcome"), ("int8_t", "deviation"), ("int16_t", "deviation_index"), ("int16_t", "successor"),
    ("int16_t", "signature_before"), ("int16_t", "signature"), ("double", "commanded", 6), ("double", "travelled", 6),
    ("double", "position_m", 3), ("double", "orientation_wxyz", 4), ("double", "decided_s"), ("double", "duration_s"),
    ("double", "peak_force_N"),
)
SETUP = (
    ("int64_t", "utime"), ("int64_t", "sequence"), ("int64_t", "monotonic_ns"), ("double", "cycle_s"),
    ("double", "force_fault_N"), ("double", "torque_fault_Nm"), ("double", "force_limit_N"),
    ("double", "torque_limit_Nm"), ("double", "bus_load_most"), ("int8_t", "compliant_axes"),
    ("int8_t", "joint_count"), ("int16_t", "step_count"), ("string", "plan"), ("string", "start"), ("string", "cell"),
    ("string", "robot"), ("string", "joint_names"), ("boolean", "joint_linear", "joint_count"),
    ("double", "joint_lower", "joint_count"), ("double", "joint_upper", "joint_count"),
    ("double", "displacement", "step_count", 6), ("int8_t", "expected", "step_count"),
    ("double", "expected_from", "step_count"), ("double", "expected_to", "step_count"),
    ("double", "force_on_N", "step_count"), ("double", "torque_on_Nm", "step_count"),
    ("double", "timeout_s", "step_count"), ("int16_t", "trigger_mask", "step_count"),
    ("int8_t", "sensed_axes", "step_count"),
)
STATUS = (
    ("int64_t", "utime"), ("int64_t", "sequence"), ("int64_t", "monotonic_ns"), ("int16_t", "awaited_step"),
    ("double", "pace"), ("int8_t", "slipped_joint"), ("double", "slipped"), ("int32_t", "brakes_unwatched"),
    ("int8_t", "arm_fault"), ("int16_t", "arm_fault_node"), ("boolean", "bus_known"), ("boolean", "bus_up"),
    ("boolean", "bus_off"), ("boolean", "error_passive"), ("double", "bus_load"), ("double", "bus_load_worst"),
    ("double", "frame_rate_hz"), ("int64_t", "sent"), ("int64_t", "received"), ("int64_t", "send_failures"),
    ("int64_t", "malformed"), ("int64_t", "error_frames"), ("int64_t", "overruns"),
)
SUMMARY = (
    ("int64_t", "utime"), ("int64_t", "sequence"), ("int64_t", "monotonic_ns"), ("string", "plan"),
    ("string", "start"), ("int8_t", "end_reason"), ("string", "message"), ("int8_t", "exit_code"),
    ("int16_t", "steps"), ("int64_t", "late_cycles"), ("int64_t", "incomplete_cycles"), ("int64_t", "records_dropped"),
    ("double", "peak_force_N"), ("double", "wakeup_late_max_s"), ("double", "compute_max_s"),
)
BY_CHANNEL = {"TENON_CYCLE": CYCLE, "TENON_STEP": STEP, "TENON_SETUP": SETUP, "TENON_STATUS": STATUS,
              "TENON_RUN": SUMMARY}

_DTYPES = {"int8_t": ">i1", "int16_t": ">i2", "int32_t": ">i4", "int64_t": ">i8", "double": ">f8", "boolean": "?"}
HASH_BYTES = 8
_BITS = (1 << 64) - 1


def _hash_byte(value, byte):
    # LCM's hash is a signed number of 64 bits, and shifts its sign in.
    signed = value - (1 << 64) if value >> 63 else value
    return ((value << 8) ^ (signed >> 55)) + byte & _BITS


def _hash_text(value, text):
    value = _hash_byte(value, len(text))
    for byte in text.encode("ascii"):
        value = _hash_byte(value, byte)
    return value


def type_hash(fields):
    """The eight bytes that LCM puts before each message of a type."""
    value = 0x12345678
    for kind, name, *dimensions in fields:
        value = _hash_text(value, name)
        value = _hash_text(value, kind)
        value = _hash_byte(value, len(dimensions))
        for dimension in dimensions:
            value = _hash_byte(value, 1 if isinstance(dimension, str) else 0)
            value = _hash_text(value, str(dimension))
    return struct.pack(">Q", (value << 1) + (value >> 63) & _BITS)


class Malformed(ValueError):
    """Bytes that are not a message of the type."""


def _take_string(data, at):
    if at + 4 > len(data):
        raise Malformed("ends within the length of a text")
    size, = struct.unpack_from(">i", data, at)
    at += 4
    if size < 1 or at + size > len(data) or data[at + size - 1] != 0:
        raise Malformed(f"byte {at - 4}: a text of {size} bytes")
    return data[at:at + size - 1].decode("utf-8", "replace"), at + size


def decode(fields, data):
    """The fields of a message by name: ints, floats, bools, strs, arrays of their dimensions. Raises Malformed."""
    if data[:HASH_BYTES] != type_hash(fields):
        raise Malformed("is of another type, or of another version of it")
    values = {}
    at = HASH_BYTES
    for kind, name, *dimensions in fields:
        if kind == "string":
            values[name], at = _take_string(data, at)
            continue
        shape = tuple(values[size] if isinstance(size, str) else size for size in dimensions)
        if any(size < 0 for size in shape):
            raise Malformed(f"{name}: {shape} values")
        dtype = np.dtype(_DTYPES[kind])
        count = int(np.prod(shape, dtype=np.int64)) if shape else 1
        if at + count * dtype.itemsize > len(data):
            raise Malformed(f"ends within {name}")
        read = np.frombuffer(data, dtype, count, at)
        at += count * dtype.itemsize
        values[name] = read.astype(dtype.newbyteorder("=")).reshape(shape) if shape else read[0].item()
    if at != len(data):
        raise Malformed(f"{len(data) - at} bytes are left over")
    return values


def dtype_of(fields, sizes):
    """A numpy dtype of a whole message, its hash included, whose named dimensions are the given numbers."""
    members = [("hash", "V8")]
    for kind, name, *dimensions in fields:
        shape = tuple(sizes[size] if isinstance(size, str) else size for size in dimensions)
        members.append((name, _DTYPES[kind], shape))
    return np.dtype(members)
