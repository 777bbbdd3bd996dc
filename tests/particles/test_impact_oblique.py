"""Impacts on a plane with friction, benchmarks 4 to 6 of Chung and Ooi (2011): reference solution, limits of theory."""

import math
from dataclasses import replace

import numpy as np
import pytest
from impact_benchmarks import ALUMINIUM, AT_ANGLES, KINDS, POLYETHYLENE, SIDEWAYS, SPINNING, Benchmark, Kind
from impact_runs import compare, deviation, errors, orders, run
from impacts import Impact, Springs
from numpy.typing import NDArray

from particles import ContactModel, CoulombFriction, LinearSpringDashpot, MindlinFriction

Floats = NDArray[np.float64]
STEPS = 2000
ANGLES = np.radians([5.0, 25.0, 45.0, 70.0])
BALL, SPINNER = AT_ANGLES[0], SPINNING[0]
STEEL_BALL, SOFT_BALL = SIDEWAYS
SHALLOW = Benchmark(stuff=ALUMINIUM, radius=0.1, speed=2e-4, mu=0.3)  # overlaps 2e-6 of the radius: arms are radii


@pytest.mark.parametrize("kind", KINDS)
def test_oblique_impacts_agree_with_the_reference(kind: Kind) -> None:
    # Of first order in dt (dashpot half a step late, Mindlin's stiffness of the end of the step): less than the
    # change within one step of the contact.
    cases = [
        (BALL, BALL.at_angles(kind, ANGLES)),
        (STEEL_BALL, STEEL_BALL.impacts(kind, u_t=[0.5, 3.0, 8.0, 20.0])),
        (SOFT_BALL, SOFT_BALL.impacts(kind, u_t=[0.5, 3.0, 8.0, 20.0])),
        (SPINNER, SPINNER.impacts(kind, spin=[0.5, 2.0, 5.0, 20.0])),
    ]  # fmt: skip
    for benchmark, impacts in cases:
        _, _, off = compare(benchmark, kind, impacts, STEPS)
        assert off.max() < 1.0 / STEPS


@pytest.mark.parametrize(
    ("kind", "restitution", "order"),
    [("linear", 1.0, 2.0), ("linear", 0.5, 1.0), ("hertz", 1.0, 1.45), ("hertz", 0.5, 1.0)],
)
def test_order_in_the_time_step(kind: Kind, restitution: float, order: float) -> None:
    # Without dashpots the linear springs follow the displacements themselves: order 2, but for the lever arms,
    # which are those of the end of the step (1/10^6 here). A dashpot acts half a step late: order 1. Mindlin's
    # spring takes the mean stiffness of the step, which grows as the root of the overlap: order 3/2 at most.
    # Sticking, then both, then sliding alone.
    benchmark = replace(SHALLOW, restitution=restitution)
    impacts = benchmark.impacts(kind, u_t=SHALLOW.speed * np.array([0.2, 0.6, 1.0, 1.2, 1.4, 3.0]))
    assert orders(errors(benchmark, kind, impacts, (200, 400, 800, 1600))) == pytest.approx(np.full(3, order), abs=0.1)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_gross_sliding_is_that_of_rigid_bodies(restitution: float, kind: Kind) -> None:
    # Impulses J and mu J with J = m (1 + e) v: the disc loses mu (1 + e) v and gains the spin 2 mu (1 + e) v / r.
    benchmark = replace(SPINNER, restitution=restitution)
    push = benchmark.mu * (1.0 + restitution) * benchmark.speed
    u_t = push * np.array([3.5, 5.0, 20.0])
    impacts = benchmark.impacts(kind, u_t=u_t)
    _, ours, _ = compare(benchmark, kind, impacts, STEPS)
    law = impacts[0].springs
    late = 2.0 * late_sliding(law, u_t, benchmark.speed, restitution)
    shorter = law.deepest(impacts[0].mass, benchmark.speed) / benchmark.radius  # lever arms are r - delta/2
    lost, won = u_t + ours[:, 1], -ours[:, 2] * benchmark.radius
    assert (np.abs(lost / push - 1.0) < 1.0 / STEPS + late).all()
    assert (np.abs(won / (2.0 * push) - 1.0) < 1.0 / STEPS + shorter + late).all()


def late_sliding(law: Springs, v_t: Floats, speed: float, restitution: float) -> Floats:
    """Part of the friction that is missing because the tangential spring must first be stretched to the limit.

    With a dashpot the limit begins at mu c v, c = 2 zeta sqrt(m k_n); the spring gets there in t = mu c v/(k_t v_t),
    with mu c v t/2 missing of mu m (1 + e) v. The limit moves meanwhile, so that this is an estimate.
    """
    return 2.0 * law.zeta**2 * law.mu / law.ratio * speed / (v_t * (1.0 + restitution))


