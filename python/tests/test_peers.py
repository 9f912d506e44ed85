# SPDX-License-Identifier: GPL-3.0-or-later
"""The bench against other programs is fair: they get the same task, and their states are judged by laws that are
checked on their own."""

import pathlib
import sys

import insula
import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(insula.shipped.folder()) / "bench/peers"))
case = pytest.importorskip("case", reason="the bench is part of the source tree only")
import compare  # noqa: E402
import geometry  # noqa: E402
import laws  # noqa: E402
import measure  # noqa: E402
from insula_side import InsulaSide  # noqa: E402

LAWS = (laws.Corotational(), laws.StiffeningCorotational(), laws.SaintVenantKirchhoff())


def mujoco_side():
    pytest.importorskip("mujoco")
    from mujoco_side import MujocoSide

    return MujocoSide


@pytest.fixture(scope="module")
def block():
    return case.block()


def run(side, steps):
    judge = measure.Judge(side.case, side.law)
    for _ in range(steps):
        judge.see(side.step()[1])
    return judge


@pytest.mark.parametrize("law", LAWS, ids=lambda x: x.name)
def test_a_law_s_force_is_the_gradient_of_its_energy(block, law):
    elastic = laws.Elastic(block.rest, block.elements, 2100, 0.45, law)
    random = np.random.default_rng(1)
    x = block.rest + 1e-3 * random.standard_normal(block.rest.shape)
    way = random.standard_normal(block.rest.shape)
    step = 1e-8
    x[3] += 0.0045 * (x[10] - x[3]) / np.linalg.norm(x[10] - x[3])  # some elements are pressed flat
    slope = (elastic.energy(x + step * way) - elastic.energy(x - step * way)) / (2 * step)
    assert slope == pytest.approx(-(elastic.force(x) * way).sum(), rel=1e-6)
    # Rigid motions cost nothing.
    turn, _ = np.linalg.qr(random.standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    assert abs(elastic.energy(block.rest @ turn.T + 0.1)) < 1e-15


def test_a_stretched_bar_has_the_energy_of_hooke(block):
    # Uniaxial stress at a small strain: E e^2 / 2 times the volume.
    e, young, poisson = 1e-5, 2100.0, 0.45
    strained = block.rest * (1 + e * np.array([-poisson, -poisson, 1]))
    for law in LAWS:
        elastic = laws.Elastic(block.rest, block.elements, young, poisson, law)
        assert elastic.energy(strained) == pytest.approx(young * e**2 / 2 * elastic.volume.sum(), rel=1e-3), law.name


def test_distance_to_triangles():
    a, b, c = (np.array([p], float) for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0)))
    for p, expected in (((0.2, 0.2, 0.3), 0.3), ((2, 0, 0), 1), ((1, 1, 0), np.sqrt(0.5)), ((-3, -4, 0), 5)):
        assert geometry.distance_to_triangles(np.array(p, float), a, b, c) == pytest.approx(expected)


def test_insula_obeys_the_law_that_judges_it(block):
    judge = run(InsulaSide(block), block.steps)
    worth = judge.worth()
    assert worth.residual_rest < 1e-4 and worth.energy_drift < 1e-3
    assert worth.deflection_mm > 0.02
    # A ball of another size, or a softer block, is noticed.
    softer = laws.Elastic(block.rest, block.elements, 0.99 * block.young, block.poisson, laws.StiffeningCorotational())
    assert np.linalg.norm((softer.force(judge.before.x) + judge.weight)[block.free]) > 1e-3 * judge.scale


def test_mujoco_obeys_the_law_that_judges_it(block):
    worth = run(mujoco_side()(block), block.steps).worth()
    assert worth.residual_rest < 1e-4 and worth.energy_drift < 1e-3


def test_programs_agree_on_the_deflection(block):
    ours, theirs = InsulaSide(block), mujoco_side()(block)
    x, y = run(ours, block.steps).before.x, run(theirs, block.steps).before.x
    moved = np.linalg.norm(x - block.rest, axis=1).max()
    # The laws differ by terms of the order of the strain, which is below 1 % here.
    assert np.linalg.norm(x - y, axis=1).max() < 0.01 * moved


def test_programs_agree_on_a_pressed_ball():
    pressed = case.block(pressed=0.0004, steps=150)
    ours = run(InsulaSide(pressed), pressed.steps).worth()
    theirs = run(mujoco_side()(pressed), pressed.steps).worth()
    assert ours.contact_force_N > 0.001
    assert ours.contact_force_N == pytest.approx(theirs.contact_force_N, rel=0.15)
    assert ours.penetration_mm < 0.1 and theirs.penetration_mm < 0.15


def worth_of(**changes):
    values = dict(residual_moving=1e-3, residual_largest=1e-2, residual_rest=1e-9, penetration_mm=0.0,
                  contact_force_N=0.0, energy_drift=0.0, elastic_mJ=1.0, deflection_mm=1.0, least_stretch=0.9, steps=60)
    return measure.Worth(**{**values, **changes})


def entry(program, ms, **changes):
    return compare.Entry(program, "x", "law", worth_of(**changes), "", ms)


def test_unequal_residuals_are_refused():
    ours = entry("Insula", [1.0, 2.0, 1.0])
    same, worse = entry("A", [5.0, 6.0, 7.0], residual_moving=1.9e-3), entry("B", [5.0], residual_moving=2.1e-3)
    rest, lost = entry("C", [5.0], residual_rest=1e-3), entry("D", [5.0], residual_rest=float("nan"))
    below = entry("E", [5.0], residual_rest=9e-7)
    a, b, c, d, e = compare.compare([ours, same, worse, rest, lost, below], 2.0, 1e-6)
    assert not a.refused and (a.ratio, a.ratio_least, a.ratio_most) == (5.0, 3.0, 7.0)
    assert "while the tissue moves" in b.refused and b.ratio is None
    assert "at rest" in c.refused and d.refused and not e.refused


def test_wrong_arguments_are_told(capsys):
    import peers

    assert peers.main(["--lobe", "occipital"]) == 2
    assert 'no lobe "occipital"; there are frontal' in capsys.readouterr().err
    with pytest.raises(SystemExit) as end:
        peers.main(["--steps", "3"])
    assert end.value.code == 2
