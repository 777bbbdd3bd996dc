"""A beam at rest on a row of fixed grains (G 3.4) against an independent plane-strain solution.

A fixed grain exactly below each of 121 places of the lower face makes one Hooke spring with a Coulomb
spring sideways, whichever the interface and the exchange. At rest the only differences from the
independent solution on the same mesh are second order in displacement/diameter (1e-5 here), see
`independent_beam`.
"""

import numpy as np
import pytest
from independent_beam import IndependentBeam, Rest
from small_models import on_row
from ways import GLUED, WAYS, Way

from coupled.build import build
from coupled.model import Model
from coupled.scene import load_scene

LENGTH, HEIGHT, ALONG, ACROSS = 1.0, 0.05, 40, 2
YOUNG, POISSON, K_N, K_T, FRICTION, RADIUS = 70e9, 0.35, 1.97e7, 9.86e5, 0.8, 4.1e-3
SPRINGS = np.linspace(0.0, LENGTH, 121)
TOTAL, RAMP, WINDOW = 1.2e5, 0.04, 2e-5
# Dashpots that bring the beam to rest ten times as fast as the source's: bouncing dies as exp(-670 t),
# sliding on the tangential springs as exp(-450 t): 2e-8 over 0.04 s.
SETTLED, DASHPOTS, MATERIAL_DAMPING = 0.08, {"normal_damping": 1500.0, "tangential_damping": 1000.0}, 3e-4
LEFT_HALF = np.arange(ALONG // 2 + 1)
HALF_SHARES = np.where((LEFT_HALF == 0) | (LEFT_HALF == ALONG // 2), 0.5, 1.0) / (ALONG // 2)
NO_ROLLING = {"rolling_friction": 0.0}  # facets turn with the beam, and the independent springs know no moments
WHOLE = [way for way in WAYS if "substeps" not in way.exchange]
Load = dict[str, object]


def settled(
    way: Way, loads: list[Load], *, springs: np.ndarray = SPRINGS, per_facet: int = 3, duration: float = SETTLED
) -> Model:
    """The beam of `winkler_beam` under other loads, met in one of the `ways`, after `duration` [s] at rest."""
    table = load_scene("winkler_beam").model_dump(exclude_none=True)
    ramped = [load | {"schedule": {"kind": "ramp", "over": RAMP}} for load in loads]
    damped = {"rayleigh": {"stiffness_factor": MATERIAL_DAMPING}, "loads": ramped}
    model = on_row(
        way,
        window=WINDOW,
        structure=table["structure"] | damped,
        contact=table["contact"] | DASHPOTS | NO_ROLLING,
        rows=[springs],
        radius=RADIUS,
        per_facet=per_facet,
    )
    model.advance(round(duration / WINDOW))
    return model


def uniform(total: float) -> Load:
    return {"kind": "boundary", "boundary": "top", "total_force": (0.0, -total)}


def point(x: float, force: float) -> Load:
    return {"kind": "point", "point": (x - LENGTH / 2, HEIGHT / 2), "force": (0.0, -force)}


def left_half(total: float) -> list[Load]:
    """A load on half of the upper face, as the forces that a uniform one puts on its nodes."""
    return [point(column * LENGTH / ALONG, total * share) for column, share in zip(LEFT_HALF, HALF_SHARES)]


def beam(refined: int = 1) -> IndependentBeam:
    return IndependentBeam(
        length=LENGTH, height=HEIGHT, along=ALONG * refined, across=ACROSS * refined, young=YOUNG, poisson=POISSON
    )


def rest(own: IndependentBeam, load: np.ndarray, way: Way = GLUED) -> Rest:
    kind = {"between": 2 * RADIUS} if way.interface == "glued" else {"between": np.inf, "below_facets": RADIUS}
    return own.rest(load, SPRINGS, normal=K_N, tangential=K_T, friction=FRICTION, **kind)


def neutral_axis(model: Model) -> np.ndarray:
    """Deflection (41,) [m] of the middle row of nodes, from left to right."""
    fields = model.structure.fields()
    x, y = fields.points.T
    row = np.nonzero(np.isclose(y, y.mean()))[0]
    return fields.point_data["displacement"][row[np.argsort(x[row])], 1]


def assert_agree(model: Model, expected: Rest, own: IndependentBeam, *, tolerance: float) -> None:
    """Normal forces over the largest, shear forces over the largest, neutral axis over its range."""
    force, deflection = model.contact_force, own.middle(expected.displacement)
    assert np.abs(force[:, 1] - expected.push).max() <= tolerance * expected.push.max()
    assert np.abs(neutral_axis(model) - deflection).max() <= tolerance * np.ptp(deflection)
    # A thousand times smaller than the normal forces: the tangential spring sees the terms of
    # second order that the independent one drops. A slider at the edge of the contact keeps its
    # smallest limit of the way: bounded, not compared, and the others hold what it does not.
    slips, largest = expected.slips, np.abs(expected.shear).max()
    undetermined = FRICTION * expected.push[slips].sum()
    assert np.abs((force[:, 0] - expected.shear)[~slips]).max() <= 1e-3 * largest + undetermined
    assert np.all(np.abs(force[:, 0]) <= FRICTION * force[:, 1] + 1e-12 * largest)


@pytest.fixture(scope="module")
def under_uniform_load() -> Model:
    return settled(GLUED, [uniform(TOTAL)])


@pytest.mark.parametrize("way", WAYS, ids=str)
def test_uniform_load_equals_the_independent_solution(way: Way) -> None:
    own = beam()
    assert_agree(settled(way, [uniform(TOTAL)]), rest(own, own.uniform(-TOTAL), way), own, tolerance=1e-5)


@pytest.mark.parametrize("way", WHOLE, ids=str)
def test_central_load_equals_the_independent_solution(way: Way) -> None:
    """Held down by a uniform load, so that no spring opens."""
    central = 1.2e4
    model, own = settled(way, [uniform(TOTAL), point(LENGTH / 2, central)]), beam()
    assert_agree(model, rest(own, own.uniform(-TOTAL) + own.on_top(20, -central), way), own, tolerance=1e-5)


@pytest.mark.parametrize("way", WHOLE, ids=str)
def test_half_length_load_equals_the_independent_solution(way: Way) -> None:
    half = 2e4
    model, own = settled(way, [uniform(TOTAL), *left_half(half)]), beam()
    load = own.uniform(-TOTAL) + own.on_top(LEFT_HALF, -half * HALF_SHARES)
    assert_agree(model, rest(own, load, way), own, tolerance=1e-5)


@pytest.mark.parametrize("case", ["central", "half"])
@pytest.mark.parametrize("way", WAYS, ids=str)
def test_beam_lifts_off_where_the_independent_one_does(way: Way, case: str) -> None:
    own, total = beam(), 6e4
    if case == "central":
        model, load = settled(way, [point(LENGTH / 2, total)], duration=0.12), own.on_top(20, -total)
    else:
        model, load = settled(way, left_half(total), duration=0.12), own.on_top(LEFT_HALF, -total * HALF_SHARES)
    expected = rest(own, load, way)
    closed = model.contact_force[:, 1] > 0
    assert 40 < closed.sum() < 100
    assert np.array_equal(closed, expected.push > 0)
    assert expected.slips.sum() <= 2  # the last spring at each edge of the contact
    # 3e-5 is left because of their shear, which depends on how the load came.
    assert_agree(model, expected, own, tolerance=1e-4)


def test_uniform_load_bends_the_beam_as_in_the_source(under_uniform_load: Model) -> None:
    """G figures 3.21 to 3.25: full springs on half tributary lengths hold the ends up."""
    model = under_uniform_load
    axis, force = neutral_axis(model), model.contact_force[:, 1]
    assert np.all(np.diff(axis[:21]) < 0)  # concave upwards: the middle lowest, the ends highest
    assert np.abs(axis - axis[::-1]).max() < 1e-9 * np.ptp(axis) + 1e-16
    assert 1.0 < force[60] / force.mean() < 1.02  # slightly larger in the middle
    stress = model.structure.fields()
    middle = np.isclose(stress.points[:, 0], LENGTH / 2)
    by_height = np.argsort(stress.points[middle, 1])
    bottom, _, top = stress.point_data["sigma_xx"][middle][by_height]
    assert bottom > 0 > top  # tension below, compression above
    nodal = model.nodal_force[: ALONG + 1, 1]
    # Three springs share an inner node, two an end node.
    assert np.ptp(nodal[1:-1]) < 0.05 * nodal[1:-1].mean()
    assert nodal[0] / nodal[1] == pytest.approx(2 / 3, rel=0.01)
    assert model.reaction[1] == pytest.approx(TOTAL, rel=1e-7)


def test_mesh_error_of_the_spring_forces_is_small(under_uniform_load: Model) -> None:
    """Against 240 x 12 cells: 0.23 % in force, 4 % in the bow (bilinear cells are stiff in bending)."""
    fine = beam(refined=6)
    expected = rest(fine, fine.uniform(-TOTAL))
    error = np.abs(under_uniform_load.contact_force[:, 1] - expected.push).max() / expected.push.max()
    assert error < 0.004
    bow, fine_bow = np.ptp(neutral_axis(under_uniform_load)), np.ptp(fine.middle(expected.displacement))
    assert bow == pytest.approx(fine_bow, rel=0.06) and bow < fine_bow


def test_central_load_bends_as_beam_theory_says(under_uniform_load: Model) -> None:
    """Euler and Bernoulli on a continuous foundation (Hetenyi): the deflection below the load."""
    central = 1.2e4
    model = settled(GLUED, [uniform(TOTAL), point(LENGTH / 2, central)])
    foundation, bending = K_N * ALONG * 3 / LENGTH, YOUNG / (1 - POISSON**2) * HEIGHT**3 / 12
    decay = (foundation / (4 * bending)) ** 0.25
    span = decay * LENGTH
    shape = (np.cosh(span) + np.cos(span) + 2) / (np.sinh(span) + np.sin(span))
    deflection = central * decay / (2 * foundation) * shape
    seen = (neutral_axis(under_uniform_load) - neutral_axis(model))[20]
    # Left out: stiff cells (0.96), shear (height * decay = 0.26) and the squeeze below the load.
    assert seen == pytest.approx(deflection, rel=0.10)


def test_contact_length_does_not_depend_on_the_load() -> None:
    """A receding contact: without an initial gap everything is proportional to the load."""
    small, large = (settled(GLUED, [point(LENGTH / 2, force)]) for force in (3e3, 6e4))
    assert np.array_equal(small.contact_force[:, 1] > 0, large.contact_force[:, 1] > 0)
    difference = 20 * small.contact_force[:, 1] - large.contact_force[:, 1]
    # Not proportional: the tilt of compressed pairs, overlap/diameter = 1 %, on the shear forces.
    assert np.abs(difference).max() < 1e-3 * large.contact_force[:, 1].max()


def test_springs_of_equal_tributary_length_do_not_bend_the_beam(under_uniform_load: Model) -> None:
    """One spring in the middle of each facet: the nodal forces are those of a uniform pressure."""
    middles = (np.arange(ALONG) + 0.5) * LENGTH / ALONG
    model = settled(GLUED, [uniform(TOTAL)], springs=middles, per_facet=2)
    closed = model.contact_force[:, 1] > 0
    assert closed.sum() == ALONG
    pushes = model.contact_force[closed, 1]
    assert np.ptp(pushes) < 1e-3 * pushes.mean()
    # What is left is Poisson's stretch against the tangential springs on the lower face.
    assert np.ptp(neutral_axis(model)) < 0.01 * np.ptp(neutral_axis(under_uniform_load))


def test_shipped_scene_comes_to_the_same_rest(under_uniform_load: Model) -> None:
    """`winkler_beam` as it is, with a row `under` its glued grains and the source's damping."""
    quick = ["structure.loads.0.schedule.over=0.25", "time.step=4e-5"]
    model = build(load_scene("winkler_beam", quick)).model
    model.advance(round(0.5 / model.window))  # bouncing dies as exp(-70 t): 3e-8 over 0.25 s
    seen, expected = model.contact_force, under_uniform_load.contact_force
    assert np.abs(seen - expected)[:, 1].max() < 1e-6 * expected.max()
    assert np.abs(seen - expected)[:, 0].max() < 1e-3 * np.abs(expected[:, 0]).max()  # as in `assert_agree`
