# SPDX-License-Identifier: GPL-3.0-or-later
"""Views, contacts, the constraint problem, forces and stress, geometry: against laws that they obey."""

import gc

import insula
import numpy as np
import pytest
from conftest import BLOCK, load_block, work


@pytest.fixture
def busy(fissure):
    """Exercise 1 with both hands on tissue."""
    work(fissure, 200)
    return fissure


def test_channels_are_views_that_follow_the_steps(fissure):
    values = fissure.channels.values
    tension = fissure.channels.view("arachnoid.tension")
    address = values.__array_interface__["data"]
    before = values.copy()
    work(fissure, 200)
    assert not np.array_equal(before, values, equal_nan=True)
    fissure.reset()
    fissure.step(3)
    assert fissure.channels.values.__array_interface__["data"] == address
    assert tension[0] == fissure.channels["arachnoid.tension"]
    assert not values.flags.writeable
    info = {i.id: i for i in fissure.channels.infos}["arachnoid.tension"]
    assert (info.unit, values[info.offset], info.low) == ("N", tension[0], 0)
    assert "arachnoid.tension" in fissure.channels and len(fissure.channels) == len(list(fissure.channels))
    with pytest.raises(KeyError, match='did you mean "arachnoid.tension"'):
        print(fissure.channels["arachnoid.tensoin"])


def test_views_keep_the_simulation_alive():
    positions = load_block().body("block").positions
    gc.collect()
    assert np.isfinite(positions).all()
    assert np.linalg.norm(positions, axis=1).max() < 1


def test_contacts_are_records(busy):
    contacts = busy.contacts
    assert len(contacts) > 0
    assert np.allclose(np.linalg.norm(contacts["normal"], axis=1), 1, atol=1e-9)
    assert (contacts["normal_force"] >= 0).all()
    tangent = np.linalg.norm(contacts["tangent_force"], axis=1)
    assert (tangent <= 0.1 * contacts["normal_force"] + 1e-6).all()  # the largest friction of the scene
    names = [b.id for b in busy.bodies]
    touched = {frozenset((names[c["body_a"]], names[c["body_b"]])) for c in contacts if c["normal_force"] > 0}
    assert any("left_suction" in pair for pair in touched)
    # The sum over a hand's contacts is what the report says of the hand.
    tool = busy.body("left_suction").index
    force = sum((1 if c["body_a"] == tool else -1) * (c["normal_force"] * c["normal"] + c["tangent_force"])
                for c in contacts if tool in (c["body_a"], c["body_b"]))
    assert np.linalg.norm(force) == pytest.approx(busy.contact_force("left"), rel=1e-9)


def test_the_problem_obeys_its_laws(busy):
    p = busy.problem
    w, free, force = p.W, p.delta_free, p.lambda_
    assert w.shape == (p.rows, p.rows) and p.rows == sum(b.rows for b in p.blocks) > 20
    assert np.allclose(w, w.T, rtol=1e-9, atol=1e-12 * abs(w).max())
    assert np.linalg.eigvalsh(w).min() > -1e-9 * abs(w).max()
    delta = w @ force + free
    for b in p.blocks:
        if b.law == "box" and b.lower < force[b.row] < b.upper:
            assert abs(delta[b.row] + b.compliance * force[b.row]) < 1e-5, b
        if b.law == "friction":
            n, t = force[b.row], force[b.row + 1 : b.row + 3]
            assert n >= 0 and np.linalg.norm(t) <= b.friction * n * (1 + 1e-9) + 1e-12, b
    assert {b.owner for b in p.blocks} >= {"tools"}
    # The problem is a value: later steps leave it.
    kept = w.copy()
    busy.step(2)
    assert np.array_equal(kept, w)
    again, _ = p.solve(tolerance=1e-7, max_sweeps=80)
    # Forces are known as well as the violation is, which W gives.
    assert abs(w @ (again - force)).max() < 1e-5
    pushed, _ = p.solve(free - 1e-3)
    assert abs(w @ (pushed - force)).max() > 1e-4
    with pytest.raises(ValueError, match="numbers"):
        p.solve(np.zeros(p.rows + 1))


