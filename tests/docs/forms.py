# SPDX-License-Identifier: GPL-3.0-or-later
"""How the test runs a command of the manual that it does not run as it stands. First entry that fits a command counts;
every entry must fit some command, and every test that is named must exist (forms_test.py).

A command that no entry fits runs as it stands.
"""
import dataclasses
import re

# What runs on the first page that says it, since nothing later on a page goes on with what it leaves.
ONCE = (
    r"\./insula (play|run|view|bench|check|describe|list|docs|schema|devices|help|python-types)\b.*"
    r"|build/release/bin/haptic_server .*"
)

# What the pages' commands need, made by project.py in the folder they run in.
FIXTURES = {
    "README.md": ("vessel.stl",),
    "docs/arteries.md": ("patient.stl",),
    "docs/devices.md": ("arms",),
    "docs/making-a-case.md": ("vessel.stl", "vessel_cm.stl", "labels.nii.gz"),
    "docs/studio.md": ("vessel.stl",),
    "docs/writing-a-plugin.md": ("tether.so",),
}


@dataclasses.dataclass
class Shorter:
    """Runs for real, with a bound or a stand-in: `pattern` is replaced by `by`. `prints`: what must be found in what it
    says."""

    pattern: str
    by: str
    why: str
    prints: str = ""

    def command(self, text):
        return re.sub(self.pattern, self.by, text)


@dataclasses.dataclass
class UntilCtrlC:
    """Runs for real until it has sent some messages of a channel, then gets a Ctrl-C. What it needs beside what is
    written is `more`."""

    pattern: str
    channel: str
    more: str = ""
    prints: str = ""

    def command(self, text):  # the test's own bus and port: others may run beside it
        return re.sub(r'^LCM_DEFAULT_URL="[^"]*" | --port \d+', "", text) + self.more


@dataclasses.dataclass
class Elsewhere:
    """Done by a test of its own, of ctest's name `test`."""

    pattern: str
    test: str
    why: str


@dataclasses.dataclass
class Never:
    """What no test may do."""

    pattern: str
    why: str


PLAY = " --no-browser --port 0"  # no person at the screen; ports are others' too

# Where install_plugins left what two of the pages build and install.
INSTALLED = (
    ("/opt/insula", "{build}/tests/installed/prefix"),
    ("pia_membrane/build", "{build}/tests/installed/plugins/build/pia_membrane"),
    ("pia_membrane/example.xml", "{build}/tests/installed/plugins/pia_membrane/example.xml"),
)

