"""Normal impacts, benchmarks 1 to 3 of Chung and Ooi (2011): force, time and depth in closed form, and restitution."""

import math
from dataclasses import replace

import numpy as np
import pytest
from impact_benchmarks import (
    COPPER,
    ELASTIC_PAIRS,
    ELASTIC_PLANES,
    IRON,
    KINDS,
    NYLON,
    OXIDE,
    Benchmark,
    Kind,
)
from impact_runs import compare, errors, fall_time, force_curve, orders, run
from impacts import Body, Impact, Springs, damping_ratio

ELASTIC = [*ELASTIC_PAIRS, *ELASTIC_PLANES]
NAMES = [benchmark.stuff.name for benchmark in ELASTIC]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("benchmark_case", ELASTIC, ids=NAMES)
def test_elastic_force_follows_the_closed_form(benchmark_case: Benchmark, kind: Kind) -> None:
    steps = 400
    impact = benchmark_case.impacts(kind)[0]
    law, speed = impact.springs, benchmark_case.speed
    deep, lasting = law.deepest(impact.mass, speed), law.duration(impact.mass, speed)
    time, overlap, force = force_curve(benchmark_case, kind, steps)
    # Of second order in omega dt = pi/steps, with a phase error that a part of pi adds up to.
    close = (math.pi / steps) ** 2
    touching = overlap > 0.0
    # Round-off of the positions in the overlap, and E* and R from the materials.
    expected = law.k * np.maximum(overlap, 0.0) ** law.power
    assert np.abs(force - expected).max() < 1e-9 * force.max()
    assert overlap.max() == pytest.approx(deep, rel=close)
    loading = touching & (time < 0.48 * lasting)
    assert np.abs(fall_time(law, impact.mass, speed, overlap[loading]) - time[loading]).max() < close * lasting
    if kind == "linear":
        sine = law.k * deep * np.sin(math.pi * time[touching] / lasting)
        assert np.abs(force[touching] - sine).max() < 2.0 * close * law.k * deep
    end = time[-1] + overlap[-1] / speed  # flying apart at the speed of the impact
    assert end == pytest.approx(lasting, rel=close)


@pytest.mark.parametrize("kind", KINDS)
def test_reference_has_the_closed_forms(kind: Kind) -> None:
    # The tolerance of the ODE solution, over some hundred steps.
    for benchmark in ELASTIC:
        impact = benchmark.impacts(kind)[0]
        found = impact.solve()
        assert found.duration == pytest.approx(impact.springs.duration(impact.mass, benchmark.speed), rel=1e-9)
        assert found.overlap == pytest.approx(impact.springs.deepest(impact.mass, benchmark.speed), rel=1e-9)
        assert found.v_n == pytest.approx(benchmark.speed, rel=1e-9)
    assert Springs(k=1.0, power=1.5).duration(1.0, 1.0) == pytest.approx(2.943 * 1.25**0.4, rel=2e-4)  # the known 2.94


@pytest.mark.parametrize("kind", KINDS)
def test_elastic_rebound_is_of_order_two(kind: Kind) -> None:
    found = errors(ELASTIC_PAIRS[0], kind, ELASTIC_PAIRS[0].impacts(kind), (50, 100, 200, 400))
    if kind == "linear":
        assert orders(found) == pytest.approx(np.full(3, 2.0), abs=0.1)
    else:  # the leapfrog keeps an energy of its own, and Hertz's force begins softer than with a kink
        assert (orders(found) > 2.0).all()
    assert found[-1] < (math.pi / 400) ** 2


@pytest.mark.parametrize("may_pull", [False, True])
@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.9])
def test_hertz_in_continuous_time_keeps_the_linear_damping_ratio(restitution: float, may_pull: bool) -> None:
    # The claim that zero force of one law is zero force of the other, at any speed: tolerance of two ODE solutions.
    zeta = damping_ratio(restitution, may_pull=may_pull)
    springs = Springs(k=3e10, power=1.5, zeta=zeta, may_pull=may_pull)
    for speed in (0.039, 3.9, 39.0):
        found = Impact(first=Body(radius=0.1, mass=2.0), second=None, springs=springs, v_n=-speed).solve()
        assert found.v_n / speed == pytest.approx(restitution, abs=1e-8)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("may_pull", [False, True])
@pytest.mark.parametrize("wall", [True, False], ids=["plane", "pair"])
def test_rebound_has_the_restitution_asked_for(wall: bool, may_pull: bool, kind: Kind) -> None:
    steps = 2000
    for restitution in (0.2, 0.4, 0.6, 0.8, 1.0):
        other = {} if wall else {"other": NYLON, "other_radius": 0.005}
        benchmark = Benchmark(
            stuff=OXIDE if wall else IRON, radius=0.0025, speed=3.9, restitution=restitution, may_pull=may_pull, **other
        )
        impacts = benchmark.impacts(kind) * 4
        _, ours, _ = compare(benchmark, kind, impacts, steps)
        # The dashpot takes a velocity half a step old and ends anywhere within a step: one step of its force,
        # 2 zeta omega_0 dt with omega_0 dt = pi/steps. Elastic: of second order.
        lag = 2.0 * damping_ratio(restitution, may_pull=may_pull) * math.pi / steps
        assert np.abs(ours[:, 0] / benchmark.speed - restitution).max() < lag + (math.pi / steps) ** 2


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("restitution", [0.2, 0.8])
def test_restitution_is_exact_in_the_limit_and_the_same_at_any_speed(restitution: float, kind: Kind) -> None:
    # Without tension the lag of the dashpot is smooth in dt: extrapolated to dt = 0 the rest is of second order.
    base = Benchmark(stuff=COPPER, radius=0.1, speed=2.0, restitution=restitution)
    for speed in (0.02, 2.0):
        benchmark = replace(base, speed=speed)
        impacts = [replace(impact, v_n=-speed) for impact in base.impacts(kind) * 4]
        law = impacts[0].springs
        found = []
        for steps in (500, 1000):
            dt = law.duration(impacts[0].mass, speed) / steps
            found.append(run(impacts, base.contact(kind), dt, 4.0 * steps * dt)[:, 0] / benchmark.speed)
        assert np.abs(2.0 * found[1] - found[0] - restitution).max() < 2.0 * (math.pi / 500) ** 2
