"""Several materials in one scene: every pair obeys its own law, walls and prescribed discs included."""

import itertools

import hypothesis.strategies as st
import numba
import numpy as np
import pytest
from discs import by_number
from every_law import EPS, MANY, Pair, any_pair, decades, hertz, model_of, system_of
from hypothesis import given, settings

from particles import (
    ConstantTorqueRolling,
    ContactModel,
    ContactTable,
    Grains,
    MindlinFriction,
    ParticleSystem,
    Wall,
)
from particles.kernels.laws.materials import of_pair

KIND = "damped rolling"  # whose table is the kind "table"
PAIRS = list(itertools.combinations_with_replacement(range(3), 2))
FEW = settings(MANY, max_examples=8)
SIX = st.lists(
    any_pair(radius=st.just(1e-3), other=st.just(1.0), k=decades(3.0, 6.0), may_pull=st.just(False)),
    min_size=6,
    max_size=6,
)
NAMES = ("x", "y", "theta", "vx", "vy", "omega", "fx", "fy", "torque")


def table_of(models: dict[tuple[int, int], ContactModel], names: tuple[int, ...] = (0, 1, 2)) -> ContactTable:
    """The table in which material m is called names[m]."""
    rows = [[models[0, 0]] * 3 for _ in range(3)]
    for (a, b), model in models.items():
        rows[names[a]][names[b]] = rows[names[b]][names[a]] = model
    return ContactTable(rows)


def couple(place: int, materials: tuple[int, int], seed: int = 1) -> Grains:
    """Two discs in contact, moving and spinning, far from those of other places."""
    rng = np.random.default_rng(seed)
    centre = np.array([0.1 * place, 0.03 * place])
    return Grains.discs(
        centre + [[0.0, 0.0], [1.7e-3, 0.9e-3]], [1e-3, 1e-3], 1000.0, material=list(materials),
        velocity=0.3 * rng.standard_normal((2, 2)), spin=100.0 * rng.standard_normal(2),
    )  # fmt: skip


def joined(parts: list[Grains]) -> Grains:
    columns = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("x", "y", "vx", "vy", "omega", "material")
    }
    return Grains.discs(
        np.column_stack([columns["x"], columns["y"]]), 1e-3, 1000.0, material=columns["material"],
        velocity=np.column_stack([columns["vx"], columns["vy"]]), spin=columns["omega"],
    )  # fmt: skip


def state(system: ParticleSystem) -> np.ndarray:
    return np.array(by_number(system, *NAMES))


@FEW
@given(pairs=SIX)
def test_every_pair_moves_by_its_own_law(pairs: list[Pair]) -> None:
    """All pairs of three materials in one system, bit for bit as each alone under its own model."""
    models = {key: model_of(KIND, pair) for key, pair in zip(PAIRS, pairs, strict=True)}
    dt, steps = 0.1 * min(1.0 / pair.omega_0 for pair in pairs), 20
    couples = [couple(place, key) for place, key in enumerate(PAIRS)]
    together = system_of("table", joined(couples), table_of(models), dt=dt)
    together.advance(steps)
    both = state(together)
    energies = dict.fromkeys(together.energies(), 0.0)
    for place, (key, grains) in enumerate(zip(PAIRS, couples, strict=True)):
        alone = system_of(KIND, grains, models[key], dt=dt)
        alone.advance(steps)
        assert np.array_equal(both[:, 2 * place : 2 * place + 2], state(alone))
        for name, value in alone.energies().items():
            energies[name] += value
    for name, value in together.energies().items():
        assert value == pytest.approx(energies[name], rel=1e3 * EPS, abs=1e3 * EPS * energies["kinetic"])


