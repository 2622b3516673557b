"""A program on a pseudo-terminal, and what a person would see there: pyte emulates the screen."""
import fcntl
import os
import re
import select
import signal
import struct
import subprocess
import termios
import time

import pyte

ENTERED = b"\x1b[?1049h"
LEFT = b"\x1b[?1049l"


class Stream(pyte.ByteStream):
    """With what xterm has and pyte has not: scroll up (SU), scroll down (SD), repeat (REP)."""
    csi = {**pyte.ByteStream.csi, "S": "scroll_up", "T": "scroll_down", "b": "repeat"}
    events = pyte.ByteStream.events | {"scroll_up", "scroll_down", "repeat"}


class Screen(pyte.Screen):
    """Counts what no line of a screen that is drawn whole may do: run over its end."""

    def __init__(self, columns, rows):
        self.wraps = 0
        self.last = " "
        super().__init__(columns, rows)

    def draw(self, data):
        for character in data:
            self.wraps += self.cursor.x >= self.columns
            self.last = character
            super().draw(character)

    def repeat(self, count=1):
        self.draw(self.last * max(1, count))

    def _scroll(self, count, at_bottom, one):
        top, bottom = self.margins or (0, self.lines - 1)
        row = self.cursor.y
        self.cursor.y = bottom if at_bottom else top
        for _ in range(max(1, count)):
            one()
        self.cursor.y = row

    def scroll_up(self, count=1):
        self._scroll(count, True, self.index)

    def scroll_down(self, count=1):
        self._scroll(count, False, self.reverse_index)


class Terminal:
    """@param limit_bytes that a file of the program's may have, as on a disk that is then full"""

    def __init__(self, command, columns, rows, environment=None, limit_bytes=None, folder=None):
        self.master, self.slave = os.openpty()
        self.screen = Screen(columns, rows)
        self.stream = Stream(self.screen)
        self.raw = b""
        self._set_size(columns, rows)
        self.before = termios.tcgetattr(self.slave)
        environment = {**{name: value for name, value in os.environ.items() if name != "NO_COLOR"},
                       "TERM": "xterm-256color", "LC_ALL": "C.UTF-8", **(environment or {})}

        def in_child():
            os.setsid()
            fcntl.ioctl(0, termios.TIOCSCTTY, 0)
            if limit_bytes:
                import resource
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit_bytes, resource.RLIM_INFINITY))

        self.process = subprocess.Popen(command, stdin=self.slave, stdout=self.slave, stderr=self.slave, cwd=folder,
                                        env=environment, preexec_fn=in_child)

    def _set_size(self, columns, rows):
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def resize(self, columns, rows):
        self.screen.resize(rows, columns)
        # A terminal of another size holds whatever it makes of the old lines.
        for row in range(rows):
            self.screen.cursor_position(row + 1, 1)
            self.stream.feed(b"#" * (columns - 1))
        self.screen.wraps = 0
        self._set_size(columns, rows)

    def press(self, keys):
        os.write(self.master, keys.encode())

    def read(self, seconds=0.1):
        """Takes in what is written within that time."""
        end = time.monotonic() + seconds
        while True:
            ready, _, _ = select.select([self.master], [], [], max(0.0, end - time.monotonic()))
            if not ready:
                return
            data = os.read(self.master, 65536)
            self.raw += data
            self.stream.feed(data)

    def lines(self):
        return list(self.screen.display)

    def text(self):
        return "\n".join(self.lines())

    def row(self, pattern):
        """The first row that matches, and its number; None where none does."""
        for number, line in enumerate(self.lines()):
            if re.search(pattern, line):
                return number
        return None

    def wait_for(self, pattern, seconds=15.0):
        """Until a row matches."""
        end = time.monotonic() + seconds
        while self.row(pattern) is None and time.monotonic() < end and self.process.poll() is None:
            self.read()
        return self.row(pattern) is not None

    def style(self, row, column):
        """(foreground, background) by name."""
        character = self.screen.buffer[row][column]
        return character.fg, character.bg

    def colours(self):
        return {self.style(row, column) for row in range(self.screen.lines) for column in range(self.screen.columns)}

    def end(self, how, seconds=10.0):
        """@param how a key or a signal  @return its exit status"""
        if isinstance(how, str):
            self.press(how)
        else:
            self.process.send_signal(how)
        end = time.monotonic() + seconds
        while self.process.poll() is None and time.monotonic() < end:
            self.read(0.05)
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
            return "killed by the test"
        self.read(0.2)
        return self.process.returncode

    def restored(self):
        """What is not as it was before; empty where all is."""
        faults = []
        if termios.tcgetattr(self.slave) != self.before:
            faults.append("the line discipline")
        if self.raw.rfind(LEFT) < self.raw.rfind(ENTERED):
            faults.append("the screen's contents")
        if self.raw.rfind(b"\x1b[?25h") < self.raw.rfind(b"\x1b[?25l"):
            faults.append("the cursor")
        return faults

    def close(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
            self.process.wait()
        os.close(self.master)
        os.close(self.slave)
