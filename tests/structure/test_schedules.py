"""Schedules against closed forms, an interpolation by numpy and a driven oscillator."""

import math

import meshes
import numpy as np
import pytest
from structure import BodyForce, Constant, ElasticStructure, PlaneStrain, PointLoad, Ramp, Sine, StructureError, Table


def test_ramp_is_continuous_and_held() -> None:
    ramp = Ramp(over=0.3)
    assert [ramp.factor(t) for t in (0.0, 0.15, 0.3, 7.0)] == pytest.approx([0.0, 0.5, 1.0, 1.0], abs=1e-15)
    assert abs(ramp.factor(0.3) - ramp.factor(0.3 * (1 - 1e-9))) < 2e-9
    assert Constant().factor(0.0) == Constant().factor(1e9) == 1.0


def test_table_is_numpys_interpolation() -> None:
    rng = np.random.default_rng(5)
    times, factors = np.cumsum(rng.uniform(0.01, 1.0, 30)), rng.normal(size=30)
    table = Table(times=tuple(times), factors=tuple(factors))
    asked = rng.uniform(times[0] - 1.0, times[-1] + 1.0, 500)
    seen = [table.factor(t) for t in asked]
    np.testing.assert_array_equal(seen, np.interp(asked, times, factors))
    assert table.largest == np.abs(factors).max() and table.constant_from == times[-1]


def test_sine_has_its_mean_amplitude_and_period() -> None:
    sine = Sine(frequency=4.0, phase=0.7, offset=-0.3)
    one_period = np.array([sine.factor(t) for t in np.arange(400) / 1600])
    assert one_period.mean() == pytest.approx(-0.3, abs=1e-14)
    assert np.sqrt(2 * one_period.var()) == pytest.approx(1.0, rel=1e-14)
    assert sine.factor(1.03) == pytest.approx(sine.factor(0.28), rel=1e-12)
    assert np.abs(one_period).max() <= sine.largest == 1.3


class OnlyFactor:
    def factor(self, time: float) -> float:
        return time


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: Ramp(over=0.0), "over = 0.0 must be finite and above 0 (s; for full strength from the start use"),
        (lambda: Sine(frequency=-1.0), "frequency = -1.0"),
        (lambda: Sine(frequency=1.0, phase=math.inf), "phase = inf"),
        (lambda: Table(times=(0.0,), factors=(1.0,)), "equally many, at least 2"),
        (lambda: Table(times=(0.0, 1.0), factors=(1.0,)), "times of shape (2,) and factors of shape (1,)"),
        (lambda: Table(times=(0.0, 2.0, 2.0), factors=(1.0, 0.0, 1.0)), "2.0 s after 2.0 s"),
        (lambda: Table(times=(0.0, 1.0), factors=(1.0, math.nan)), "must be finite"),
        (lambda: BodyForce(acceleration=(0.0, 1.0), schedule=0.5), "schedule = 0.5 is not known"),  # type: ignore
        (lambda: BodyForce(acceleration=(0.0, 1.0), schedule=OnlyFactor()), "factor(time), constant_from and largest"),
    ],
)
def test_bad_schedules(build, words: str) -> None:
    with pytest.raises(StructureError) as refusal:
        build()
    assert words in str(refusal.value)


@pytest.mark.parametrize("detuning", [0.5, 0.95])
def test_a_driven_mode_beats_as_a_forced_oscillator(detuning: float, aluminium: PlaneStrain) -> None:
    """``q'' + w0^2 q = f sin(w t)``, from rest: ``q = f/(w0^2 - w^2) (sin w t - w/w0 sin w0 t)``.

    The load is a multiple of M times the mode, as point loads on all nodes, so that no other mode moves.
    """
    beam = meshes.beam(length=1.0, height=0.05, along=20)
    probe = ElasticStructure(beam, material=aluminium, time_step=1.0)
    own = 2 * np.pi * probe.frequencies(1)[0]
    probe.release_from_mode(1, 1.0)
    mode = probe.fields().point_data["displacement"]
    push = probe._body.nodes.gather(probe._body.weigh(probe._body.nodes.share(mode)))
    errors, span = [], 6.3 * 2 * np.pi / own
    for steps in (504, 1008, 2016):  # 80 to 320 per period
        drive = Sine(frequency=detuning * own / (2 * np.pi))
        loads = [
            PointLoad(point=tuple(place), force=tuple(force), schedule=drive)
            for place, force in zip(beam.points, push, strict=True)
        ]
        body = ElasticStructure(beam, material=aluminium, time_step=span / steps, loads=loads)
        for _ in range(steps):
            body.advance(np.zeros_like(beam.outer_polyline.points))
        moved, node = body.fields().point_data["displacement"], np.argmax(np.abs(mode[:, 1]))
        w = detuning * own
        exact = math.sin(w * span) - detuning * math.sin(own * span)
        errors.append(moved[node, 1] / mode[node, 1] * (own**2 - w**2) - exact)
    rates = np.log2(np.abs(np.array(errors[:-1]) / errors[1:]))
    np.testing.assert_allclose(rates, 2.0, atol=0.1)
    # The steps lengthen the own period by (w0 dt)^2/12 of itself, which shifts its phase over 6.3 periods and
    # changes w0^2 - w^2 by twice as much.
    late = (2 * np.pi / 320) ** 2 / 12
    assert abs(errors[-1]) < late * (6.3 * 2 * np.pi + 2 * 2 / (1 - detuning**2))


def test_constant_loads_are_not_looked_at_again(soft: PlaneStrain) -> None:
    beam = meshes.beam(length=1.0, height=0.1, along=4, across=1)
    asked = []

    class Counted(Ramp):
        def factor(self, time: float) -> float:
            asked.append(time)
            return super().factor(time)

    load = BodyForce(acceleration=(0.0, -1.0), schedule=Counted(over=2.5))
    body = ElasticStructure(beam, material=soft, time_step=1.0, loads=[load])
    for _ in range(10):
        body.advance(np.zeros_like(beam.outer_polyline.points))
    assert asked == [0.0, 1.0, 2.0, 3.0]
