"""Contact laws asked for in a scene file: numbers in, physics out."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from coupled.build import Built, build
from coupled.report.contact import contact_numbers, contact_rows
from coupled.output import checkpoint
from coupled.running.run import run_scene
from coupled.scene import load_scene
from coupled.templates import write_template
from particles import ContactModel, ContactTable

SPEED, SPIN, RADIUS, DENSITY = 0.01, 100.0, 0.01, 1600.0  # m/s, rad/s, m, kg/m3
MASS = math.pi * RADIUS**2 * DENSITY

ONE_DISC = f"""
title = "a disc hits the floor"
time = {{ duration = 1.0, step = 1e-6 }}
box = {{ width = 1.0, height = 1.0, walls = ["left", "floor"] }}
grains = {{ sizes = [{{ radius = {RADIUS}, count = 1 }}], density = {DENSITY}, layout = "list", positions = [[0.5, {RADIUS + 1e-6}, 0.0, {-SPEED}]] }}
"""


def built(text: str, folder: Path, sets: tuple[str, ...] = ()) -> Built:
    path = folder / "scene.toml"
    path.write_text(text)
    return build(load_scene(path, sets))


def velocities(scene: Built) -> NDArray[np.float64]:
    """Of the free grains (n, 2) [m/s], in the order of the scene."""
    grains = scene.model.particles.grains
    order = np.argsort(grains.number[: grains.n_free])
    return np.column_stack([grains.vx, grains.vy])[order]


# -- restitution ------------------------------------------------------------------------------

LINEAR = '[contact]\nnormal_stiffness = 1e6\nrestitution = {e}\nrestitution_at = "{end}"'
HERTZ = '[contact]\nnormal = "hertz"\nhertz_stiffness = 1e8\nrestitution = {e}\nrestitution_at = "{end}"'
MODULI = HERTZ.replace("hertz_stiffness = 1e8", "youngs_modulus = 1e9\npoissons_ratio = 0.3")
RECIPE = f'[contact.recipe]\nfrom_impact_speed = {SPEED}\nmax_overlap = 1e-3\nrestitution = {{e}}\nrestitution_at = "{{end}}"'


@pytest.mark.parametrize("end", ["zero_force", "zero_overlap"])
@pytest.mark.parametrize("restitution", [0.2, 0.8])
@pytest.mark.parametrize("law", [LINEAR, HERTZ, MODULI, RECIPE], ids=["linear", "hertz", "moduli", "recipe"])
def test_every_contact_rebounds_with_the_restitution_asked_for(
    law: str, restitution: float, end: str, tmp_path: Path
) -> None:
    """At the floor, between a disc and one of an eighth of its mass, and on a fixed grain."""
    text = f"""
title = "three impacts"
time = {{ duration = 1.0, step = 5e-7 }}
box = {{ width = 1.0, height = 1.0 }}
rows = [{{ start = [0.3, 0.1], end = [0.3, 0.1], count = 1, radius = {RADIUS} }}]

[grains]
sizes = [{{ radius = {RADIUS}, count = 3 }}, {{ radius = {RADIUS / math.sqrt(8)}, count = 1 }}]
density = {DENSITY}
layout = "list"
positions = [
    [0.1, {RADIUS + 1e-6}, 0.0, {-SPEED}],
    [0.3, {0.1 + 2 * RADIUS + 1e-6}, 0.0, {-SPEED}],
    [0.1, 0.3, {SPEED}, 0.0],
    [{0.1 + RADIUS * (1 + 1 / math.sqrt(8)) + 1e-6}, 0.3, 0.0, 0.0],
]

