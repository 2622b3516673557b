"""Reads an MCAP file byte by byte, from https://mcap.dev/spec alone: each record's length, each checksum, each offset
and each count is held against what stands there. Whatever is not as it should be raises Wrong."""
import dataclasses
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
(HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX, _, _, STATISTICS, METADATA,
 METADATA_INDEX, SUMMARY_OFFSET, DATA_END) = range(1, 16)


class Wrong(Exception):
    """What is wrong with a file."""


def check(good, what):
    if not good:
        raise Wrong(what)


@dataclasses.dataclass
class Message:
    channel: int
    sequence: int
    log_time: int
    publish_time: int
    data: bytes


class Cursor:
    """Values one after the other."""

    def __init__(self, data):
        self.data = data
        self.at = 0

    def take(self, form):
        size = struct.calcsize("<" + form)
        check(self.at + size <= len(self.data), f"a value at {self.at} of {len(self.data)} bytes")
        value, = struct.unpack_from("<" + form, self.data, self.at)
        self.at += size
        return value

    def bytes(self, size):
        check(self.at + size <= len(self.data), f"{size} bytes at {self.at} of {len(self.data)}")
        self.at += size
        return self.data[self.at - size:self.at]

    def text(self):
        return self.bytes(self.take("I")).decode("utf-8")

    def inner(self):
        """What stands behind a length of 32 bits."""
        return Cursor(self.bytes(self.take("I")))

    def left(self):
        return len(self.data) - self.at

    def all_of(self, *takes):
        values = tuple(take() for take in takes)
        check(self.left() == 0, f"{self.left()} bytes are left over in a record")
        return values


def pairs(cursor, key, value):
    found = {}
    while cursor.left():
        name = key(cursor)
        check(name not in found, f"{name} stands twice in a map")
        found[name] = value(cursor)
    return found


def records(data, begin, end):
    """(offset, opcode, content, length) of each record."""
    at = begin
    while at < end:
        check(at + 9 <= end, f"byte {at}: a record's heading runs past {end}")
        opcode, size = struct.unpack_from("<BQ", data, at)
        check(at + 9 + size <= end, f"byte {at}: a record of {size} bytes runs past {end}")
        yield at, opcode, data[at + 9:at + 9 + size], 9 + size
        at += 9 + size


def schema_of(content):
    cursor = Cursor(content)
    return cursor.take("H"), cursor.all_of(cursor.text, cursor.text, lambda: cursor.bytes(cursor.take("I")))


def channel_of(content):
    cursor = Cursor(content)
    number, schema, topic, encoding = cursor.take("H"), cursor.take("H"), cursor.text(), cursor.text()
    metadata = pairs(cursor.inner(), Cursor.text, Cursor.text)
    check(cursor.left() == 0, "bytes are left over in a channel")
    return number, (schema, topic, encoding, metadata)


def message_of(content):
    cursor = Cursor(content)
    return Message(cursor.take("H"), cursor.take("I"), cursor.take("Q"), cursor.take("Q"), cursor.bytes(cursor.left()))


