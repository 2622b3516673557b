"""Exchanges frames with a hub over slcan as any user of python-can would, and logs them.

    exchange.py PORT COUNT LOG

Sends COUNT frames of all kinds and lengths. The other end answers each with the same frame, its
identifier one higher. At most WINDOW answers are outstanding, as with any flow control; nothing is
sent twice. Writes sent and received frames with python-can's own logger. Exit status 0 where every
answer came, in order and unaltered.
"""

import random
import sys

import can

WINDOW = 32


def frames(count):
    draw = random.Random(1)
    for i in range(count):
        extended = draw.random() < 0.3
        remote = draw.random() < 0.05
        length = draw.randrange(9)
        yield can.Message(
            arbitration_id=draw.randrange(0x1FFFFFFF if extended else 0x7FF) & ~1,
            is_extended_id=extended,
            is_remote_frame=remote,
            dlc=length,
            data=None if remote else bytes(draw.randrange(256) for _ in range(length)),
            timestamp=i * 1e-6,
        )


def answers(sent, got):
    return (
        got.arbitration_id == sent.arbitration_id + 1
        and got.is_extended_id == sent.is_extended_id
        and got.is_remote_frame == sent.is_remote_frame
        and got.dlc == sent.dlc
        and got.data == sent.data
    )


def main():
    port, count, log = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    bus = can.Bus(
        interface="slcan",
        channel=f"socket://127.0.0.1:{port}",
        bitrate=1000000,
        sleep_after_open=0,
    )
    logger = can.Logger(log)
    waiting = []
    good = 0

    def receive():
        got = bus.recv(10)
        if got is None:
            sys.exit(f"answer {good} of {count} did not come")
        logger(got)
        sent = waiting.pop(0)
        if not answers(sent, got):
            sys.exit(f"answer {good} is not that of {sent}: {got}")
        return good + 1

    for message in frames(count):
        bus.send(message)
        logger(message)
        waiting.append(message)
        if len(waiting) >= WINDOW:
            good = receive()
    while waiting:
        good = receive()
    print("version", bus.get_version(5), "serial", bus.get_serial_number(5))
    print(good, "answers")
    logger.stop()
    bus.shutdown()


if __name__ == "__main__":
    main()
