# SPDX-License-Identifier: GPL-3.0-or-later
"""Listens to Insula's bus (LCM over UDP multicast) for messages of a channel, to know that a session runs."""
import os
import select
import socket
import struct
import subprocess
import time

GROUP = "239.255.76.67"
HEAD = {b"LC02": 8, b"LC03": 20}  # a message, a part of one: where the channel's name begins


def join(port):
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    s.bind(("", port))
    s.setsockopt(
        socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + struct.pack("=I", socket.INADDR_ANY)
    )
    return s


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("", 0))
        return s.getsockname()[1]


def works():
    """Whether messages come back on this machine; as root, a missing route is added."""
    for attempt in range(2):
        try:
            with join(free_port()) as s:
                s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
                s.sendto(b"probe", (GROUP, s.getsockname()[1]))
                if select.select([s], [], [], 2)[0]:
                    return True
        except OSError:
            pass
        if attempt == 0 and os.geteuid() == 0:
            subprocess.run(
                "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo", shell=True, capture_output=True
            )
    return False


def heard(listener, channel, count, going, patience):
    """Waits until `count` messages of the channel came; false when `going` ends or patience does."""
    end = time.monotonic() + patience
    while time.monotonic() < end and going():
        if not select.select([listener], [], [], 0.2)[0]:
            continue
        data = listener.recv(65536)
        at = HEAD.get(data[:4])
        if at and data[at : at + len(channel) + 1] == channel.encode() + b"\0":
            count -= 1
            if count <= 0:
                return True
    return False