class McapFile:
    """schemas: id -> (name, encoding, data); channels: id -> (schema, topic, encoding, metadata); messages in the
    file's order; metadata: name -> texts."""

    def __init__(self, path):
        self.data = data = path.read_bytes()
        check(data[:8] == MAGIC and data[-8:] == MAGIC, "does not begin and end with the magic bytes")
        self.schemas, self.channels, self.metadata = {}, {}, {}
        self.messages = []
        self.chunk_count = 0
        self.chunk_messages = {}  # by the chunk's offset
        self.indexes = {}  # offset of a message index -> its channel
        self.metadata_at = {}
        self.read_footer()
        data_end = self.read_data()
        check(data_end == self.summary_start, f"the data ends at {data_end}, the summary begins at {self.summary_start}")
        self.read_summary()

    def read_footer(self):
        at = len(self.data) - 8 - 9 - 20
        opcode, size = struct.unpack_from("<BQ", self.data, at)
        check((opcode, size) == (FOOTER, 20), f"byte {at}: no footer")
        self.footer_at = at
        self.summary_start, self.offsets_start, crc = struct.unpack_from("<QQI", self.data, at + 9)
        found = zlib.crc32(self.data[self.summary_start:at + 9 + 16])
        check(crc == found, f"checksum of the summary: {crc:08x}, the bytes have {found:08x}")

    def read_data(self):
        """@return the offset behind the data section"""
        first = True
        open_indexes = None  # (channel -> [(time, offset)]) that must follow a chunk
        for at, opcode, content, length in records(self.data, 8, self.footer_at):
            check((opcode == HEADER) == first, f"byte {at}: opcode {opcode} where the header is due, or the other way")
            first = False
            if opcode != MESSAGE_INDEX:
                check(not open_indexes, f"byte {at}: channels {open_indexes} have no index behind their chunk")
            if opcode == HEADER:
                cursor = Cursor(content)
                self.profile, self.library = cursor.all_of(cursor.text, cursor.text)
            elif opcode == SCHEMA:
                self.add_once(self.schemas, *schema_of(content))
            elif opcode == CHANNEL:
                self.add_channel(content)
            elif opcode == CHUNK:
                open_indexes = self.read_chunk(at, content)
            elif opcode == MESSAGE_INDEX:
                self.read_index(at, content, open_indexes)
            elif opcode == METADATA:
                cursor = Cursor(content)
                name = cursor.text()
                self.metadata[name] = pairs(cursor.inner(), Cursor.text, Cursor.text)
                self.metadata_at[at] = length
            elif opcode == DATA_END:
                crc, = struct.unpack("<I", content)
                found = zlib.crc32(self.data[:at])
                check(crc == found, f"checksum of the data: {crc:08x}, the bytes have {found:08x}")
                return at + length
            else:
                raise Wrong(f"byte {at}: opcode {opcode} in the data section")
        raise Wrong("the data section has no end")

    @staticmethod
    def add_once(table, number, value):
        check(number != 0 or len(value) == 4, "a schema of number 0")
        check(table.setdefault(number, value) == value, f"number {number} stands for two things")

    def add_channel(self, content):
        number, value = channel_of(content)
        check(value[0] in self.schemas, f"channel {number} is of schema {value[0]}, which was not told before")
        self.add_once(self.channels, number, value)

    def read_chunk(self, at, content):
        cursor = Cursor(content)
        start, end, size, crc = cursor.take("Q"), cursor.take("Q"), cursor.take("Q"), cursor.take("I")
        check(cursor.text() == "", "a chunk is compressed")
        inside = cursor.bytes(cursor.take("Q"))
        check(cursor.left() == 0 and len(inside) == size, f"byte {at}: a chunk of another size than it says")
        check(crc == zlib.crc32(inside), f"byte {at}: checksum of a chunk")
        index = {}
        here = []
        for offset, opcode, record, _ in records(inside, 0, len(inside)):
            check(opcode == MESSAGE, f"byte {at}: opcode {opcode} in a chunk")
            message = message_of(record)
            check(message.channel in self.channels, f"a message of channel {message.channel}, which was not told before")
            index.setdefault(message.channel, []).append((message.log_time, offset))
            here.append(message)
        check(here, f"byte {at}: an empty chunk")
        times = [message.log_time for message in here]
        check((start, end) == (min(times), max(times)), f"byte {at}: the times of a chunk")
        self.messages += here
        self.chunk_messages[at] = (len(here), index, 9 + len(content), start, end, size)
        self.chunk_count += 1
        return {channel: entries for channel, entries in index.items()}

    def read_index(self, at, content, open_indexes):
        cursor = Cursor(content)
        channel = cursor.take("H")
        inner = cursor.inner()
        entries = []
        while inner.left():
            entries.append((inner.take("Q"), inner.take("Q")))
        check(open_indexes and open_indexes.pop(channel, None) == entries, f"byte {at}: the index of channel {channel}")
        self.indexes[at] = (channel, 9 + len(content))

    def read_summary(self):
        groups = []  # [opcode, start, length]
        chunks, metadata = [], []
        for at, opcode, content, length in records(self.data, self.summary_start, self.offsets_start):
            if not groups or groups[-1][0] != opcode:
                groups.append([opcode, at, 0])
            groups[-1][2] += length
            if opcode == SCHEMA:
                number, value = schema_of(content)
                check(self.schemas.get(number) == value, f"schema {number} of the summary is another one")
            elif opcode == CHANNEL:
                number, value = channel_of(content)
                check(self.channels.get(number) == value, f"channel {number} of the summary is another one")
            elif opcode == CHUNK_INDEX:
                chunks.append(self.read_chunk_index(content))
            elif opcode == STATISTICS:
                self.read_statistics(content)
            elif opcode == METADATA_INDEX:
                cursor = Cursor(content)
                offset, size, name = cursor.all_of(lambda: cursor.take("Q"), lambda: cursor.take("Q"), cursor.text)
                check(self.metadata_at.get(offset) == size and name in self.metadata, f"the index of metadata {name}")
                metadata.append(offset)
            else:
                raise Wrong(f"byte {at}: opcode {opcode} in the summary")
        opcodes = [group[0] for group in groups]
        check(len(set(opcodes)) == len(opcodes), f"the summary is not grouped by opcode: {opcodes}")
        check({SCHEMA, CHANNEL, CHUNK_INDEX, STATISTICS} <= set(opcodes), f"the summary has only {opcodes}")
        check(opcodes.index(CHANNEL) < opcodes.index(STATISTICS), "channels behind the statistics")
        check(sorted(chunks) == sorted(self.chunk_messages), "chunks without an index in the summary")
        check(sorted(metadata) == sorted(self.metadata_at), "metadata without an index in the summary")
        told = []
        for at, opcode, content, _ in records(self.data, self.offsets_start, self.footer_at):
            check(opcode == SUMMARY_OFFSET, f"byte {at}: opcode {opcode} among the summary's offsets")
            told.append(list(struct.unpack("<BQQ", content)))
        check(told == groups, f"the summary's groups are {groups}, and told as {told}")

    def read_chunk_index(self, content):
        cursor = Cursor(content)
        start, end, at, length = (cursor.take("Q") for _ in range(4))
        offsets = pairs(cursor.inner(), lambda c: c.take("H"), lambda c: c.take("Q"))
        index_length, compression, packed, unpacked = (cursor.take("Q"), cursor.text(), cursor.take("Q"), cursor.take("Q"))
        check(cursor.left() == 0 and compression == "", "a chunk's index")
        check(at in self.chunk_messages, f"a chunk's index leads to byte {at}, where none is")
        _, index, size, first, last, inside = self.chunk_messages[at]
        check((length, start, end, packed, unpacked) == (size, first, last, inside, inside), f"the chunk at {at}")
        check(set(offsets) == set(index), f"the chunk at {at}: channels")
        behind = 0
        for channel, offset in offsets.items():
            check(self.indexes.get(offset, (None, 0))[0] == channel, f"the index of channel {channel} at {offset}")
            behind += self.indexes[offset][1]
        check(index_length == behind, f"the chunk at {at}: length of its indexes")
        return at

    def read_statistics(self, content):
        cursor = Cursor(content)
        told = (cursor.take("Q"), cursor.take("H"), cursor.take("I"), cursor.take("I"), cursor.take("I"), cursor.take("I"),
                cursor.take("Q"), cursor.take("Q"))
        counts = pairs(cursor.inner(), lambda c: c.take("H"), lambda c: c.take("Q"))
        check(cursor.left() == 0, "bytes are left over in the statistics")
        times = [message.log_time for message in self.messages]
        found = (len(self.messages), len(self.schemas), len(self.channels), 0, len(self.metadata), self.chunk_count,
                 min(times), max(times))
        check(told == found, f"the statistics are {found}, and told as {told}")
        for channel in self.channels:
            count = sum(message.channel == channel for message in self.messages)
            check(counts.get(channel) == count, f"channel {channel} has {count} messages, told are {counts.get(channel)}")

    def topic(self, name):
        """The messages of a topic."""
        number, = (number for number, value in self.channels.items() if value[1] == name)
        return [message for message in self.messages if message.channel == number]

    def schema(self, name):
        schema, = {value[0] for value in self.channels.values() if value[1] == name}
        return self.schemas[schema]
