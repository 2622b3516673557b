"""What is raised and what is warned of."""


class FileError(ValueError):
    """A file that cannot be read, or is not what it should be.

    Attributes: file (str), byte (int or None) where it was noticed, what (str): field and bound.
    """

    def __init__(self, file, what, byte=None):
        self.file = str(file)
        self.byte = byte
        self.what = what
        super().__init__(f"{self.file}: {what}" if byte is None else f"{self.file}: byte {byte}, {what}")


class LogWarning(UserWarning):
    """A log that could be read in part alone."""


def read_bytes(file):
    """All bytes of a file. Raises FileError."""
    try:
        with open(file, "rb") as stream:
            return stream.read()
    except OSError as error:
        raise FileError(file, f"cannot be read: {error.strerror}") from error