@pytest.mark.parametrize("softness", [0.5, 1.24, 10.0 / 3.0])
def test_sliding_ends_where_the_springs_say(softness: float) -> None:
    # Elastic linear springs, k_n/k_t = softness: the spring, at its limit mu k_n delta, is held when
    # k_t v_t < -mu k_n v_n, with v_t = v_t0 - 3 mu (v_n + v) while sliding and -v < v_n < v. So it slides throughout
    # above v_t0/(mu v) = max(6 - softness, softness), 3 (1 + e) = 6 for rigid bodies (7 for spheres).
    law = SHALLOW.springs("linear")
    contact = ContactModel(
        normal=LinearSpringDashpot(stiffness=law.k, restitution=1.0),
        tangential=CoulombFriction(stiffness=law.k / softness, friction=SHALLOW.mu),
    )
    limit = max(6.0 - softness, softness) * SHALLOW.mu * SHALLOW.speed
    shares = np.array([0.9, 0.97, 1.03, 1.1])
    springs = replace(law, ratio=1.0 / softness)
    impacts = [replace(i, springs=springs) for i in SHALLOW.impacts("linear", u_t=limit * shares)]
    dt = law.duration(impacts[0].mass, SHALLOW.speed) / STEPS
    ours = run(impacts, contact, dt, 1.1 * STEPS * dt)
    sliding = limit * shares - 2.0 * SHALLOW.mu * SHALLOW.speed
    # Order 2 in omega dt where it slides; where it is held, it loses less by far more than that.
    assert np.abs(-ours[:, 1] - sliding)[2:].max() < 5.0 * (math.pi / STEPS) ** 2 * limit
    assert (np.abs(-ours[:, 1] - sliding)[:2] > 1e-4 * limit).all()
    held = ["stick" in impact.solve().modes for impact in impacts]
    assert held == [True, True, False, False]


def test_stiff_damped_tangential_springs_give_rigid_bodies() -> None:
    # Below tan(theta) = 3 mu (1 + e) the disc leaves rolling, v_x = 2/3 of the first (5/7 of a sphere), above it
    # sliding. 1/400 is the softness k_n/k_t; the dashpot is critical for the mass m/3 of the surface.
    ratio, e = 400.0, 0.5
    benchmark = replace(SHALLOW, restitution=e)
    law = benchmark.springs("linear")
    mass = benchmark.bodies[0].mass
    contact = ContactModel(
        normal=LinearSpringDashpot(stiffness=law.k, restitution=e),
        tangential=CoulombFriction(
            stiffness=ratio * law.k, friction=benchmark.mu, damping=2.0 * math.sqrt(mass / 3.0 * ratio * law.k)
        ),
    )
    push = benchmark.mu * (1.0 + e) * benchmark.speed
    u_t = push * np.array([0.5, 2.0, 2.8, 3.2, 6.0])
    dt = law.duration(mass, benchmark.speed) / (20 * STEPS)
    ours = run(benchmark.impacts("linear", u_t=u_t), contact, dt, 30 * STEPS * dt)
    rigid = np.where(u_t < 3.0 * push, 2.0 / 3.0 * u_t, u_t - push)
    # The surface may still move by what the spring lets go when the limit falls below it, of order mu v k_n/k_t.
    assert -ours[:, 1] == pytest.approx(rigid, abs=2.0 * push / ratio)
    assert -ours[:, 2] * benchmark.radius == pytest.approx(2.0 * (u_t - rigid), abs=4.0 * push / ratio)


def test_tangential_dashpot_agrees_with_the_reference() -> None:
    # A tenth of the critical dashpot: stick with it, capped at the limit, slip without it.
    law = SPINNER.springs("linear")
    mass = SPINNER.bodies[0].mass
    c_t = 0.2 * math.sqrt(mass / 3.0 * law.ratio * law.k)
    impacts = SPINNER.impacts("linear", spin=[0.5, 2.0, 4.0, 8.0, 20.0])
    impacts = [replace(i, springs=replace(law, c_t=c_t)) for i in impacts]
    contact = ContactModel(
        normal=LinearSpringDashpot(stiffness=law.k, restitution=SPINNER.restitution),
        tangential=CoulombFriction(stiffness=law.ratio * law.k, friction=SPINNER.mu, damping=c_t),
    )
    found = [impact.solve() for impact in impacts]
    assert {mode for rebound in found for mode in rebound.modes} == {"stick", "capped", "slip"}
    dt = law.duration(mass, SPINNER.speed) / STEPS
    ours = run(impacts, contact, dt, 1.05 * max(rebound.duration for rebound in found))
    assert deviation(impacts, np.array([rebound.numbers() for rebound in found]), ours).max() < 1.0 / STEPS


