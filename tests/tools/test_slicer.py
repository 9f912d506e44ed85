#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The module for 3D Slicer without Slicer: stand-ins export a segment, and the real case builder makes the case.

    test_slicer.py INSULA_PROGRAM
"""
import gzip
import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else ROOT / "build/release/bin/insula"
sys.path.insert(0, str(ROOT / "tools/slicer/InsulaCase"))


def tube_with_sac():
    """A NIfTI volume of labels: a tube along x that leaves the volume, with a ball on it."""
    size, spacing = (54, 24, 32), 0.3
    header = bytearray(352)

    def put(at, form, *values):
        struct.pack_into("<" + form, header, at, *values)

    put(0, "i", 348)
    put(40, "8h", 3, *size, 1, 1, 1, 1)
    put(70, "2h", 2, 8)
    put(76, "8f", 1, spacing, spacing, spacing, 1, 1, 1, 1)
    put(108, "2f", 352, 1)
    header[123] = 2
    put(254, "h", 1)
    for row in range(3):
        put(280 + 20 * row, "f", spacing)
    header[344:348] = b"n+1\0"
    voxels = bytearray()
    for k in range(size[2]):
        for j in range(size[1]):
            for i in range(size[0]):
                x, y, z = spacing * i - 8, spacing * j - 3.6, spacing * k - 2.4
                voxels.append(math.hypot(y, z) < 1.4 or math.dist((x, y, z), (0, 0, 3.4)) < 2.4)
    return bytes(header + voxels)


class Scene:
    """What the module asks of Slicer: nodes of labels, the export of a segment into one, and saving it."""

    def __init__(self):
        self.nodes, self.asked = [], None

    def AddNewNodeByClass(self, name):
        assert name == "vtkMRMLLabelMapVolumeNode"
        self.nodes.append(name)
        return name

    def RemoveNode(self, node):
        self.nodes.remove(node)

    def ExportSegmentsToLabelmapNode(self, segmentation, segments, labels):
        self.asked = (segmentation, segments, labels)

    def save(self, node, file):
        pathlib.Path(file).write_bytes(gzip.compress(tube_with_sac()))
        return True


SCENE = Scene()
slicer = types.ModuleType("slicer")
slicer.mrmlScene = SCENE
slicer.modules = types.SimpleNamespace(segmentations=types.SimpleNamespace(logic=lambda: SCENE))
slicer.util = types.SimpleNamespace(saveNode=SCENE.save)
scripted = types.ModuleType("slicer.ScriptedLoadableModule")
for part in ("ScriptedLoadableModule", "ScriptedLoadableModuleLogic", "ScriptedLoadableModuleWidget"):
    setattr(scripted, part, type(part, (), {}))
sys.modules.update({"slicer": slicer, "slicer.ScriptedLoadableModule": scripted, "qt": types.ModuleType("qt")})

import insula_case  # noqa: E402
import InsulaCase  # noqa: E402


class Words(unittest.TestCase):
    def test_the_command_line_has_the_choices(self):
        words = insula_case.command("insula", "a", "v.nii.gz", "/out", site="other", difficulty=2, left=True)
        self.assertEqual(words[:4], ["insula", "case", "new", "a"])
        self.assertIn("--mirror", words)
        self.assertEqual(words[words.index("--site") + 1], "other")
        with self.assertRaises(insula_case.CaseError):
            insula_case.command("insula", "../a", "v.nii.gz", "/out")

    def test_any_text_becomes_a_name(self):
        self.assertEqual(insula_case.case_name("Müller, left (2)"), "M_ller_left_2")
        self.assertEqual(insula_case.case_name("//"), "case")

    def test_lines_of_progress_are_told_from_others(self):
        told = insula_case.progress_of("place    40 %  looking for the place")
        self.assertEqual(told, ("place", 40, "looking for the place"))
        self.assertIsNone(insula_case.progress_of("error: has 1 opening"))

    def test_the_sites_are_those_of_the_program(self):
        said = subprocess.run([PROGRAM, "describe", "exercise"], capture_output=True, text=True, check=True).stdout
        line = next(line for line in said.splitlines() if line.split()[:1] == ["site"])
        self.assertEqual(", ".join(InsulaCase.SITES), re.search(r"\[(.*)\]", line)[1])


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_a_segment_becomes_a_case_with_a_report(self):
        told = []
        folder, report = InsulaCase.InsulaCaseLogic().make_case(
            PROGRAM, "segmentation", "Segment_1", "tube", self.folder.name,
            lambda *progress: told.append(progress), site="basilar tip", rehearse=False,
        )
        self.assertEqual(SCENE.asked[1], ["Segment_1"])
        self.assertEqual(SCENE.nodes, [], "the node of the export is gone")
        self.assertTrue((folder / "3_clipping.xml").is_file())
        self.assertIn('site="basilar tip"', (folder / "3_clipping.xml").read_text())
        self.assertAlmostEqual(report["neck"]["diameter_mm"], 3.6, delta=0.8)
        self.assertEqual({stage for stage, _, _ in told} >= {"intake", "wall", "place", "scenes", "report"}, True)
        self.assertIn("Neck", insula_case.summary(report)[0])

    def test_what_the_program_refuses_is_raised_in_its_words(self):
        labels = pathlib.Path(self.folder.name) / "v.nii.gz"
        labels.write_bytes(gzip.compress(tube_with_sac()[:9000]))
        run = insula_case.CaseRun(insula_case.command(PROGRAM, "cut", labels, self.folder.name))
        with self.assertRaisesRegex(insula_case.CaseError, "ends early"):
            list(run.lines())
        with self.assertRaisesRegex(insula_case.CaseError, "cannot be run"):
            insula_case.CaseRun(insula_case.command("/nowhere/insula", "a", labels, self.folder.name))


if __name__ == "__main__":
    unittest.main()
