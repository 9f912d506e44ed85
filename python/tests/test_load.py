# SPDX-License-Identifier: GPL-3.0-or-later
"""Loading: files, texts, names, plugins, and what is wrong with a scene as an exception."""

import insula
import pytest
from conftest import BLOCK, load_block


def test_a_scene_by_file_name_and_text():
    scene = insula.scenes()["touch_targets"]
    assert insula.load(scene).title == insula.load(str(scene)).title == insula.load("touch_targets").title
    block = load_block()
    assert (block.title, [b.id for b in block.bodies]) == ("Block", ["block"])
    assert not block.has_exercise
    with pytest.raises(ValueError, match="no exercise"):
        print(block.goals)


def test_names_of_shipped_scenes():
    scenes = insula.scenes()
    assert scenes["basilar_tip"].parts[-2:] == ("basilar_tip", "case.xml")
    assert scenes["basilar_tip/pause"].name == "pause.xml"
    assert len(set(scenes.values())) == len(scenes)
    for name, file in scenes.items():
        assert insula.shipped.find(name) == file
    assert insula.shipped.find("3_clipping") == scenes["clipping"]
    for wrong, nearest in (("basilar_tipp", "basilar_tip"), ("4_clipping", "clipping"), ("case", "there are")):
        with pytest.raises(FileNotFoundError, match=nearest):
            insula.load(wrong)


@pytest.mark.parametrize("step", [0, -1, float("nan")])
def test_a_step_is_longer_than_nothing(step):
    with pytest.raises(ValueError, match="above 0"):
        load_block(time_step=step)


def test_everything_prints_what_it_is():
    simulation = insula.load("sylvian_fissure")
    simulation.step()
    tool = next(b for b in simulation.bodies if b.element == "dissector")
    seen = [simulation, simulation.channels, simulation.problem, simulation.motion("steady"), simulation.save(),
            *simulation.channels.infos[:1], *simulation.problem.blocks[:1], *simulation.problem.tools,
            *simulation.bodies, *simulation.surfaces, *simulation.tool_parts(tool.id), *simulation.drawables,
            *simulation.goals, *simulation.faults, *simulation.timers, *simulation.measures, *simulation.metrics()]
    assert len({type(s) for s in seen}) >= 16
    assert not [repr(s) for s in seen if " object at " in repr(s)]
    assert "<Metric strands_torn: 0>" in repr(simulation.metrics())
    assert "arachnoid.standing" in repr(simulation.channels)


def test_a_text_finds_its_files_beside_its_path():
    folder = insula.shipped.folder() / "meshes/examples"
    text = """<scene><soft_body id="b" mesh="block.msh" mesh_unit="mm"><corotational_fem/></soft_body></scene>"""
    assert insula.load(text, path=folder / "mine.xml").file.endswith("mine.xml")


def test_every_problem_is_told_with_its_place():
    wrong = BLOCK.replace('young="2 kPa"', 'young="2 N" poison="0.4"').replace("<fixed", "<fixd")
    wrong = wrong.replace('"Block"', '"B"')
    with pytest.raises(insula.SceneError) as caught:
        load_block(wrong)
    problems = caught.value.problems
    assert len(problems) == 3
    for p in problems:
        assert p.severity == "error"
        assert p.file.endswith("mine.xml")
        assert p.column > 1
    assert [p.line for p in problems] == [3, 3, 4]
    assert {p.nearest for p in problems} == {None, "poisson", "fixed"}
    assert str(problems[0]) in str(caught.value)
    assert "mine.xml:3:" in str(problems[0])
    assert isinstance(caught.value, ValueError)


def test_a_missing_file_and_a_name_that_nothing_has():
    with pytest.raises(insula.SceneError, match="nowhere.xml"):
        insula.load("nowhere.xml")
    with pytest.raises(FileNotFoundError, match="sylvian_fissure"):
        insula.load("sylvian")


def test_the_time_step_can_be_set():
    assert load_block(time_step=0.002).time_step == pytest.approx(0.002, abs=1e-12)


def test_how_long_a_scene_settles():
    assert load_block().settle_time == 0
    assert load_block(BLOCK.replace("</scene>", '<settle time="0.5 s"/></scene>')).settle_time == 0.5


def test_plugins_come_from_folders(build, tmp_path):
    with_tiny = BLOCK.replace("</scene>", '<tiny_constraint id="t" strength="1 N"/></scene>')
    with pytest.raises(insula.SceneError, match="tiny_constraint"):
        load_block(with_tiny)
    folder = tmp_path / "plugins"
    folder.mkdir()
    (folder / "tiny.so").write_bytes((build / "tests/plugin_so/tiny.so").read_bytes())
    simulation = load_block(with_tiny, plugins=[folder])
    simulation.step(3)
    with pytest.raises(insula.SceneError):
        load_block(with_tiny)  # the plugins of a simulation are its own
    with pytest.raises(insula.InputError, match="was built for another Insula"):
        load_block(plugins=[build / "tests/plugin_so/tiny_wrong_abi.so"])
    with pytest.raises(insula.InputError, match="no such file"):
        load_block(plugins=["nowhere.so"])


def test_commands_are_done_or_refused(fissure):
    with pytest.raises(insula.CommandRefused, match='did you mean "bipolar"'):
        fissure.command("exchange", "right biplar")
    fissure.command("exchange", "right bipolar")
    assert fissure.tool("right") == "bipolar"
    assert fissure.tools("right") == ["right_dissector", "bipolar"]
    fissure.step()
    assert [(e.kind, e.id) for e in fissure.events] == [("refused", "exchange"), ("command", "exchange")]
    assert any(c[:2] == ("brain", "mannitol") or c[0] == "brain" for c in fissure.commands)


def test_wrong_hands_are_refused(fissure):
    with pytest.raises(ValueError, match='"left" or "right"'):
        fissure.set_hand("middle", (0, 0, 0), (1, 0, 0, 0))
    with pytest.raises(ValueError, match="finite"):
        fissure.set_hand("left", (0, float("nan"), 0), (1, 0, 0, 0))
    with pytest.raises(ValueError, match="quaternion"):
        fissure.set_hand("left", (0, 0, 0), (0, 0, 0, 0))
    motion = insula.Motion()
    motion.add("left", 0.0, (0.3, 0, 0), (1, 0, 0, 0))
    with pytest.raises(insula.InputError, match="mm"):
        fissure.follow(motion)  # farther from the tool than a hand may start
    fissure.follow(fissure.motion("steady"))
    with pytest.raises(RuntimeError, match="a motion moves the hands"):
        fissure.set_hand("left", (0, 0, 0), (1, 0, 0, 0))
    with pytest.raises(insula.InputError, match="motion:2"):
        insula.Motion.parse("time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n0,lft,0,0,0,1,0,0,0,0,0\n")


def test_a_state_that_diverges_is_an_exception(fissure):
    assert fissure.step(2) is None
    with pytest.raises(ValueError, match="at least 0"):
        fissure.step(-1)