def test_without_slip_the_surface_swings() -> None:
    # Elastic, no limit: v_t turns at the frequency sqrt(3 k_t/m) for half a period of sqrt(k_n/m), and what the
    # spring holds at the end is lost. The disc takes 1/3 of the change of v_t, its spin 2/3.
    sticky = replace(SHALLOW, mu=1e9)
    ratio = sticky.springs("linear").ratio
    u_t = SHALLOW.speed * np.array([0.3, 3.0])
    _, ours, _ = compare(sticky, "linear", sticky.impacts("linear", u_t=u_t), STEPS)
    change = u_t * (1.0 - math.cos(math.pi * math.sqrt(3.0 * ratio)))
    depth = sticky.springs("linear").deepest(sticky.bodies[0].mass, sticky.speed) / sticky.radius
    close = math.pi / STEPS + depth  # the force ends with a jump, somewhere in a step: order 1; and the lever arms
    assert -ours[:, 1] == pytest.approx(u_t - change / 3.0, rel=close)
    assert -ours[:, 2] * sticky.radius == pytest.approx(2.0 / 3.0 * change, rel=close)


def test_mindlin_on_a_linear_spring_is_a_constant_stiffness() -> None:
    impacts = SPINNER.impacts("linear", spin=[0.5, 2.0, 5.0, 20.0])
    law = impacts[0].springs
    dt = law.duration(impacts[0].mass, SPINNER.speed) / 200
    normal = LinearSpringDashpot(stiffness=law.k, restitution=SPINNER.restitution)
    laws = (
        CoulombFriction(stiffness=law.ratio * law.k, friction=SPINNER.mu),
        MindlinFriction(stiffness_ratio=law.ratio, friction=SPINNER.mu),
    )
    first, second = (run(impacts, ContactModel(normal=normal, tangential=t), dt, 300 * dt) for t in laws)
    assert np.abs(first - second).max() < 1e-12 * np.abs(first).max()  # the product is formed at another place


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("mu", [0.3, 1e9])
def test_elastic_friction_never_returns_more_than_it_took(mu: float, kind: Kind) -> None:
    # No dashpots: what friction and the letting go of a loaded spring take may be little, but has one sign. The
    # integrator's own error in the energy of a contact of 100 steps, (pi/100)^2 / 4 for a kink anywhere in a step.
    for other in ({}, {"other": POLYETHYLENE, "other_radius": 0.005}):
        benchmark = Benchmark(stuff=ALUMINIUM, radius=0.01, speed=0.5, mu=mu, **other)
        u_t = np.tile(np.linspace(-3.0, 3.0, 25), 3) * benchmark.speed
        spin = np.repeat([0.0, -1.0, 2.5], 25) * benchmark.speed / benchmark.radius
        impacts = benchmark.impacts(kind, u_t=u_t, spin=spin, partner=0.7 * spin if other else 0.0)
        dt = impacts[0].springs.duration(impacts[0].mass, benchmark.speed) / 100
        ours = run(impacts, benchmark.contact(kind), dt, 120 * dt)
        before = np.array([(i.v_n, i.u_t, *i.spins) for i in impacts])
        gain = kinetic(impacts[0], ours) / kinetic(impacts[0], before) - 1.0
        assert gain.max() < 0.25 * (math.pi / 100) ** 2
        assert gain.min() < -0.01
        after = np.array([impact.solve().numbers() for impact in impacts])
        assert (kinetic(impacts[0], after) <= kinetic(impacts[0], before) * (1.0 + 1e-9)).all()


@pytest.mark.parametrize("ratio", [0.27, 1.1, 2.5])
def test_mindlin_gains_nothing_where_a_spring_that_keeps_its_force_would(ratio: float) -> None:
    # Where f = int k_t v_t dt is kept while k_t falls, the surface leaves at 1.04 to 1.05 times the speed it came with
    # (the equations f' = k_t v_t, v_t' = -3 f/m over Hertz's contact time, solved apart). Letting go forbids it.
    sticky = replace(SHALLOW, mu=1e9)
    law = replace(sticky.springs("hertz"), ratio=ratio)
    impacts = [replace(i, springs=law) for i in sticky.impacts("hertz", u_t=SHALLOW.speed * np.array([0.3, 3.0, 30.0]))]
    dt = law.duration(impacts[0].mass, sticky.speed) / STEPS
    contact = ContactModel(
        normal=sticky.contact("hertz").normal, tangential=MindlinFriction(stiffness_ratio=ratio, friction=1e9)
    )
    ours = run(impacts, contact, dt, 1.05 * STEPS * dt)
    surface = ours[:, 1] - ours[:, 2] * sticky.radius
    assert (np.abs(surface) < 0.9 * np.array([abs(i.u_t) for i in impacts])).all()
    reference = np.array([impact.solve().numbers() for impact in impacts])
    # order 1 with the stiffness of the end of the step; stiffer springs turn faster by sqrt(ratio)
    assert deviation(impacts, reference, ours).max() < (1.0 + ratio) / STEPS


def kinetic(impact: Impact, rows: Floats) -> Floats:
    """Energy of the motion about the common centre of mass [J]."""
    spins = [b.inertia if b else 0.0 for b in (impact.first, impact.second)]
    return 0.5 * (impact.mass * (rows[:, 0] ** 2 + rows[:, 1] ** 2) + rows[:, 2:] ** 2 @ spins)
