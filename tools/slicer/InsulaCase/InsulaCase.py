# SPDX-License-Identifier: GPL-3.0-or-later
"""A scripted module of 3D Slicer that makes a training case of Insula from a segment.

Add the folder of this file to Slicer's additional module paths. For training only, never for the care of patients.
"""
import pathlib
import shutil
import tempfile

import qt
import slicer
from slicer.ScriptedLoadableModule import (
    ScriptedLoadableModule,
    ScriptedLoadableModuleLogic,
    ScriptedLoadableModuleWidget,
)

import insula_case

SITES = (
    "ophthalmic",
    "posterior communicating",
    "anterior choroidal",
    "carotid bifurcation",
    "middle cerebral",
    "anterior communicating",
    "pericallosal",
    "basilar tip",
    "superior cerebellar",
    "posterior inferior cerebellar",
    "other",
)


class InsulaCase(ScriptedLoadableModule):
    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        parent.title = "Insula case"
        parent.categories = ["Simulation"]
        parent.contributors = ["The Insula developers"]
        parent.helpText = (
            "Makes a training case for the simulator Insula from a segmented vessel with an aneurysm. "
            "For training only, never for the care of patients. Names and dates of the patient are not passed on."
        )


class InsulaCaseLogic(ScriptedLoadableModuleLogic):
    def export_segment(self, segmentation, segment_id, file):
        """Writes one segment as a NIfTI volume of labels: voxels of the segment are 1. No other data go with it."""
        labels = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode")
        try:
            slicer.modules.segmentations.logic().ExportSegmentsToLabelmapNode(segmentation, [segment_id], labels)
            if not slicer.util.saveNode(labels, str(file)):
                raise insula_case.CaseError(f"{file} cannot be written")
        finally:
            slicer.mrmlScene.RemoveNode(labels)

    def make_case(self, program, segmentation, segment_id, name, out, told=None, **choices):
        """Exports the segment and builds the case. told: gets the progress. Returns its folder and its report."""
        with tempfile.TemporaryDirectory() as folder:
            labels = pathlib.Path(folder) / "vessel.nii.gz"
            self.export_segment(segmentation, segment_id, labels)
            run = insula_case.CaseRun(insula_case.command(program, name, labels, out, **choices))
            for _ in run.lines():
                if told:
                    told(*run.progress)
        return run.folder, insula_case.read_report(run.folder)


class InsulaCaseWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        form = qt.QFormLayout()
        self.layout.addLayout(form)
        self.segment = slicer.qMRMLSegmentSelectorWidget()
        self.segment.setMRMLScene(slicer.mrmlScene)
        self.program = qt.QLineEdit(shutil.which("insula") or "")
        self.name = qt.QLineEdit("my_case")
        self.out = qt.QLineEdit(str(pathlib.Path.home() / "insula_cases"))
        self.site = qt.QComboBox()
        self.site.addItems(["", *SITES])
        self.left = qt.QCheckBox("the vessel is of the left side")
        for text, widget in (
            ("Vessel", self.segment),
            ("Program", self.program),
            ("Name", self.name),
            ("Folder", self.out),
            ("Site", self.site),
            ("Side", self.left),
        ):
            form.addRow(text, widget)
        self.button = qt.QPushButton("Make the case")
        self.button.clicked.connect(self.make)
        self.layout.addWidget(self.button)
        self.said = qt.QPlainTextEdit()
        self.said.setReadOnly(True)
        self.layout.addWidget(self.said)
        self.layout.addStretch(1)

    def make(self):
        def told(stage, percent, text):
            slicer.util.showStatusMessage(f"{stage} {percent} %: {text}")
            slicer.app.processEvents()

        self.button.enabled = False
        try:
            folder, report = InsulaCaseLogic().make_case(
                self.program.text,
                self.segment.currentNode(),
                self.segment.currentSegmentID(),
                insula_case.case_name(self.name.text),
                self.out.text,
                told,
                site=self.site.currentText,
                left=self.left.checked,
            )
            self.said.setPlainText("\n".join([f"{folder}", *insula_case.summary(report)]))
        except insula_case.CaseError as error:
            slicer.util.errorDisplay(str(error))
        finally:
            self.button.enabled = True