{law.format(e=restitution, end=end)}
"""
    scene = built(text, tmp_path)
    scene.model.advance(20_000)  # 10 ms; the slowest contact takes 3 ms
    assert scene.model.particles.look().count == 0
    after = velocities(scene)
    # the dashpot sees the velocity half a step late: first order in the step, which is 1/1000 of a contact or less
    assert after[0, 1] / SPEED == pytest.approx(restitution, abs=1e-3)
    assert after[1, 1] / SPEED == pytest.approx(restitution, abs=1e-3)
    assert (after[3, 0] - after[2, 0]) / SPEED == pytest.approx(restitution, abs=1e-3)


@pytest.mark.parametrize("wish", ["from_impact_speed = 2.0", f"from_drop_height = {2.0**2 / (2 * 9.81)}"])
def test_recipe_lets_the_smallest_grain_go_as_deep_as_it_may(wish: str, tmp_path: Path) -> None:
    """Energy: k_n delta^2/2 = m v^2/2; on the way down the weight adds g delta/v^2 = 1e-3 of it."""
    text = ONE_DISC.replace(str(-SPEED), "-2.0") + (
        f"gravity = [0.0, -9.81]\n[contact.recipe]\n{wish}\nmax_overlap = 0.04\nrestitution = 1.0"
    )
    scene = built(text, tmp_path)
    deepest = 0.0
    for _ in range(60):
        scene.model.advance(10)
        deepest = max(deepest, scene.model.particles.look().deepest)
    assert deepest == pytest.approx(0.04, rel=2e-3)


def test_recipe_tells_what_it_chose(tmp_path: Path) -> None:
    wish = (
        "[contact]\nfriction = 0.5\n[contact.recipe]\nfrom_impact_speed = 2.0\nmax_overlap = 0.04\nrestitution = 0.446"
    )
    scene = built(ONE_DISC + wish, tmp_path).scene
    numbers, stiffness = contact_numbers(scene), MASS * (2.0 / (0.04 * RADIUS)) ** 2
    assert numbers["contact_normal_stiffness"] == pytest.approx(stiffness, rel=1e-12)
    assert numbers["contact_tangential_stiffness"] == pytest.approx(stiffness / 20, rel=1e-12)
    assert (numbers["recipe_mass"], numbers["recipe_radius"]) == pytest.approx((MASS, RADIUS), rel=1e-12)
    # half a swing of the rotational mass I/r^2 = m/2 on the tangential spring leaves e of its speed
    ratio = numbers["contact_tangential_damping"] / (2 * math.sqrt(MASS / 2 * stiffness / 20))
    assert math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2)) == pytest.approx(0.446, rel=1e-12)
    told = {quantity: value for _, quantity, value in contact_rows(scene)}
    assert f"{stiffness:.4g} N/m" in told["recipe: normal stiffness"]
    assert f"{MASS:.4g} kg/m, radius 0.01 m" in told["recipe: for the smallest grain"]


# -- materials --------------------------------------------------------------------------------

SURFACES = f"""
title = "spinning discs fall on all kinds of surfaces"
time = {{ duration = 1.0, step = 2e-6 }}
box = {{ width = 1.0, height = 1.0, walls = ["left", "right", "floor", "lid"] }}
interface = {{ per_facet = 1, boundaries = ["top"], diameter = 8e-3 }}
rows = [
    {{ start = [0.2, 0.1], end = [0.2, 0.1], count = 1, radius = {RADIUS}, name = "kerb" }},
    {{ start = [0.3, 0.1], end = [0.3, 0.1], count = 1, radius = {RADIUS} }},
]

[grains]
sizes = [{{ radius = {RADIUS}, count = 7 }}]
density = {DENSITY}
layout = "list"
positions = [
    [0.1, {RADIUS + 1e-6}, 0.0, {-SPEED}, {SPIN}],
    [{RADIUS + 1e-6}, 0.5, {-SPEED}, 0.0, {SPIN}],
    [0.2, {0.1 + 2 * RADIUS + 1e-6}, 0.0, {-SPEED}, {SPIN}],
    [0.3, {0.1 + 2 * RADIUS + 1e-6}, 0.0, {-SPEED}, {SPIN}],
    [0.5, {0.105 + 4e-3 + RADIUS + 1e-6}, 0.0, {-SPEED}, {SPIN}],
    [0.1, 0.3, {SPEED}, 0.0, {SPIN}],
    [{0.1 + 2 * RADIUS + 2e-6}, 0.3, {-SPEED}, 0.0, {SPIN}],
]

[structure]
kind = "rigid"
beam = {{ length = 0.1, height = 0.01, along = 10, across = 1 }}
placement = {{ x = 0.5, y = 0.1 }}
path = {{ points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]] }}

[contact]
{{law}}
friction = 0.5

[[contact.pairs]]
between = ["floor", "grains"]
friction = 0.1
restitution = 0.9

[[contact.pairs]]
between = ["walls", "grains"]
friction = 0.2

[[contact.pairs]]
between = ["kerb", "grains"]
restitution = 0.4

[[contact.pairs]]
between = ["grains", "structure"]
friction = 0.3
restitution = 0.6

