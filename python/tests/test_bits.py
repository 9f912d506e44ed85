# SPDX-License-Identifier: GPL-3.0-or-later
"""The same bits: against the program, after a reset, from saved states, in threads, for any number of threads."""

import pathlib
import pickle
import subprocess
import threading

import insula
import pytest
from conftest import in_new_process, load_block, work

STEPS = 240
ALONE = """
import insula
from conftest import work
simulation = insula.load("sylvian_fissure")
work(simulation, %d)
print(simulation.state_hash)
"""


@pytest.fixture(scope="module")
def expected():
    """Hash after the hands' work in a process of its own."""
    return int(in_new_process(ALONE % STEPS))


def test_the_hands_work(fissure):
    """What the other tests repeat is a real piece of the exercise: strands are cut, both hands touch tissue."""
    standing, kinds, most = fissure.channels["arachnoid.standing"], set(), {"left": 0.0, "right": 0.0}
    motion = fissure.motion("steady")
    for k in range(STEPS):
        for hand in most:
            position, orientation, button1, button2 = motion.at(hand, 20 + k * fissure.time_step)
            fissure.set_hand(hand, position, orientation, button1, button2)
        fissure.step()
        kinds |= {e.kind for e in fissure.events}
        most = {hand: max(force, fissure.contact_force(hand)) for hand, force in most.items()}
    assert fissure.channels["arachnoid.standing"] < standing
    assert "strand_cut" in kinds
    assert min(most.values()) > 0.01  # N


def test_reset_has_the_bits_of_a_new_process(fissure, expected):
    work(fissure, 100, start=25.0)  # something else first
    fissure.command("exchange", "right bipolar")
    fissure.step(5)
    fissure.reset()
    assert (fissure.time, fissure.steps) == (0, 0)
    work(fissure, STEPS)
    assert fissure.state_hash == expected


def test_a_followed_motion_has_the_bits_of_insula_run(fissure, build):
    fissure.follow(fissure.motion("steady"))
    fissure.step(300)
    scene = insula.scenes()["sylvian_fissure"]
    said = subprocess.run([build / "bin/insula", "run", scene, "--motion", "steady", "--duration", "5", "--quiet"],
                          capture_output=True, text=True, check=True).stdout
    assert said.strip().endswith("state_hash %016x" % fissure.state_hash)
    fissure.reset()  # the motion begins again
    fissure.step(300)
    assert said.strip().endswith("state_hash %016x" % fissure.state_hash)


def test_a_state_is_restored_to_the_bit(fissure, expected):
    work(fissure, 100)
    state = fissure.save()
    assert (state.steps, state.hash) == (100, fissure.state_hash)
    work(fissure, STEPS - 100, start=20 + 100 * fissure.time_step)
    ends = fissure.state_hash
    fissure.restore(state)
    assert (fissure.steps, fissure.state_hash) == (100, state.hash)
    work(fissure, STEPS - 100, start=20 + 100 * fissure.time_step)
    assert fissure.state_hash == ends
    fissure.restore(state)
    later = fissure.save()
    assert bytes(later) == bytes(state)


def test_a_state_on_the_way_is_reached_from_where_the_run_is(fissure):
    other = insula.load("sylvian_fissure")
    work(fissure, 60)
    work(other, 30)
    steps = []
    state = fissure.save()
    other.restore(state)
    assert other.state_hash == state.hash
    assert not steps


def test_a_state_goes_to_another_process(fissure, tmp_path):
    fissure.draw_complications(7)
    work(fissure, 50)
    fissure.command("exchange", "right bipolar") if fissure.contact_force("right") == 0 else None
    fissure.follow(None)
    fissure.step(10)
    state = pickle.loads(pickle.dumps(fissure.save()))
    file = tmp_path / "state"
    file.write_bytes(bytes(state))
    program = """
import insula
simulation = insula.load("sylvian_fissure", threads=2)
simulation.restore(insula.State.of_bytes(open(%r, "rb").read()))
simulation.step(20)
print(simulation.state_hash)
""" % str(file)
    fissure.step(20)
    assert int(in_new_process(program)) == fissure.state_hash


def test_a_state_with_a_motion(fissure):
    fissure.follow(fissure.motion("steady"))
    fissure.step(120)
    state = fissure.save()
    fissure.step(60)
    ends = fissure.state_hash
    fissure.restore(state)
    fissure.step(60)
    assert fissure.state_hash == ends


def test_what_is_no_state_is_refused(fissure):
    with pytest.raises(insula.InputError, match="no saved state"):
        insula.State.of_bytes(b"something else")
    with pytest.raises(insula.InputError, match="another scene"):
        fissure.restore(load_block().save())
    work(fissure, 3)
    cut = insula.State.of_bytes(bytes(fissure.save())[:-12])
    with pytest.raises(insula.InputError, match="cut off"):
        fissure.restore(cut)


def test_simulations_in_threads_have_the_bits_of_one(expected):
    """Two simulations at once, each in a thread, while a third thread uses Python."""
    found, counted, done = {}, [0], threading.Event()

    def run(name):
        simulation = insula.load("sylvian_fissure")
        work(simulation, STEPS)
        found[name] = simulation.state_hash

    def count():
        while not done.is_set():
            counted[0] += 1

    workers = [threading.Thread(target=run, args=(n,)) for n in range(2)]
    counter = threading.Thread(target=count)
    for t in [*workers, counter]:
        t.start()
    for t in workers:
        t.join()
    done.set()
    counter.join()
    assert found == {0: expected, 1: expected}


def test_a_step_lets_other_threads_run(fissure):
    """Python goes on while a long call steps, and a second call at the same time is refused."""
    begun, seen = threading.Event(), []
    fissure.follow(fissure.motion("steady"))

    def run():
        begun.set()
        fissure.step(300)

    stepper = threading.Thread(target=run)
    stepper.start()
    begun.wait()
    refused = None
    while stepper.is_alive():
        seen.append(fissure.steps)
        try:
            fissure.set_hand("left", (0, 0, 0), (1, 0, 0, 0))
        except RuntimeError as e:
            refused = str(e)
    stepper.join()
    assert len(set(seen)) > 20  # steps that this thread saw go by
    assert "another thread is at work" in refused
    assert fissure.steps == 300


def test_threads_of_a_step_do_not_change_bits(expected):
    simulation = insula.load("sylvian_fissure", threads=2)
    work(simulation, STEPS)
    assert simulation.state_hash == expected


def test_a_new_process_needs_no_variables():
    program = "import os; import insula; insula.load('touch_targets').step(3); print(sorted(os.environ))"
    assert "INSULA" not in in_new_process(program)
    assert pathlib.Path(insula.__file__).name == "__init__.py"
