"""Contact signatures: bit 2a says that the environment pushes the tool towards + on axis a, bit 2a + 1 towards -."""

NAMES = ("+x", "-x", "+y", "-y", "+z", "-z", "+rx", "-rx", "+ry", "-ry", "+rz", "-rz")


def contacts(bits):
    """The names of a signature's bits, apart by blanks, or "none"; as the programs print them."""
    return " ".join(name for i, name in enumerate(NAMES) if int(bits) >> i & 1) or "none"
