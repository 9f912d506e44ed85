# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables in Markdown: forces against the thresholds of devices, and errors in just-noticeable differences."""
import math

import devices as profiles
import forces
import limen

PEAKS_N = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.3)
FRICTIONS_N = (0.02, 0.05, 0.1, 0.2, 0.3)


def row(cells):
    return "| " + " | ".join(cells) + " |"


def markdown(head, rows):
    return "\n".join([row(head), "|" + "---|" * len(head)] + [row(r) for r in rows])


def percent(share):
    return f"{100 * share:.0f}"


def with_columns(first_head, first_cells, columns):
    """A table whose `columns` are (name, cells). Columns with equal cells become one."""
    merged = {}
    for name, cells in columns:
        merged.setdefault(tuple(cells), []).append(name)
    heads = ["; ".join(names) for names in merged.values()]
    rows = [list(first) + [cells[i] for cells in merged] for i, first in enumerate(first_cells)]
    return markdown(list(first_head) + heads, rows)


def hands_of(recordings):
    """(recording, hand, its forces in contact) of each hand that touches."""
    return [(r, hand, r.contact[hand]) for r in recordings for hand in forces.HANDS if r.contact[hand]]


def of_hands(recordings, columns):
    """A table with a row for each hand that touches. `columns`: (name, function of recording and forces)."""
    hands = hands_of(recordings)
    cells = [(name, [of(recording, contact) for recording, _, contact in hands]) for name, of in columns]
    return with_columns(["exercise", "hand"], [[r.title, hand] for r, hand, _ in hands], cells)


def force_table(recordings):
    rows = []
    for recording, hand, contact in hands_of(recordings):
        levels = [forces.percentile(contact, p) for p in (0.05, 0.5, 0.95)] + [contact[-1]]
        shares = [percent(forces.share_above(contact, f)) for f in FRICTIONS_N]
        rows.append([recording.title, hand] + [f"{1000 * f:.0f}" for f in levels] + shares)
    head = ["exercise", "hand", "5 %, mN", "50 %, mN", "95 %, mN", "peak, mN"]
    return markdown(head + [f"above {f} N, %" for f in FRICTIONS_N], rows)


def above(contact, threshold_N, scale):
    """Shares of the contact time and of the range of force above a threshold of the displayed force, in %."""
    limit = threshold_N / scale
    return f"{percent(forces.share_above(contact, limit))}, {percent(forces.range_above(contact, limit))}"


def friction_table(recordings, devices, scale):
    person_N = devices[0].person["absolute_threshold_N"]
    columns = [("person", lambda _, contact: above(contact, person_N, scale))]
    for device in devices:
        for state, moving in (("at rest", False), ("moving", True)):
            left = device.friction_left_N(moving)
            if left is not None:
                columns.append((f"{device.name}, {state}", lambda _, contact, left=left: above(contact, left, scale)))
    return of_hands(recordings, columns)


def resolution_table(recordings, devices, scale):
    """The scale multiplies the steps too, so it leaves these shares as they are."""

    def cell(device):
        return lambda recording, contact: above(contact, scale * device.force_step_N(recording.coupling_N_m), scale)

    return of_hands(recordings, [(d.name, cell(d)) for d in devices])


def maximum_table(recordings, devices, scale):
    def cell(device):
        return lambda _, contact: percent(1 - forces.share_above(contact, device.max_force_N / scale))

    return of_hands(recordings, [(d.name, cell(d)) for d in devices])


def scale_cell(recording, device, moving):
    scale, limit = profiles.choose_scale(recording, device, moving)
    limit_N = device.threshold_N(moving) / scale
    shares = [percent(forces.share_above(c, limit_N)) for c in recording.contact.values() if c]
    return f"{scale:g}: {' and '.join(shares)} %" + (f" ({limit})" if limit else "")


def scale_table(recordings, devices):
    touching = [r for r in recordings if any(r.contact.values())]
    columns = []
    for device in devices:
        states = [(device.name, False)]
        if device.friction_N is not None:
            states = [(f"{device.name}, at rest", False), (f"{device.name}, moving", True)]
        columns += [(name, [scale_cell(r, device, moving) for r in touching]) for name, moving in states]
    return with_columns(["exercise"], [[r.title] for r in touching], columns)


def jnd_table(recordings, devices, errors, fixed_scale, share):
    """Errors (median and 90th percentile) of touches that peak at a percentile of the exercise's forces."""

    def cell(device):
        def of(recording, contact):
            scale = fixed_scale or profiles.choose_scale(recording, device)[0]
            peak = min(scale * forces.percentile(contact, share), device.max_force_N)
            k, smallest = device.person["weber_fraction"], device.smallest_N()
            return ", ".join(f"{limen.touch_error_jnd(peak, e, k, smallest):.2f}" for e in errors)

        return of

    return of_hands(recordings, [(d.name, cell(d)) for d in devices])


def allowed_table(devices):
    """The error that is one JND, in % of the displayed peak, for each Weber fraction and each friction."""
    person = devices[0].person
    cases = [("no friction", person["absolute_threshold_N"])]
    for d in devices:
        if d.friction_N is not None:
            cases += [(f"{d.name}, moving", d.smallest_N(True)), (f"{d.name}, at rest", d.smallest_N(False))]
    rows = []
    for name, smallest in cases:
        for k in (person["weber_fraction"], person["weber_fraction_coarse"]):
            allowed = (100 * limen.allowed_error(peak, k, smallest) for peak in PEAKS_N)
            rows.append([name, percent(k), f"{1000 * smallest:.0f}"] + [f"{a:.1f}" for a in allowed])
    return markdown(["device", "k, %", "F0, mN"] + [f"{p:g} N" for p in PEAKS_N], rows)


def aim_table(person, named_errors):
    """The displayed peak up to which an error stays below one JND, on a device without friction."""
    fractions = (person["weber_fraction"], person["weber_fraction_coarse"])
    rows = []
    for name, error in named_errors:
        peaks = [limen.largest_peak_below_one_jnd(error, k, person["absolute_threshold_N"]) for k in fractions]
        cells = ["any" if math.isinf(p) else f"{p:.2f} N" for p in peaks]
        rows.append([name, f"{100 * error:.1f}"] + cells)
    return markdown(["error", "% of the peak"] + [f"up to, k = {percent(k)} %" for k in fractions], rows)
