# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: files and their errors, the plan, rows, and what a scene is told from outside."""

import dataclasses
import io
import time

import insula
import numpy as np
import pytest
import study_for_test as st
from conftest import BLOCK, load_block
from insula import studies
from insula.studies import planning, random_hands, running
from insula.studies.progress import Progress
from insula.studies.soundness import Soundness
from insula.studies.study import RandomHands

WRONG = """<study title="Wrong">
  <scene file="block.xml"/>
  <vary of="block.corotational_fem.yuong" values="1, 2 kPa"/>
  <vary of="blok.mass_damping" values="1, 2"/>
  <vary variable="youn" values="1 kPa, 2 kPa" count="3"/>
  <vary name="pair"><point value="a"/></vary>
  <seedz count="3"/>
  <seeds count="0" form="1"/>
  <run duration="3" time_limit="0 s"/>
  <body id="block" value="displcement"/>
  <plot file="../out.svg" x="a" y="b"/>
</study>
"""


def told(file):
    with pytest.raises(studies.StudyError) as caught:
        studies.plan(file)
    return str(caught.value)


def test_everything_wrong_is_told_at_once(tmp_path):
    file = st.write(tmp_path)
    file.write_text(WRONG)
    said = told(file)
    for line, what in (
        (3, 'no parameter "yuong"; did you mean "young"?'),
        (4, 'no component has the id "blok"; did you mean "block"?'),
        (5, '"count" may not stand beside "values"'),
        (5, 'no variable "youn"; did you mean "young"?'),
        (6, "<point> sets nothing"),
        (7, "unknown element <seedz>; did you mean <seeds>?"),
        (8, "0 is too small: at least 1"),
        (8, 'no attribute "form"; did you mean "from"?'),
        (9, '"3" has no unit'),
        (9, "is not above 0"),
        (10, 'did you mean "displacement"?'),
        (11, "must be a plain name"),
        (11, 'no column "a"'),
    ):
        assert any(part.startswith("%s:%d:" % (file, line)) and what in part for part in said.split("\n")), (what, said)
    done = st.run(file, "--out", tmp_path / "out")
    assert done.returncode == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "axis, what",
    [
        ('<vary of="block.corotational_fem.young" values="2, 4 N"/>', '"N" is not a unit of pressure'),
        ('<vary of="block.corotational_fem.poisson" values="0.3, 0.7"/>', "is outside the allowed range"),
        ('<vary of="block.corotational_fem.young" from="2 kPa" to="4 Pa" count="3"/>', "has another unit"),
        ('<vary of="block.corotational_fem.young" values="2 kPa, 2 kPa"/>', "is there twice"),
        ('<motion name="steady"/>', 'no motion "steady"'),
        ('<channel id="nothing"/>', 'no channel "nothing"'),
        ('<goal id="clip"/>', "the scene has none"),
        ('<random_hands/>', "needs <seeds>"),
    ],
)
def test_values_are_checked_where_they_stand(tmp_path, axis, what):
    said = told(st.write(tmp_path, axis))
    assert what in said
    assert said.startswith("%s:3:" % (tmp_path / "study.xml"))
    assert "\n" not in said


def test_a_file_that_is_missing_or_no_study(tmp_path):
    assert "cannot be read" in told(tmp_path / "none.xml")
    (tmp_path / "half.xml").write_text("<study title='x'>")
    assert "half.xml:1:" in told(tmp_path / "half.xml")
    (tmp_path / "scene.xml").write_text("<scene/>")
    assert "unknown element <scene>" in told(tmp_path / "scene.xml") or "root" in told(tmp_path / "scene.xml")


def test_changes_have_the_bits_of_a_changed_scene():
    heavy = BLOCK.replace('title="Block"', 'title="Block" gravity="0 0 -5 m/s2"')
    other = load_block(heavy.replace("2 kPa", "3 kPa"))
    changed = load_block(heavy, changes={"block.corotational_fem.young": "3 kPa"})
    also = load_block(BLOCK, changes={"block.corotational_fem.young": "3 kPa", "scene.gravity": "0 0 -5 m/s2"})
    plain = load_block(heavy)
    for s in (other, changed, also, plain):
        s.step(5)
    assert other.state_hash == changed.state_hash == also.state_hash != plain.state_hash
    assert changed.scene_hash not in (plain.scene_hash, other.scene_hash)
    assert insula.load("clipping", changes={"$artery_case": "narrow_neck"}).scene_hash
    with pytest.raises(insula.SceneError, match="did you mean \"block\""):
        load_block(changes={"blok.mesh": "x"})
    with pytest.raises(ValueError, match="names no parameter"):
        load_block(changes={"young": "1 kPa"})


def test_the_plan_is_stable_and_knows_what_changed(tmp_path):
    axes = st.YOUNG + '<vary variable="young" values="2, 3 kPa"/>' + st.SEEDS % 2
    axes = axes.replace('<vary variable="young" values="2, 3 kPa"/>', '<rate value="60 Hz"/><rate value="100 Hz"/>')
    file = st.write(tmp_path, axes)
    first = studies.plan(file)
    assert len(first.runs) == 3 * 2 * 2 == len({r.id for r in first.runs})
    assert [r.id for r in studies.plan(file).runs] == [r.id for r in first.runs]
    # More values leave the runs that there were.
    st.write(tmp_path, axes.replace("8 kPa", "8, 16 kPa"))
    more = studies.plan(file)
    assert {r.id for r in first.runs} < {r.id for r in more.runs} and len(more.runs) == 16
    for scene, length in ((st.SCENE.replace("-5 m/s2", "-6 m/s2"), "0.2 s"), (st.SCENE, "0.3 s")):
        st.write(tmp_path, axes, duration=length, scene=scene)
        assert not {r.id for r in first.runs} & {r.id for r in studies.plan(file).runs}
    assert [r.number for r in planning.sample(first.runs, 3)] == [0, 4, 8]