@FEW
@given(pairs=SIX)
def test_names_of_materials_do_not_matter(pairs: list[Pair]) -> None:
    """Materials 0, 1, 2 called 2, 0, 1: the same bits."""
    models = {key: model_of(KIND, pair) for key, pair in zip(PAIRS, pairs, strict=True)}
    dt = 0.1 * min(1.0 / pair.omega_0 for pair in pairs)
    found = []
    for names in ((0, 1, 2), (2, 0, 1)):
        grains = joined([couple(place, key) for place, key in enumerate(PAIRS)])
        grains.material[:] = np.array(names)[grains.material]
        walls = [Wall(point=(0.0, -0.9e-3), normal=(-0.03, 0.1), velocity=(0.1, 0.0), material=names[1])]
        system = system_of("table", grains, table_of(models, names), dt=dt, walls=walls)
        system.advance(20)
        found.append((state(system), system.wall_force, system.energies()))
    assert np.array_equal(found[0][0], found[1][0])
    assert np.array_equal(found[0][1], found[1][1])
    assert found[0][2] == found[1][2]
    assert np.hypot(*found[0][1][0]) > 0.0


def test_discs_slide_on_walls_and_prescribed_discs_by_the_friction_of_both() -> None:
    """Blocks on a floor and on a prescribed disc, of frictions by pairs: ``v_0 - mu g t`` and ``2 mu g t / r``."""
    g, v_0, radius, k = 9.81, 0.5, 1e-3, 1e6
    mu = {(0, 0): 0.9, (0, 1): 0.15, (0, 2): 0.3, (1, 1): 0.9, (1, 2): 0.05, (2, 2): 0.9}
    models = {key: model_of(KIND, Pair(k=k, mu=value, mu_r=0.0)) for key, value in mu.items()}
    density = 1000.0
    sink = np.pi * radius**2 * density * g / k
    place = [[0.0, radius - sink], [0.1, radius - sink], [0.2, 2.0 * radius - sink]]
    grains = Grains.discs(place, radius, density, material=[0, 1, 1], velocity=[[v_0, 0.0], [v_0, 0.0], [0.0, 0.0]])
    grains.omega[2] = v_0 / radius
    grains = grains.with_prescribed([[0.2, 0.0]], radius, 0, material=0)
    floor = Wall(point=(0.0, 0.0), normal=(0.0, 1.0), material=2)
    system = ParticleSystem(
        grains, table_of(models), walls=[floor], gravity=(0.0, -g), time_step=1e-6,
        damping=system_of("table", couple(0, (0, 0)), table_of(models), dt=1.0).damping,
    )  # fmt: skip
    duration = 0.01
    system.advance(round(duration / 1e-6))
    vx, omega = by_number(system, "vx", "omega")
    # The spring takes mu m g/k_t = 1e-9 m/mu of the path of 5e-3 m, the arm delta/2 = 1e-5.
    assert vx[0] == pytest.approx(v_0 - mu[0, 2] * g * duration, rel=1e-4)
    assert vx[1] == pytest.approx(v_0 - mu[1, 2] * g * duration, rel=1e-4)
    assert v_0 / radius - omega[2] == pytest.approx(2.0 * mu[0, 1] * g * duration / radius, rel=1e-2)


@numba.njit
def chosen(laws, i, j):
    return of_pair(laws, i, j)


def test_laws_of_spheres_are_chosen_by_pairs_as_well() -> None:
    pairs = [Pair(k=10.0**power, mu=0.1 * power, zeta=0.01 * power, mu_r=0.02 * power) for power in range(1, 7)]
    models = {
        key: ContactModel(
            normal=hertz(pair),
            tangential=MindlinFriction(stiffness_ratio=pair.shear * pair.mu, friction=pair.mu, damping_ratio=pair.zeta),
            rolling=ConstantTorqueRolling(friction=pair.mu_r),
        )
        for key, pair in zip(PAIRS, pairs, strict=True)
    }
    laws = table_of(models).numbers()
    for (a, b), model in models.items():
        assert chosen(laws, a, b) == chosen(laws, b, a) == model.numbers()
    assert chosen(models[0, 1].numbers(), 0, 1) == models[0, 1].numbers()
