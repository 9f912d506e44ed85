#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks tools/perception: the arithmetic of just-noticeable differences, shares of made forces, the choice of a scale,
the table of devices against the drivers, and the tables of the manual against the tool."""
import contextlib
import io
import json
import math
import os
import re
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOOL = os.path.join(ROOT, "tools", "perception")
sys.path.insert(0, TOOL)
import devices as profiles  # noqa: E402
import forces  # noqa: E402
import limen  # noqa: E402
import perceptible  # noqa: E402
import tables  # noqa: E402

TABLE = os.path.join(TOOL, "perception.json")


def text_of(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as f:
        return f.read()


def printed(*arguments):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        perceptible.main(list(arguments))
    return out.getvalue()


def made(left=(), right=(), coupling_N_m=500.0):
    return forces.Recording("made", {"left": list(left), "right": list(right)}, coupling_N_m)


def device(friction_N, max_force_N=3.3, resolution_m=55e-6):
    with open(TABLE, encoding="utf-8") as f:
        table = json.load(f)
    row = {"name": "made", "max_force_N": max_force_N, "friction_N": friction_N, "resolution_m": resolution_m}
    return profiles.Device(row, table)


class Limen(unittest.TestCase):
    def test_both_ends_and_where_the_parts_are_equal(self):
        self.assertEqual(limen.difference_limen(0, 0.07, 0.04), 0.04)
        self.assertAlmostEqual(limen.difference_limen(1e6, 0.07, 0.04) / 1e6, 0.07, delta=1e-12)
        self.assertAlmostEqual(limen.difference_limen(0.04 / 0.07, 0.07, 0.04), 0.04 * math.sqrt(2), delta=1e-15)

    def test_is_never_below_the_larger_part_and_at_most_root_two_above_it(self):
        for n in range(200):
            force = 10 ** (n / 40 - 3)
            ratio = limen.difference_limen(force, 0.1, 0.05) / max(0.1 * force, 0.05)
            self.assertTrue(1 <= ratio <= math.sqrt(2) * (1 + 1e-12), force)

    def test_independent_parts_add_their_squares(self):
        self.assertAlmostEqual(limen.smallest_change(0.03, 0.04), 0.05, delta=1e-15)

    def test_a_strong_touch_is_off_by_its_error_over_the_weber_fraction(self):
        self.assertAlmostEqual(limen.touch_error_jnd(1e6, 0.035, 0.07, 0.04, level=1), 0.5, delta=1e-9)
        self.assertAlmostEqual(limen.touch_error_jnd(1e6, 0.035, 0.07, 0.04), 1, delta=1e-9)

    def test_a_light_touch_is_off_by_its_error_over_the_absolute_threshold(self):
        self.assertAlmostEqual(limen.touch_error_jnd(1e-6, 0.1, 0.07, 0.04) / (1e-7 / 0.04), 1, delta=1e-9)
        self.assertEqual(limen.touch_error_jnd(0, 0.1, 0.07, 0.04), 0)

    def test_a_scale_makes_an_error_easier_to_notice_up_to_a_limit(self):
        jnd = [limen.touch_error_jnd(scale * 0.1, 0.05, 0.07, 0.04) for scale in (0.1, 1, 3, 10, 1e6)]
        self.assertEqual(jnd, sorted(jnd))
        self.assertLess(jnd[-1], 0.05 / 0.035)

    def test_the_allowed_error_is_one_jnd(self):
        for peak in tables.PEAKS_N:
            allowed = limen.allowed_error(peak, 0.07, 0.04)
            self.assertAlmostEqual(limen.touch_error_jnd(peak, allowed, 0.07, 0.04), 1, delta=1e-12)

    def test_the_largest_peak_below_one_jnd(self):
        peak = limen.largest_peak_below_one_jnd(0.05, 0.06, 0.04)  # a triangle of 3, 4, 5
        self.assertAlmostEqual(peak, 1, delta=1e-12)
        self.assertAlmostEqual(limen.touch_error_jnd(peak, 0.05, 0.06, 0.04), 1, delta=1e-12)
        self.assertEqual(limen.largest_peak_below_one_jnd(0.03, 0.06, 0.04), math.inf)
        self.assertEqual(limen.largest_peak_below_one_jnd(0.02, 0.06, 0.04), math.inf)


class Shares(unittest.TestCase):
    RAMP = [n / 1000 for n in range(1001)]  # an even rise to 1 N

    def test_of_an_even_rise(self):
        contact = made(right=self.RAMP).contact["right"]
        self.assertEqual(len(contact), 995)  # more than 5 mN
        self.assertAlmostEqual(forces.share_above(contact, 0.26), 0.74 / 0.995, delta=1.1e-3)
        self.assertAlmostEqual(forces.range_above(contact, 0.26), 0.74, delta=1e-12)
        self.assertAlmostEqual(forces.percentile(contact, 0.5), (0.006 + 1) / 2, delta=1e-12)
        self.assertEqual(forces.percentile(contact, 1), 1)
        self.assertEqual(forces.range_above(contact, 2), 0)

    def test_a_percentile_lies_between_its_neighbours(self):
        self.assertAlmostEqual(forces.percentile([1, 2, 4], 0.75), 3, delta=1e-12)
        self.assertEqual(forces.percentile([7], 0.5), 7)

    def test_a_scale_divides_the_threshold(self):
        self.assertEqual(tables.above([0.1, 0.2, 0.3, 0.4], 0.26, 1), "50, 35")
        self.assertEqual(tables.above([0.1, 0.2, 0.3, 0.4], 0.26, 2), "75, 68")

    def test_resolution_is_a_step_of_position_times_the_coupling(self):
        self.assertAlmostEqual(device(0.26).force_step_N(500), 0.0275, delta=1e-15)

    def test_compensation_leaves_a_fifth_of_the_friction_while_the_hand_moves(self):
        self.assertAlmostEqual(device(0.26).friction_left_N(True), 0.052, delta=1e-15)
        self.assertEqual(device(0.26).friction_left_N(False), 0.26)
        self.assertIsNone(device(None).friction_left_N(True))
        self.assertAlmostEqual(device(0.15).smallest_N(True), 0.05, delta=1e-15)
        self.assertEqual(device(None).smallest_N(True), 0.04)

    def test_equal_columns_become_one(self):
        table = tables.with_columns(["hand"], [["left"]], [("a", ["1"]), ("b", ["2"]), ("c", ["1"])])
        self.assertEqual(table.splitlines()[0], "| hand | a; c | b |")
        self.assertEqual(table.splitlines()[2], "| left | 1 | 2 |")


class Scale(unittest.TestCase):
    def test_brings_the_median_of_the_weaker_hand_to_the_threshold(self):
        recording = made(left=[0.2] * 3, right=[0.1, 0.1, 0.15], coupling_N_m=250)
        self.assertEqual(profiles.choose_scale(recording, device(0.26)), (3, ""))  # 2.6, in steps of a half

    def test_no_scale_is_below_one(self):
        self.assertEqual(profiles.choose_scale(made(right=[0.5]), device(0.26)), (1, ""))

    def test_is_limited_by_the_largest_force(self):
        recording = made(right=[0.05] * 9 + [1.0], coupling_N_m=250)
        self.assertEqual(profiles.choose_scale(recording, device(0.26)), (3, "largest force"))  # 3.3

    def test_is_limited_by_what_comes_to_rest_in_a_hand(self):
        recording = made(right=[0.02], coupling_N_m=500)
        self.assertEqual(profiles.choose_scale(recording, device(0.26)), (3, "stability"))  # 1735 / 500

    def test_is_limited_by_the_range_of_the_scene(self):
        recording = made(right=[0.01], coupling_N_m=100)
        self.assertEqual(profiles.choose_scale(recording, device(0.26)), (10, "range"))

    def test_a_moving_hand_needs_less(self):
        recording = made(right=[0.02], coupling_N_m=250)
        self.assertEqual(profiles.choose_scale(recording, device(0.26), moving=True), (3, ""))  # 0.052 / 0.02

    def test_without_a_known_friction_the_person_is_the_threshold(self):
        self.assertEqual(profiles.choose_scale(made(right=[0.02], coupling_N_m=250), device(None)), (2, ""))


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, name, text):
        path = os.path.join(self.folder.name, name)
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
        return path

    def report(self, left, right, scene=""):
        series = {"time_s": [0.1] * len(left), "hand_force_N": {"left": left, "right": right}}
        return self.write("report.json", json.dumps({"title": "2  Made", "scene": scene, "series": series}))

    def test_a_report(self):
        recording = forces.read(self.report([0, 0.3, 0.1], [0, 0, 0.005]))
        self.assertEqual(recording.title, "2 Made")
        self.assertEqual(recording.contact, {"left": [0.1, 0.3], "right": []})
        self.assertEqual(recording.coupling_N_m, 500)

    def test_a_report_without_contact_still_gives_the_tables_of_errors(self):
        out = printed(self.report([0, 0], [0, 0]))
        self.assertIn("2 Made: no contact", out)
        self.assertIn("Error that is one JND", out)

    def test_ticks_of_the_servo_without_the_recorded_scale(self):
        head = ",".join(f"{hand}_f{axis}_N" for hand in forces.HANDS for axis in "xyz")
        path = self.write("servo.csv", f"clock_us,{head}\n1,0.3,0,0.4,0,0,0\n2,,,,0,0,-0.2\n")
        self.assertEqual(forces.read(path, 2.0).contact, {"left": [0.25], "right": [0.1]})

    def test_the_coupling_of_what_hands_hold(self):
        self.write("part.xml", '<part><clip_applier hand="right" coupling="400 N/m"/></part>')
        tools = '<suction hand="left" coupling="250 N/m"/><retractor hand="none" coupling="2000 N/m"/>'
        includes = '<include file="part.xml"/><include file="$case.xml"/>'
        scene = self.write("scene.xml", f"<scene>{includes}{tools}</scene>")
        self.assertEqual(forces.stiffest_coupling(scene), 400)
        self.assertEqual(forces.read(self.report([0.1], [0.1], scene)).coupling_N_m, 400)

    def test_the_exercises_have_the_couplings_that_the_manual_states(self):
        stated = {"1_sylvian_fissure": 250, "2_aneurysm_dissection": 250, "3_clipping": 500, "4_rupture": 500}
        for name, coupling in stated.items():
            scene = os.path.join(ROOT, "scenes", "training", name + ".xml")
            self.assertEqual(forces.stiffest_coupling(scene), coupling, name)

    def test_a_measured_friction_replaces_the_unknown_one(self):
        inverse3 = {d.name: d for d in profiles.read_devices(TABLE, [("Inverse3", 0.1)])}["Inverse3"]
        self.assertEqual(inverse3.friction_N, 0.1)
        with self.assertRaises(SystemExit):
            profiles.read_devices(TABLE, [("Inverse4", 0.1)])

    def test_wrong_options_are_refused(self):
        for arguments in (["--friction", "Falcon"], ["--friction", "Falcon=-1"], ["--scale", "0"], ["--scale", "nan"]):
            with self.subTest(arguments), contextlib.redirect_stderr(io.StringIO()):
                with self.assertRaises(SystemExit):
                    perceptible.options(arguments)
        with self.assertRaises(SystemExit):
            perceptible.servo_errors(45)


class DeclaredElsewhere(unittest.TestCase):
    """What perception.json repeats of the drivers is what they say."""

    def setUp(self):
        self.devices = {d.name: d for d in profiles.read_devices(TABLE)}

    def test_friction_and_resolution_of_touch(self):
        known = text_of("haptic_server", "devices", "known_friction.h")
        driver = text_of("haptic_server", "devices", "openhaptics.cpp")
        for name, variable in (("Touch", "touch_friction"), ("Touch X", "touch_x_friction")):
            stated = re.search(variable + r'\{"[^"]*", ([\d.]+)\}', known)
            self.assertEqual(self.devices[name].friction_N, float(stated[1]), name)
        steps = [float(x) for x in re.findall(r"profile\.resolution_m = ([\de.-]+);", driver)]
        self.assertEqual([self.devices[n].resolution_m for n in ("Touch", "Touch X")], steps)
        self.assertIn(f"max_force_N = {self.devices['Touch'].max_force_N};", driver)

    def test_limits_of_force_dimension(self):
        driver = text_of("haptic_server", "devices", "forcedimension.cpp")
        limit = float(re.search(r"force_limit_N = ([\d.]+);", driver)[1])
        cases = {"omega": "omega7_right", "delta": "delta3", "sigma": "sigma6_right", "Falcon": "falcon"}
        for name, case in cases.items():
            stated = re.search(case + r": return \{([\d.]+), [\d.]+, ([\de.-]+),", driver)
            self.assertEqual(self.devices[name].max_force_N, min(float(stated[1]), limit), name)
            self.assertEqual(self.devices[name].resolution_m, float(stated[2]), name)

    def test_limits_of_haply(self):
        driver, inverse3 = text_of("haptic_server", "devices", "haply.cpp"), self.devices["Inverse3"]
        self.assertEqual(inverse3.max_force_N, float(re.search(r"max_force_N = ([\d.]+);", driver)[1]))
        self.assertEqual(inverse3.resolution_m, float(re.search(r"resolution_m = ([\de.-]+);", driver)[1]))

    def test_compensation_stability_and_scale(self):
        servo = self.devices["Touch"].servo
        share = re.search(r"friction_share =\s+([\d.]+);", text_of("haptic_server", "force_output.h"))
        self.assertEqual(servo["compensated_share"], float(share[1]))
        feel = text_of("docs", "feel-and-stability.md")
        held = re.search(r"\| held: [^|]*\| ([\d,]+) N/m", feel)
        self.assertEqual(servo["stiffest_held_N_m"], float(held[1].replace(",", "")))
        self.assertIn(f"scale <= {servo['largest_scale']}", text_of("haptic_server", "scene_setup.cpp"))

    def test_the_report_counts_contact_from_the_same_force(self):
        header = text_of("engine", "reports", "perceptible_forces.h")
        self.assertEqual(forces.TOUCH_N, float(re.search(r"touch_N = ([\d.]+);", header)[1]))


class Manual(unittest.TestCase):
    PAGE = ("docs", "what-a-hand-can-feel.md")

    def test_tables_without_forces_are_those_of_the_tool(self):
        page = text_of(*self.PAGE)
        devices = profiles.read_devices(TABLE)
        for table in (
            tables.allowed_table(devices),
            tables.aim_table(devices[0].person, perceptible.named_errors()),
        ):
            self.assertIn(table, page, "python3 tools/perception/perceptible.py prints:\n" + table)

    def test_the_aim_is_that_of_the_manual(self):
        aim = "median of %.0f %%, 90 %% of the probes within %.0f %%" % tuple(100 * x for x in perceptible.AIM)
        self.assertIn(aim, " ".join(text_of("docs", "haptic-truth.md").split()))

    def test_every_source_is_named_on_the_page(self):
        page = " ".join(text_of(*self.PAGE).split())
        for source in profiles.read_devices(TABLE)[0].person["sources"]:
            self.assertIn(source.split(":")[0], page)


if __name__ == "__main__":
    unittest.main()