[[contact.pairs]]
between = ["grains", "lid"]
{{lid}}
"""
SLIDING = {  # friction and restitution of each disc's contact
    "floor, named itself": (0.1, 0.9),
    "left, one of the walls": (0.2, 0.8),
    "row with a name": (0.5, 0.4),
    "row without a name": (0.5, 0.8),
    "glued grain": (0.3, 0.6),
}


@pytest.mark.parametrize(
    ("law", "lid"),
    [
        (
            'normal_stiffness = 1e6\nrestitution = 0.8\ntangential_stiffness = 1e6\nrolling = "constant_torque"',
            "rolling_friction = 0.1",
        ),
        ('normal = "hertz"\nyoungs_modulus = 1e9\npoissons_ratio = 0.3\nrestitution = 0.8', "restitution = 0.1"),
    ],
    ids=["linear", "hertz"],
)
def test_materials_reach_every_kind_of_contact(law: str, lid: str, tmp_path: Path) -> None:
    """Gross sliding: a disc that never stops slipping takes the tangential impulse mu (1 + e) m v."""
    scene = built(SURFACES.replace("{law}", law).replace("{lid}", lid), tmp_path)
    assert isinstance(scene.contact, ContactTable)
    scene.model.advance(4_000)  # 8 ms; a contact takes 2
    assert scene.model.particles.look().count == 0
    after = velocities(scene) / SPEED
    normal = np.array([after[0, 1], after[1, 0], after[2, 1], after[3, 1], after[4, 1]])
    # counter-clockwise: the surface moves to the right on a floor and up on a left wall, seen from its right
    tangential = np.array([-after[0, 0], after[1, 1], -after[2, 0], -after[3, 0], -after[4, 0]])
    friction, restitution = np.array(list(SLIDING.values())).T
    # the disc moves sideways by 1e-3 of its radius while it touches, which turns the normal as much
    np.testing.assert_allclose(normal, restitution, atol=3e-3)
    np.testing.assert_allclose(tangential, friction * (1.0 + restitution), atol=3e-3)
    np.testing.assert_allclose(after[5], [-0.8, -0.5 * 1.8], atol=3e-3)
    np.testing.assert_allclose(after[6], [0.8, 0.5 * 1.8], atol=3e-3)


ON_TWO_GROUNDS = f"""
title = "two discs on the floor and on a hill"
gravity = [0.0, -9.81]
time = {{ duration = 1.0, step = 1e-5 }}
box = {{ width = 100.0, height = 10.0, walls = ["floor"] }}
rows = [{{ start = [90.0, -49.5], end = [90.0, -49.5], count = 1, radius = 50.0, name = "hill" }}]

[grains]
sizes = [{{ radius = {RADIUS}, count = 2 }}]
density = {DENSITY}
layout = "list"
positions = [[1.0, {RADIUS}, 0.5, 0.0, {{spin}}], [90.0, {0.5 + RADIUS}, 0.5, 0.0, {{spin}}]]

[contact]
normal_stiffness = 1e6
restitution = 0.5
tangential_stiffness = 1e6
rolling = "constant_torque"

[[contact.pairs]]
between = ["grains", "floor"]
{{floor}}

