# SPDX-License-Identifier: GPL-3.0-or-later
"""Devices of perception.json: their thresholds, and the force_scale that suits an exercise."""
import json
import math

import forces
import limen


class Device:
    def __init__(self, row, table):
        self.name, self.max_force_N = row["name"], row["max_force_N"]
        self.friction_N, self.resolution_m = row["friction_N"], row["resolution_m"]
        self.person, self.servo = table["person"], table["servo"]

    def friction_left_N(self, moving):
        """Friction that the hand has to overcome, or None where it is not known."""
        if self.friction_N is None:
            return None
        return self.friction_N * (1 - self.servo["compensated_share"] if moving else 1.0)

    def smallest_N(self, moving=True):
        """F0 of the difference limen."""
        return limen.smallest_change(self.person["absolute_threshold_N"], self.friction_left_N(moving) or 0.0)

    def threshold_N(self, moving=False):
        """What a force must exceed to be noticed."""
        return max(self.person["absolute_threshold_N"], self.friction_left_N(moving) or 0.0)

    def force_step_N(self, coupling_N_m):
        """Step of the rendered force for one step of the reported position, against a rigid wall."""
        return self.resolution_m * coupling_N_m


def read_devices(path, measured=()):
    """`measured`: (name, friction in N) of devices whose friction was measured."""
    with open(path, encoding="utf-8") as f:
        table = json.load(f)
    devices = [Device(row, table) for row in table["devices"]]
    names = {d.name: d for d in devices}
    for name, friction_N in measured:
        if name not in names:
            raise SystemExit(f'no device is called "{name}"; they are {", ".join(names)}')
        names[name].friction_N = friction_N
    return devices


def wanted_scale(recording, device, moving=False):
    """The force_scale for half of the contact time of each hand above the threshold."""
    return max(device.threshold_N(moving) / forces.percentile(c, 0.5) for c in recording.contact.values() if c)


def scale_limits(recording, device):
    return {
        "largest force": device.max_force_N / max(c[-1] for c in recording.contact.values() if c),
        "stability": device.servo["stiffest_held_N_m"] / recording.coupling_N_m,
        "range": device.servo["largest_scale"],
    }


def choose_scale(recording, device, moving=False):
    """(force_scale in steps of a half, name of the limit that keeps it below what is wanted, or an empty text)."""
    limits = scale_limits(recording, device)
    name = min(limits, key=limits.get)
    chosen = max(1.0, math.ceil(2 * wanted_scale(recording, device, moving) - 1e-9) / 2)
    if chosen <= limits[name]:
        return chosen, ""
    return max(1.0, math.floor(2 * limits[name] + 1e-9) / 2), name
