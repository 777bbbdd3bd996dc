"""Going back in memory: the same steps again have the same bits, whatever happened between."""

import numpy as np
from test_same_bits import STEPS, crowd, same


def test_steps_from_a_snapshot_have_the_same_bits_across_new_lists() -> None:
    system = crowd()
    system.advance(40)
    kept = system.snapshot()
    system.advance(STEPS)
    wanted, lists = system.state(), system.rebuilds
    assert lists > 8, "grains have been sorted anew"
    kept.rewind()
    assert system.steps_done == 40
    system.advance(STEPS)
    assert same(system.state(), wanted) and system.rebuilds == lists


def test_snapshots_do_not_disturb_each_other() -> None:
    system = crowd()
    system.advance(40)
    early, state = system.snapshot(), system.state()
    system.advance(60)
    late, late_state = system.snapshot(), system.state()
    system.advance(60)
    late.rewind()
    assert same(system.state(), late_state)
    early.rewind()
    assert same(system.state(), state)
    system.advance(60)
    again = system.snapshot(late)  # in the memory of the former one
    system.advance(STEPS)
    again.rewind()
    assert same(system.state(), late_state)


def test_a_snapshot_survives_another_state_in_between() -> None:
    other = crowd()
    other.advance(150)
    system = crowd()
    system.advance(40)
    kept, state = system.snapshot(), system.state()
    system.restore(other.state())
    system.advance(5)
    kept.rewind()
    assert same(system.state(), state)
    assert np.isfinite(system.grains.x).all()
