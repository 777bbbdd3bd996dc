"""Places that messages name: the deepest contact of a grain, and grains that turn about at every step."""

import numpy as np
import pytest

from particles import ContactModel, Facets, Grains, LinearSpringDashpot, ParticleSystem, Wall, box
from particles.spots import alternating, deepest_touch

RADIUS, DENSITY, STIFFNESS = 0.01, 1000.0, 1e5
MASS = np.pi * RADIUS**2 * DENSITY


def system(places: list[list[float]], velocity: list[list[float]], **options: object) -> ParticleSystem:
    grains = Grains.discs(places, RADIUS, DENSITY, velocity=velocity)
    law = ContactModel(normal=LinearSpringDashpot(stiffness=STIFFNESS, damping=0.0, may_pull=True))
    made = ParticleSystem(grains, law, time_step=options.pop("time_step", 1e-6), **options)
    made.start()
    return made


def test_the_deepest_of_a_wall_and_two_discs() -> None:
    """Overlaps of 1, 3 and 2 mm; the floor rises, the others part or close."""
    floor = Wall(point=(0.0, 0.0), normal=(0.0, 1.0), velocity=(0.0, 0.25), name="floor")
    places = [[0.0, 0.009], [0.017, 0.009], [-0.018, 0.009]]
    three = system(places, [[0.0, 0.0], [-2.0, 0.0], [-3.0, 0.0]], walls=[floor])
    place = int(np.nonzero(three.grains.number == 0)[0][0])
    touch = deepest_touch(three, place)
    assert three.grains.number[touch.partner] == 1 and touch.wall is None
    assert touch.depth == pytest.approx(0.3) and touch.approach == pytest.approx(2.0, rel=1e-3)
    alone = int(np.nonzero(three.grains.number == 2)[0][0])
    assert deepest_touch(three, alone).approach == pytest.approx(-3.0, rel=1e-3)
    one = system([[0.0, 0.009]], [[0.0, -1.0]], walls=[floor])
    touch = deepest_touch(one, 0)
    assert touch.wall == 0 and touch.partner is None
    assert touch.depth == pytest.approx(0.1) and touch.approach == pytest.approx(1.25, rel=1e-3)
    assert deepest_touch(system([[0.0, 0.02]], [[0.0, 0.0]], walls=[floor]), 0) is None


def test_the_deepest_across_a_seam_and_on_a_facet() -> None:
    pair = system([[0.001, 0.5], [0.083, 0.5]], [[0.0, 0.0], [1.0, 0.0]], period=(0.1, None))
    assert deepest_touch(pair, 0).depth == pytest.approx(0.2)
    assert deepest_touch(pair, 0).approach == pytest.approx(1.0, rel=1e-3)
    line = Facets(points=np.array([[1.0, 0.0], [-1.0, 0.0]]), facets=np.array([[0, 1]]))
    touch = deepest_touch(system([[0.1, 0.006]], [[0.5, -2.0]], facets=line), 0)
    assert touch.partner is None and touch.wall is None
    assert touch.depth == pytest.approx(0.4) and touch.approach == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.8, 0.97])
def test_an_oscillation_turns_about_as_often_as_its_phase_says(share: float) -> None:
    """A disc squeezed between floor and lid: ``omega^2 = 2 k/m``, ``sin(theta/2) = omega dt/2``, which is `share`.

    Its velocities before and after a position are ``cos(phi -+ theta/2)``, with all phases phi in turn.
    """
    step = share * 2.0 / np.sqrt(2.0 * STIFFNESS / MASS)
    disc = system([[0.0, 0.0096]], [[0.0, 0.0]], walls=box(1.0, 0.019, ("floor", "lid")), time_step=step)
    turned, steps = 0, 2000
    for _ in range(steps):
        disc.advance(1)
        turned += len(alternating(disc))
    phase, half = np.linspace(0.0, np.pi, 100_000, endpoint=False), np.arcsin(share)
    before, after = np.cos(phase - half), np.cos(phase + half)
    expected = np.mean(before * after < -0.5 * np.maximum(before**2, after**2))
    # phases of a finite walk: one more or less per turn of the phase
    assert turned / steps == pytest.approx(expected, abs=0.01)