def test_a_tool_s_response_is_its_part_of_the_problem(busy):
    p = busy.problem
    for tool in p.tools:
        # On the tool: H^T lambda. On the body as the module sums it: the same.
        body = busy.body(busy.tool(tool.hand))
        assert np.allclose(tool.jacobian.T @ p.lambda_, body.constraint_forces.reshape(6), atol=1e-9)


def test_the_forces_of_a_body_are_those_of_its_rows(busy):
    """Rows push one body against another: the forces on all bodies add up to those on things that never move."""
    total, scale = np.zeros(3), 0.0
    for b in busy.bodies:
        if b.element == "obstacle":
            continue
        force = b.constraint_forces
        total += force.sum(axis=0) if b.deformable else force[0]
        scale = max(scale, np.abs(force).sum())
        assert not b.deformable or not force[b.fixed == 1].any()
    still = [b.index for b in busy.bodies if b.element == "obstacle"]
    for c in busy.contacts:
        sign = int(c["body_a"] in still) - int(c["body_b"] in still)
        total += sign * (c["normal_force"] * c["normal"] + c["tangent_force"])
    assert scale > 0.01
    assert np.linalg.norm(total) < 1e-9 * scale


def test_stress_of_a_stretched_block():
    """A block that hangs by its own weight: the stress over a section is the weight below it."""
    rho, g = 1000.0, 5.0
    heavy = BLOCK.replace('title="Block"', 'title="Block" gravity="0 0 -5 m/s2"')
    simulation = load_block(heavy)
    simulation.step(600)
    block = simulation.body("block")
    x, tets, stress = block.positions, block.elements, block.stress
    assert np.abs(block.velocities).max() < 1e-4
    corner = x[tets]
    volume = np.einsum("ij,ij->i", np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]),
                       corner[:, 3] - corner[:, 0]) / 6
    assert (volume > 0).all()
    assert np.allclose(stress, stress.transpose(0, 2, 1), atol=1e-6 * np.abs(stress).max())
    # Equilibrium of the free nodes: the nodal force of the stress carries their weight.
    force = np.zeros_like(x)
    for t, nodes in enumerate(tets):
        edges = np.array([x[nodes[k]] - x[nodes[0]] for k in (1, 2, 3)]).T
        gradients = np.linalg.inv(edges)
        for k in (1, 2, 3):
            f = -volume[t] * stress[t] @ gradients[k - 1]
            force[nodes[k]] += f
            force[nodes[0]] -= f
    free = block.fixed == 0
    weight = block.masses[:, None] * np.array([0, 0, -g])
    assert np.abs((force + weight)[free]).max() < 1e-3 * np.abs(weight).max()
    assert block.masses.sum() == pytest.approx(rho * volume.sum(), rel=0.05)


def test_stress_does_not_change_the_run(fissure):
    other = insula.load("sylvian_fissure")
    work(fissure, 30)
    for k in range(30):
        work(other, 1, start=20 + k * other.time_step)
        for b in other.bodies:
            if b.deformable:
                assert np.isfinite(b.stress).all()
        assert other.energy >= 0
    assert fissure.state_hash == other.state_hash


def test_geometry_of_the_picture(busy):
    for s in busy.surfaces:
        assert s.triangles.max() < len(s.positions) == len(s.rest)
    moved = {s.id: np.abs(s.positions - s.rest).max() for s in busy.surfaces}
    assert moved["temporal_surface"] > 1e-4 and moved["bone"] == 0
    parts = busy.tool_parts("left_suction")
    assert sum(len(p.triangles) for p in parts) > 100
    (position, orientation), = busy.body("left_suction").links
    assert busy.tip_pose("left") == (position, orientation)
    strands = {d.id: d for d in busy.drawables}
    lines = [d for d in strands.values() if d.kind == "polylines"]
    assert lines and all(np.isfinite(d.data).all() for d in lines)
    eye, target, up = busy.view
    assert np.linalg.norm(np.subtract(eye, target)) > 0.1 and len(up) == 3


def test_the_exercise_is_read(busy):
    assert busy.exercise_state == "running"
    assert [g.id for g in busy.goals] == ["open", "divide", "together"]
    assert {f.id for f in busy.faults} >= {"torn", "order"}
    metrics = {(m.id, m.hand): m for m in busy.metrics()}
    assert metrics["path_length", "left"].value > 0
    assert any(m.text for m in busy.measures)