[[contact.pairs]]
between = ["hill", "grains"]
{{hill}}
"""


def slowing(text: str, steps: int, folder: Path) -> NDArray[np.float64]:
    """Mean deceleration [m/s2] of the discs on the floor and on the hill."""
    scene = built(text, folder)
    scene.model.advance(3_000)  # 30 ms: by then they rest in their springs
    before = velocities(scene)[:, 0]
    scene.model.advance(steps)
    return (before - velocities(scene)[:, 0]) / (steps * 1e-5)


def test_discs_slow_down_by_the_friction_of_what_they_slide_on(tmp_path: Path) -> None:
    """dv/dt = -mu g, mu from two pairs; rolling resistance, which only the hill has, does not slow a sliding disc."""
    floor, hill = "friction = 0.2", "friction = 0.4\nrolling_friction = 0.1"
    text = ON_TWO_GROUNDS.replace("{spin}", "0.0").replace("{floor}", floor).replace("{hill}", hill)
    # on the hill the weight is lighter by v^2/(R g) = 5e-4 and leans forward by x/R = 4e-4
    np.testing.assert_allclose(slowing(text, 1_000, tmp_path), [0.2 * 9.81, 0.4 * 9.81], rtol=2e-3)


def test_rolling_resistance_of_one_pair_slows_a_rolling_disc(tmp_path: Path) -> None:
    """Rolling without slip, dv/dt = -(2/3) mu_r g: moment mu_r r m g against 3/2 m r^2 about the ground."""
    floor, hill = "friction = 0.5\nrolling_friction = 0.1", "friction = 0.5"
    text = ON_TWO_GROUNDS.replace("{spin}", str(-0.5 / RADIUS)).replace("{floor}", floor).replace("{hill}", hill)
    on_floor, on_hill = slowing(text, 10_000, tmp_path)
    # the tangential spring has no dashpot and rings: f/k_t = 2e-7 m at 2.4e3 rad/s is 5e-4 m/s of the 0.065 lost
    assert on_floor == pytest.approx(2 / 3 * 0.1 * 9.81, rel=1e-2)
    # downhill by 2/3 g x/R with x up to 0.065 m, and the same ringing
    assert abs(on_hill) < 0.015


def test_moduli_of_two_materials_are_mixed(tmp_path: Path) -> None:
    """Against a wall of the grain's own stuff the spring is half as stiff as against a rigid one: contacts last longer.

    Hertz: ``t_c = 2.9432 delta_max/v`` with ``delta_max = (5 m v^2/(4 k_h))^(2/5)``, ``k_h = 4/3 E* sqrt(r)``.
    """
    text = ONE_DISC.replace("count = 1", "count = 2").replace(
        "]] }", f"], [{RADIUS + 1e-6}, 0.5, {-SPEED}, 0.0]] }}"
    ) + (
        '[contact]\nnormal = "hertz"\nfriction = 0.3\n'
        "[contact.materials]\ngrains = { youngs_modulus = 1e9, poissons_ratio = 0.25 }\n"
        "walls = { youngs_modulus = 1e9, poissons_ratio = 0.25 }\n"
        "floor = { youngs_modulus = 1e17, poissons_ratio = 0.25 }"
    )
    scene = built(text, tmp_path)
    grains = scene.model.particles.grains
    touched, step = np.zeros(2), 1e-6
    for _ in range(8_000):
        scene.model.advance(1)
        order = np.argsort(grains.number)
        touched += step * (np.array([grains.y[order[0]], grains.x[order[1]]]) < RADIUS)
    stiffness = 4 / 3 * 1e9 / (1 - 0.25**2) * math.sqrt(RADIUS) * np.array([1.0, 0.5])
    expected = 2.9432 * (5 * MASS * SPEED**2 / (4 * stiffness)) ** 0.4 / SPEED
    np.testing.assert_allclose(touched, expected, rtol=2e-3)  # counted in steps of 1/2000 of it
    floor = scene.contact.rows[0][2]
    assert floor.normal.stiffness_at(1e-5, RADIUS) == pytest.approx(1.5 * stiffness[0] * math.sqrt(1e-5), rel=1e-7)
    # Mindlin for two equal bodies: 2 (1 - nu)/(2 - nu); against a rigid one the same ratio
    for law in (scene.contact.rows[0][0], floor):
        assert law.tangential.stiffness_ratio == pytest.approx(2 * 0.75 / 1.75, rel=1e-7)


# -- no pairs, no table; equal pairs, equal bits --------------------------------------------------


def test_a_table_is_built_only_for_pairs_and_changes_no_bit(tmp_path: Path) -> None:
    path = write_template("grains", tmp_path / "grains.toml")
    law = "normal_stiffness=1e6,normal_damping=100,tangential_stiffness=5e4,friction=0.8,rolling_friction=0.2"
    quick = ["grains.sizes=[{radius=4e-3,count=60}]", "box.width=0.08", "box.height=0.2", f"contact={{{law}}}"]
    pair = "contact.pairs=[{between=['grains','floor'],friction=0.8}]"
    plain, table = (
        build(load_scene(path, [*quick, *more]).model_copy(update={"damping": None})) for more in ([], [pair])
    )
    assert isinstance(plain.contact, ContactModel) and isinstance(table.contact, ContactTable)
    for scene in (plain, table):
        scene.model.advance(4_000)
    assert plain.model.particles.look().count > 60
    for name in ("x", "y", "theta", "vx", "vy", "omega"):
        one, other = (getattr(scene.model.particles.grains, name) for scene in (plain, table))
        np.testing.assert_array_equal(one, other, err_msg=name)


def test_run_with_materials_on_a_bed_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    """The bed tells walls apart, the scene on it glued grains as well, as its template says; it is resumed."""
    path = write_template("tube", tmp_path / "tube.toml")
    text = re.sub(r"^# (\[\[contact|between|friction = 0.3)", r"\1", path.read_text(), flags=re.MULTILINE)
    path.write_text(text + '[[bed.contact.pairs]]\nbetween = ["grains", "walls"]\nfriction = 0.5\n')
    sets = ["bed.time.duration=0.5", "output.figures=false", "output.checkpoint_interval=0.01"]
    options = {"threads": 1, "progress": False}
    scene = load_scene(path, [*sets, "time.duration=0.04"])
    assert [(set(pair.between), pair.friction) for pair in scene.contact.pairs] == [
        ({"grains", "walls"}, 0.5),
        ({"grains", "structure"}, 0.3),
    ]
    assert scene.contact.normal_stiffness == scene.bed.contact.normal_stiffness
    whole = run_scene(scene, out=tmp_path / "runs" / "whole", **options)
    half = load_scene(path, [*sets, "time.duration=0.02"])
    parts = run_scene(half, out=tmp_path / "runs" / "parts", **options)
    run_scene(scene, out=parts, resume=True, **options)
    a, b = (checkpoint.load(folder / "checkpoint.h5")[0] for folder in (whole, parts))
    for name in a.keys() - {"run.seconds"}:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)
    materials = a["particles.grains.material"]
    n_free = int(a["particles.grains.n_free"])
    assert set(materials[:n_free]) == {0} and set(materials[n_free:]) == {1}
    assert list(a["particles.walls.material"]) == [2, 3, 4]


# -- the coupling's r --------------------------------------------------------------------------

BEAM = f"""
title = "grains above a free beam"
time = {{ duration = 1.0, step = 1e-5 }}
box = {{ width = 1.0, height = 1.0 }}
interface = {{ per_facet = 1, boundaries = ["top"], diameter = 8e-3 }}
[grains]
sizes = [{{ radius = {RADIUS}, count = 2 }}]
density = {DENSITY}
[structure]
kind = "free_rigid"
density = 1000.0
beam = {{ length = 0.1, height = 0.01, along = 10, across = 1 }}
placement = {{ x = 0.5, y = 0.5 }}
"""


def test_stiffness_ratio_takes_the_law_of_the_glued_grains(tmp_path: Path) -> None:
    """r = H^2 (k + 2 c/H) lambda, lambda the same for all: only the springs that glued grains meet count."""
    plain = built(BEAM + "[contact]\nnormal_stiffness = 1e5", tmp_path).stiffness_ratio
    pairs = [
        '[[contact.pairs]]\nbetween = ["grains", "structure"]\nnormal_stiffness = 3e5',
        '[[contact.pairs]]\nbetween = ["grains", "floor"]\nnormal_stiffness = 9e5',
    ]
    text = "\n".join([BEAM, "[contact]\nnormal_stiffness = 1e5", *pairs])
    assert built(text, tmp_path).stiffness_ratio == pytest.approx(3 * plain, rel=1e-9)


def test_stiffness_ratio_with_a_dashpot_from_restitution(tmp_path: Path) -> None:
    """zero_overlap: c = -2 ln(e) sqrt(m k)/sqrt(ln(e)^2 + pi^2), with the mass of a free grain on the glued one."""
    given = built(BEAM + "[contact]\nnormal_stiffness = 1e5\nnormal_damping = 30.0", tmp_path).stiffness_ratio
    ratio = 30.0 / (2 * math.sqrt(MASS * 1e5))
    asked = math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2))
    law = f'[contact]\nnormal_stiffness = 1e5\nrestitution = {asked!r}\nrestitution_at = "zero_overlap"'
    assert built(BEAM + law, tmp_path).stiffness_ratio == pytest.approx(given, rel=1e-9)


def test_stiffness_ratio_of_hertz_at_the_allowed_overlap(tmp_path: Path) -> None:
    """Slope 3/2 k_h sqrt(delta) at 5 % of the smallest radius, that of the glued grains; at e = 1 no dashpot."""
    plain = built(BEAM + "[contact]\nnormal_stiffness = 1e5", tmp_path).stiffness_ratio
    hertz = built(BEAM + '[contact]\nnormal = "hertz"\nhertz_stiffness = 1e7', tmp_path).stiffness_ratio
    assert hertz == pytest.approx(plain * 1.5e7 * math.sqrt(0.05 * 4e-3) / 1e5, rel=1e-9)
    # with the moduli: k_h = 4/3 E* sqrt(R), 1/R = 1/4 mm + 1/10 mm
    modulus = 3 / 4 * 1e7 * (1 - 0.3**2) / math.sqrt(1 / (1 / 4e-3 + 1 / RADIUS)) * 2
    law = f'[contact]\nnormal = "hertz"\nyoungs_modulus = {modulus!r}\npoissons_ratio = 0.3'
    assert built(BEAM + law, tmp_path).stiffness_ratio == pytest.approx(hertz, rel=1e-9)