FORMS = (
    # What only an administrator or a person may do.
    Never(
        r"sudo (ip|setcap|apt-get) .*",
        "changes the machine's network, the rights of a file, or its packages; needs root",
    ),
    Never(
        r"tools/mesh_lobes/rebuild\.sh",
        "needs the head of Debian's mricron-data and minutes; "
        "the test meshes_shipped holds what it made to its checksums",
    ),
    Never(
        r"build/mesh_lobes/insula_mesh_volume .*",
        "its program takes minutes to compile and is built with INSULA_BUILD_TOOLS alone, which brings its tests",
    ),
    Never(r"\./insula test", "runs all tests, this one among them"),
    # What other tests do, step by step as on the page.
    Elsewhere(r"\./insula docs --html manual", "docs_html", "builds the site and asks its search"),
    Elsewhere(
        r"\./insula wheel.*|python3 -m venv venv && venv/bin/pip install dist/.*|venv/bin/insula play",
        "install_wheel",
        "builds a wheel, installs it into a clean environment and runs its programs",
    ),
    Elsewhere(
        r"python3 -m venv .*|venv/bin/python examples/python/.*",
        "python_example",
        "makes that environment and runs the examples against an engine and a server",
    ),
    Elsewhere(
        r"\./insula export .*\.usdc .*",
        "python_test_interchange",
        "writes and reads USD where the package usd-core is installed",
    ),
    Elsewhere(r"\./insula spy", "spy_window", "opens it on a screen of its own, where Java is"),
    Elsewhere(
        r"lcm-logger .*|build/release/bin/gateway|\./insula replay .*",
        "Replay.BothPlayersBringTheSessionToAPage",
        "records a session and plays it back to a page",
    ),
    Elsewhere(
        r"\./insula devices --calibrate .*",
        "DeviceTool.CalibratesByFourPlaces",
        "a stand-in's arm is moved to the four places",
    ),
    Elsewhere(
        r"build/release/bin/insula_artery make tools/artery/arteries.json meshes/arteries",
        "ArteryTool.ShippedArteriesAreMadeAgainBitForBit",
        "makes all of the table",
    ),
    Elsewhere(r"\./insula studio", "StudioTest.ACaseIsBuilt", "the browser test `studio` uses the page"),
    Elsewhere(
        r"\./insula cases add scenes/cases/my_case",
        "CasesCommand.TheFolderOfABuiltCaseIsAdded",
        "needs a built case",
    ),
    Elsewhere(r"\./insula case new from_scan .*", "Volumes.ADicomSeriesIsReadByItsThreshold", "makes a series to read"),
    Elsewhere(
        r"\./insula case new from_the_left .*",
        "MirroredCase.IsTheCaseOfItsTwinAndPassesItsCheck",
        "makes the case of a left side and that of its right-sided twin",
    ),
    Elsewhere(
        r"\./insula case new .* --brain aal\.nii\.gz .*",
        "OwnBrain.LabelsOfAVolumeBecomeACaseWhoseExercisesRun",
        "makes a volume of labels",
    ),
    Elsewhere(
        r"\./insula case new .* --brain frontal=f\.stl .*",
        "OwnBrain.BlocksAreMeshedWithinTheirNodes",
        "makes a surface for each lobe",
    ),
    Elsewhere(
        r"\./insula case brain .* --brain brain\.ply .*",
        "OwnBrain.OneSurfaceIsSharedOutToTheNearestShippedLobe",
        "makes that surface",
    ),
    Elsewhere(r"cd build/release && cpack -G DEB", "install_packages", "makes the packages and looks into them"),
    Elsewhere(
        r"\./insula apt-repository .*",
        "install_apt_repository",
        "makes a repository of small packages, and apt reads it",
    ),
    Elsewhere(r"cmake --install build/release .*", "install_plugins", "installs into a folder of its own"),
    Elsewhere(
        r"(cmake -S|cmake --build|ctest --test-dir|sudo cmake --install) pia_membrane.*",
        "install_plugins",
        "builds, tests and installs the tutorial's plugin",
    ),
    Elsewhere(r"(cmake -S|cmake --build|ctest --test-dir) suture.*", "install_plugins", "builds and tests the suture"),
    Elsewhere(r"insula --plugin-path suture/build .*", "install_plugins", "describes it, runs it and reads its report"),
    # What install_plugins has left is what these pages have made by then.
    Shorter(
        r"^insula --plugin-path pia_membrane/build describe pia_membrane$",
        r"\g<0>",
        "the library is the one that install_plugins built",
    ),
    UntilCtrlC(r"^insula --plugin-path pia_membrane/build play pia_membrane/example\.xml$", "RENDER_FRAME", PLAY),
    UntilCtrlC(r"^/opt/insula/bin/insula play$", "RENDER_FRAME", PLAY),
    # A session: until the engine, or the servo where there is no engine, is at work. The viewer takes any free port.
    UntilCtrlC(r"^(LCM_DEFAULT_URL=\S+ )?\./insula play\b.*$", "RENDER_FRAME", PLAY, "viewer at http"),
    UntilCtrlC(r"^\./insula view (?!--list).*$", "RENDER_FRAME", PLAY, "viewer at http"),
    UntilCtrlC(r"^\./insula engine .*$", "RENDER_FRAME"),
    UntilCtrlC(r"^build/release/bin/haptic_server .*$", "DEVICE_STATE"),
    Shorter(
        r"^(\./insula devices --show .*)$", r"\1 --duration 1", "until Ctrl-C; the arm is a stand-in's", "up to 3.3 N"
    ),
    Shorter(r"^(\./insula devices --test-force .*)$", r"\1 --yes", "asks before it begins; the arm is a stand-in's"),
    # Long ones: a part of the same.
    Shorter(
        r"^(\./insula case new .*)$",
        r"\1 --no-rehearse --vertices 700",
        "a coarser wall, without operating in exercise 2, which MadeCase and RealCase do",
    ),
    Shorter(
        r"^(\./insula case wall .*) --vertices 1200 --on$",
        r"\1 --vertices 800",
        "a little finer; `intake --on` runs the rest",
    ),
    Shorter(
        r"^(\./insula case scenes .*--rule .*)$",
        r"\1 --no-rehearse",
        "the motions are not played again",
    ),
    Shorter(r"^(\./insula case wall .* --neck.*) --on$", r"\1", "that stage alone; `intake --on` runs the rest"),
    Shorter(r"--motion none --duration 10\b", "--motion none --duration 1", "a part of it"),
    Shorter(
        r"^(\./insula run scenes/(training|cases/my_case)/.*--report report)$",
        r"\1 --duration 1",
        "the first second of the motion",
        "state_hash",
    ),
    Shorter(
        r"--steps 720 --record problems --every 12$",
        "--steps 40 --record problems --every 10",
        "fewer steps, and as many of them",
    ),
    Shorter(
        r"bench_large\.xml --solvers",
        "bench_training.xml --solvers",
        "the small scene: CHOLMOD takes seconds for each solve of the large one",
    ),
    Shorter(
        r"^(\./insula study studies/.*)$", r"\1 --sample 1 --workers 1", "one of the runs, on a coarse mesh", "results:"
    ),
    Shorter(
        r"^(bench/peers/run\.sh)( --json)?$",
        r"\1\2 --lobe temporal --steps 60 --repeats 1",
        "a second of one lobe",
        "MuJoCo",
    ),
    Shorter(r"--random 60\b", "--random 4", "fewer probes"),
    Shorter(r"--steps (600|300|30)\b", "--steps 20", "fewer steps"),
    Shorter(
        r"^(.*/learn_strands\.py .*)$",
        r"\1 --generations 1 --population 2 --chance 1 --decisions 3",
        "the beginning of a few episodes",
        "learned",
    ),
    Shorter(r"^(.*/steps_a_second\.py)$", r"\1 --steps 20", "fewer steps", "steps a second of 2 processes"),
    Shorter(r"^(\./insula bench .* --haptics .*)$", r"\1 --duration 0.1", "the first tenth of a second of the motion"),
    Shorter(r"--scaling --output folder", "--scaling --quick --output folder", "small sizes alone, as the page offers"),
    Shorter(
        r"^ninja -C build/mesh_lobes", "ninja -n -C build/mesh_lobes", "says what it would compile, which takes minutes"
    ),
    Shorter(
        r"^((INSULA_SOAK\w*=\d+ )+exercise_tests .*)$",
        r"\1 --gtest_list_tests",
        "hours; the tests are named that it would run",
        r"\n  \w+",
    ),
)


def form_of(command):
    """The entry for a command, or None: it runs as it stands."""
    for form in FORMS:
        if (re.search if isinstance(form, Shorter) else re.fullmatch)(form.pattern, command):
            return form
    return None


def run_as(form, command):
    """What is run in the place of a command."""
    out = form.command(command) if form else command
    for there, here in INSTALLED:
        out = out.replace(there, here)
    return out
