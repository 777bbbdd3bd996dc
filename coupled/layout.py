"""Where the free grains of a scene start, and the walls around them with their motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

import particles as dem
from coupled.scene import Grains, Scene
from coupled.scene.materials import intruder_materials, materials
from coupled.scene.places import places_of
from particles.beds import lattice

Floats = NDArray[np.float64]


def laid_out(scene: Scene) -> dem.Grains:
    """The grains of a scene that lays them out itself, the intruders last."""
    table = scene.grains
    sizes = _sizes(table)
    places = np.array(places_of(scene.intruders, table, scene.box) if scene.intruders else []).reshape(-1, 2)
    if table.layout == "list":
        rows = np.array([(*row, *(0.0,) * (5 - len(row))) for row in table.positions])
        radius = np.concatenate([np.full(count, size) for size, count in sizes])
        return _with_intruders(scene, rows[:, :2], radius, places, rows[:, 2:])
    holes = [
        (x + shift, y, intruder.radius)
        for (x, y), intruder in zip(places, scene.intruders, strict=True)
        for shift in _shifts(scene)
    ]
    loose = lattice(
        sizes, table.density, width=scene.box.width, spacing=table.spacing, jitter=table.jitter, seed=table.seed,
        holes=holes,
    )  # fmt: skip
    return _with_intruders(scene, loose.position, loose.radius, places, np.zeros((len(loose), 3)))


def box_walls(scene: Scene) -> list[dem.Wall]:
    """The walls of the box; those that shake are marked."""
    if scene.box is None:
        return []
    walls = dem.box(scene.box.width, scene.box.height, scene.box.walls)
    shaken: tuple[str, ...] = ()
    if scene.shaking is not None:
        shaken = scene.shaking.moved(scene.box)
    of = materials(scene).index
    return [replace(wall, material=of(wall.name), shaken=wall.name in shaken) for wall in walls]


def shaking_of(scene: Scene, first_row: int) -> dem.Shaking | None:
    """The motion of the walls and rows; `first_row` is the number of the body that the first row is."""
    table = scene.shaking
    if table is None:
        return None
    period = table.period_with(scene.time.step)
    return dem.Shaking(
        amplitude=table.amplitude_of(period, scene.gravity),
        period=period,
        direction=(1.0, 0.0) if table.direction == "x" else (0.0, 1.0),
        from_rest=table.waveform == "cosine",
        start=table.start,
        stop=table.stop,
        ramp=period if table.ramp is None else table.ramp,
        bodies=tuple(first_row + index for index in scene.shaken_rows),
    )


def _sizes(table: Grains) -> list[tuple[float, int]]:
    """Radii [m] and their counts; each drawn by the seed where a class has a spread."""
    sizes: list[tuple[float, int]] = []
    draw = np.random.default_rng([table.seed, len(table.sizes)])
    for size in table.sizes:
        if size.spread == 0.0:
            sizes.append((size.radius, size.count))
        else:
            sizes += [(float(r), 1) for r in draw.uniform(size.smallest, size.largest, size.count)]
    return sizes


def _shifts(scene: Scene) -> tuple[float, ...]:
    """How far a disc of the box stands from its images in x [m], itself the first."""
    period = scene.box.period[0]
    return (0.0,) if period is None else (0.0, -period, period)


def _with_intruders(scene: Scene, place: Floats, radius: Floats, places: Floats, motion: Floats) -> dem.Grains:
    """Grains at `place` (n, 2) with `motion` (n, 3) of vx, vy, omega, and the intruders at rest at `places` (k, 2)."""
    own = np.array([intruder.radius for intruder in scene.intruders])
    density = [intruder.density for intruder in scene.intruders]
    motion = np.concatenate([motion, np.zeros((len(own), 3))])
    return dem.Grains.discs(
        np.concatenate([place, places]),
        np.concatenate([radius, own]),
        np.concatenate([np.full(len(place), scene.grains.density), density]),
        velocity=motion[:, :2],
        spin=motion[:, 2],
        material=np.concatenate([np.zeros(len(place), np.int64), np.array(intruder_materials(scene), np.int64)]),
    )
