#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists each second what goes over the bus: channels, messages a second, kilobytes a second. With --show CHANNEL,
prints that channel's messages field by field.

    ./insula python-types build/python
    python3 -m venv venv && venv/bin/pip install lcm
    venv/bin/python examples/python/spy.py --types build/python

The type of a channel is its name in small letters with _t: HAPTIC_STATUS carries haptic_status_t.
"""
import argparse
import os
import pathlib
import sys
import time

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"


def short(value):
    """A field as text; of long arrays the beginning."""
    if isinstance(value, float):
        return "%.6g" % value
    if isinstance(value, (list, tuple)):
        some = ", ".join(short(v) for v in value[:12])
        return "[%s%s]" % (some, ", ... %d in all" % len(value) if len(value) > 12 else "")
    if isinstance(value, str) and len(value) > 200:
        return repr(value[:200]) + "..."
    if hasattr(value, "__slots__"):
        return "{%s}" % ", ".join("%s %s" % (name, short(getattr(value, name))) for name in value.__slots__)
    return repr(value)


class Spy:
    def __init__(self, url, types, show):
        import lcm  # from PyPI; any version from 1.4 on

        sys.path.insert(0, str(types))
        import insula_lcm  # made by ./insula python-types

        self.types, self.show = insula_lcm, show
        self.counts, self.damaged = {}, {}
        self.bus = lcm.LCM(url)
        self.bus.subscribe(".*", self.on_message)

    def on_message(self, channel, data):
        messages, size = self.counts.get(channel, (0, 0))
        self.counts[channel] = (messages + 1, size + len(data))
        kind = getattr(self.types, channel.lower() + "_t", None)
        if kind is None or (channel != self.show and messages % 20):  # decoding all would keep Python from hearing all
            return
        try:
            message = kind.decode(data)
        except Exception as e:  # the bytes may be anything at all
            self.damaged[channel] = str(e)
            return
        if channel == self.show:
            print(channel)
            for name in message.__slots__:
                print("  %-26s %s" % (name, short(getattr(message, name))))

    def second(self):
        end = time.monotonic() + 1
        while time.monotonic() < end:
            self.bus.handle_timeout(20)
        if not self.show:
            print("%-18s %10s %10s" % ("channel", "messages/s", "kB/s"))
            for channel, (messages, size) in sorted(self.counts.items()):
                known = "" if hasattr(self.types, channel.lower() + "_t") else "  no type of Insula's"
                print("%-18s %10d %10.1f%s" % (channel, messages, size / 1e3, known or self.damaged.get(channel, "")))
            print(flush=True)
        self.counts = {channel: (0, 0) for channel in self.counts}


def main():
    parser = argparse.ArgumentParser(description="Lists what goes over Insula's bus.")
    parser.add_argument("--types", type=pathlib.Path, required=True, help="folder that ./insula python-types wrote")
    parser.add_argument("--show", metavar="CHANNEL", help="print this channel's messages field by field")
    parser.add_argument("--seconds", type=float, default=0, help="end after so long; 0: never")
    a = parser.parse_args()
    spy = Spy(os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL, a.types, a.show)
    end = time.monotonic() + a.seconds
    try:
        while a.seconds == 0 or time.monotonic() < end:
            spy.second()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