def test_scenes_have_different_labels(tmp_path):
    study = studies.plan(st.write(tmp_path)).study
    many = [tmp_path / name for name in ("a/case.xml", "b/case.xml", "a/tear.xml", "b/tear.xml", "3_open.xml")]
    labels = dataclasses.replace(study, scenes=tuple(many)).labels
    assert labels == ("a", "b", "a/tear", "b/tear", "3_open")


def test_a_row_is_what_a_run_gives(tmp_path):
    plan = studies.plan(st.write(tmp_path))
    row = running.perform(plan.study, plan.runs[1])
    alone = insula.load(tmp_path / "block.xml", changes={"block.corotational_fem.young": "4 kPa"})
    alone.step(12)
    assert row["status"] == "done", row
    assert row["state_hash"] == "%016x" % alone.state_hash
    block = alone.body("block")
    assert row["block.displacement"] == np.linalg.norm(block.positions - block.rest, axis=1).max() > 0
    assert (row["block.corotational_fem.young"], row["steps"]) == (4.0, 12)
    assert row["scene_hash"] != "%016x" % insula.load(tmp_path / "block.xml").scene_hash
    # A run after others in the same process has the bits of one alone.
    for run in (plan.runs[0], plan.runs[2], plan.runs[1]):
        again = running.perform(plan.study, run)
    assert again["state_hash"] == row["state_hash"]


def test_a_run_beyond_its_time_fails(tmp_path):
    plan = studies.plan(st.write(tmp_path, duration="60 s", limit="20 ms"))
    row = running.perform(plan.study, plan.runs[0])
    assert row["status"] == "failed"
    assert "time limit" in str(row["error"])
    assert 0 < row["simulated"] < 60


def test_random_hands_are_those_of_their_seed(fissure):
    hands = RandomHands(busy=1.0, rest=0.2)
    motions = [random_hands.random_motion(fissure, seed, hands) for seed in (5, 5, 6)]
    at = [[m.at(h, 0.8) for h in ("left", "right")] for m in motions]
    assert at[0] == at[1] != at[2]
    assert motions[0].commands == motions[1].commands != []
    # Between two keys a hand is never faster than its strokes.
    for hand in ("left", "right"):
        ends = motions[0].duration
        places = np.array([motions[0].at(hand, t)[0] for t in np.arange(0, ends, 0.01)])
        assert np.linalg.norm(np.diff(places, axis=0), axis=1).max() < 0.01 * 0.6
        assert motions[0].at(hand, ends)[0] == pytest.approx(fissure.hand_pose(hand)[0])
    fissure.follow(motions[0])
    sound = Soundness(fissure)
    fissure.step(20)
    seen = sound.values()
    assert seen["sound"] and seen["inverted"] == 0 and 0.3 < seen["volume"] <= 1


def test_soundness_finds_an_inverted_element():
    block = load_block()
    sound = Soundness(block)
    assert sound.values()["sound"]
    body, elements, rest = sound.solids[0]
    sound.solids[0] = (body, elements[:, [1, 0, 2, 3]], rest)
    seen = sound.values()
    assert seen["inverted"] == len(elements) and not seen["sound"] and sound.inverted_ever == len(elements)


def test_a_hand_may_be_pulled_by_the_vessel_that_it_clips():
    simulation = insula.load("clipping")
    simulation.follow(simulation.motion("steady"))
    sound = Soundness(simulation)
    seen = []
    for time in (4.0, 5.5, 7.0):  # the blades are open; shut in the applier; shut and let go
        simulation.step(round((time - simulation.time) / simulation.time_step))
        seen.append(sound.gripping())
    assert seen == [set(), {"applier"}, set()]


def test_a_clip_that_slips_off_draws_out_no_node_of_the_wall():
    # This hand shuts the clip on a fold of the wall and draws the applier away. The fold once passed between the shut
    # blades but for one node, which was drawn out by 4 mm with 2.8 N.
    simulation = insula.load("clipping", seed=76)
    simulation.draw_complications(76)
    simulation.reset()
    motion = random_hands.random_motion(simulation, 76, RandomHands())
    simulation.follow(motion)
    simulation.step(round((motion.duration + 1) / simulation.time_step))
    artery = simulation.body("artery")
    edges = np.concatenate([artery.elements[:, [k, (k + 1) % 3]] for k in range(3)])
    length = np.linalg.norm(np.diff(artery.positions[edges], axis=1), axis=(1, 2))
    rest = np.linalg.norm(np.diff(artery.rest[edges], axis=1), axis=(1, 2))
    assert (length / rest).max() < 1.75
    assert simulation.contacts["normal_force"].max() < 0.5
    assert Soundness(simulation).values()["sound"]


def test_time_left_follows_the_pace():
    out = io.StringIO()
    progress = Progress(100, 20, out=out)
    assert progress.left() is None
    progress.recent[0] -= 10
    time.sleep(0.01)
    for _ in range(40):
        progress.add("done")
    assert progress.left() == pytest.approx(10, rel=0.1)
    progress.tell(last=True)
    assert "60 of 100 runs" in out.getvalue() and "about 10 s left" in out.getvalue()
