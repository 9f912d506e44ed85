#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Works a running scene from Python: exchanges each hand's tool, loads a clip, and reads the forces of both hands.

    ./insula play scenes/training/1_sylvian_fissure.xml        # in one terminal
    ./insula python-types build/python                         # in another
    python3 -m venv venv && venv/bin/pip install lcm
    venv/bin/python examples/python/exchange_and_forces.py --types build/python --seconds 5

Talks over the bus of LCM_DEFAULT_URL, as all of Insula's processes do (docs/scripting.md).
"""
import argparse
import json
import os
import pathlib
import sys
import time

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"
SIDES = ("left", "right")


class Session:
    """What the bus says of the scene, and a way to ask it for something."""

    def __init__(self, url, types):
        import lcm  # from PyPI; any version from 1.4 on

        sys.path.insert(0, str(types))
        import insula_lcm  # made by ./insula python-types

        self.types = insula_lcm
        self.bus = lcm.LCM(url)
        self.scene = None
        self.answers = []
        self.forces = ([], [])
        self.bus.subscribe("SCENE_INFO", self.on_scene)
        self.bus.subscribe("SIM_EVENT", self.on_event)
        self.bus.subscribe("DEVICE_STATE", self.on_devices)

    def on_scene(self, _channel, data):
        info = self.types.scene_info_t.decode(data)
        if info.state in ("running", "paused"):
            self.scene = info

    def on_event(self, _channel, data):
        event = self.types.sim_event_t.decode(data)
        if event.kind in ("command", "refused"):
            self.answers.append(event)

    def on_devices(self, _channel, data):
        for hand in self.types.device_state_t.decode(data).hand:
            if hand.connected:
                self.forces[hand.hand].append(sum(f * f for f in hand.force_N) ** 0.5)

    def listen(self, seconds, until=lambda: False):
        """Handles messages for so long, or until something is so; returns whether it became so."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not until():
            self.bus.handle_timeout(20)
        return until()

    def ask(self, command, argument):
        """Asks for it and waits for the answer: (done, text)."""
        self.answers.clear()
        message = self.types.user_command_t()
        message.time_us = time.monotonic_ns() // 1000
        message.sender = "python-%d" % os.getpid()
        message.command, message.argument = command, argument
        self.bus.publish("USER_COMMAND", message.encode())
        # An answer names the command; its text is the argument, or why it was refused.
        mine = lambda: [e for e in self.answers if e.id == command and (e.kind == "refused" or e.text == argument)]
        if not self.listen(10, lambda: bool(mine())):
            return False, "no answer"
        answer = mine()[0]
        return answer.kind == "command", answer.text


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument(
        "--types", type=pathlib.Path, default=pathlib.Path("build/python"), help="folder of the generated types"
    )
    options.add_argument("--seconds", type=float, default=5, help="how long forces are read")
    options.add_argument("--wait", type=float, default=30, help="how long to wait for a scene")
    given = options.parse_args()
    session = Session(os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL, given.types)

    if not session.listen(given.wait, lambda: session.scene is not None):
        print("error: no scene runs on this bus", file=sys.stderr)
        return 1
    print("scene: %s" % session.scene.title)
    bundle = json.loads((pathlib.Path(session.scene.bundle) / "scene.json").read_text(encoding="utf-8"))
    tools = bundle["tools"]

    # Each hand takes up every tool it has, one after the other, and ends with its first.
    for hand in bundle["hands"]:
        ids = [tools[i]["id"] for i in hand["tools"]]
        for wanted in ids[1:] + ids[:1]:
            done, text = session.ask("exchange", "%s %s" % (hand["hand"], wanted))
            print("%s hand: %s %s" % (hand["hand"], wanted, "taken up" if done else "refused: " + text))

    # Whoever has the command "load" is taken up and gets a clip; the first on the tray is as good as any.
    clips = [t for t in tools if t["kind"] == "clip" and t["hand"] == "none"]
    appliers = [c["id"] for c in bundle["commands"] if any(x["name"] == "load" for x in c["commands"])]
    if clips and appliers:
        applier = next(t for t in tools if t["id"] == appliers[0])
        session.ask("exchange", "%s %s" % (applier["hand"], applier["id"]))
        done, text = session.ask("ask", "%s load %s" % (appliers[0], clips[0]["id"]))
        print("%s: %s %s" % (appliers[0], clips[0]["id"], "loaded" if done else "refused: " + text))
    else:
        print("no clip to load in this scene")

    for forces in session.forces:
        forces.clear()
    session.listen(given.seconds)
    for side, forces in zip(SIDES, session.forces):
        if forces:
            print(
                "%s hand: %d forces, mean %.3f N, largest %.3f N"
                % (side, len(forces), sum(forces) / len(forces), max(forces))
            )
        else:
            print("%s hand: no device" % side)
    return 0


if __name__ == "__main__":
    sys.exit(main())
