"""A network of a test's own, where LCM's multicast reaches this test and its children alone; and messages to it,
by LCM's format of small datagrams (LC02) and the Python types that lcm-gen makes."""
import os
import pathlib
import socket
import struct
import subprocess
import sys

GROUP = ("239.255.76.67", 7667)
ALONE = "TENON_TEST_NETWORK"


def enter():
    """Goes on in a network namespace with nothing but a loopback that takes multicast."""
    if os.environ.get(ALONE) != "1":
        os.environ[ALONE] = "1"
        os.execvp("unshare", ["unshare", "--user", "--map-root-user", "--net", sys.executable, "-B", *sys.argv])
    for command in (["ip", "link", "set", "lo", "up", "multicast", "on"],
                    ["ip", "route", "add", "224.0.0.0/4", "dev", "lo"]):
        subprocess.run(command, check=True)


class Publisher:
    """@param folder for the generated types  @param types the folder lcmtypes/"""

    def __init__(self, folder, types):
        files = sorted(str(file) for file in pathlib.Path(types).glob("*.lcm"))
        subprocess.run(["lcm-gen", "--python", "--ppath", str(folder), *files], check=True)
        sys.path.insert(0, str(folder))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.sent = 0

    def publish(self, channel, message):
        self.publish_bytes(channel, message.encode())

    def publish_bytes(self, channel, data):
        self.socket.sendto(b"LC02" + struct.pack(">I", self.sent) + channel.encode() + b"\0" + data, GROUP)
        self.sent += 1

    def publish_fragment(self, channel, begins_at):
        """The first of a message of several datagrams (LC03), which says that it begins there."""
        head = struct.pack(">4sIIIHH", b"LC03", self.sent, 2000, begins_at, 0, 1)
        self.socket.sendto(head + channel.encode() + b"\0" + 1400 * b"x", GROUP)
        self.sent += 1
