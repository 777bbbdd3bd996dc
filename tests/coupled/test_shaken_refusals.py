"""What is refused of shaken walls, intruders, periodic sides and spread sizes, in one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest
from bad_scenes import GONE, GRAINS, PERIODIC, RIGID, SHAKEN, Case, changed, require_refusal

from coupled.scene import Scene

BAD: dict[str, Case] = {
    "amplitude and gamma": (SHAKEN, {"shaking.amplitude": 1e-3}, "shaking.gamma", ("shaking.amplitude", "keep one")),
    "no amplitude": (SHAKEN, {"shaking.gamma": GONE}, "shaking.amplitude", ("missing", "Gamma")),
    "two periods": (SHAKEN, {"shaking.period_steps": 500}, "shaking.period_steps", ("shaking.period", "keep one")),
    "no period": (SHAKEN, {"shaking.period": GONE}, "shaking.period", ("missing", "in steps")),
    "gamma without gravity": (SHAKEN, {"gravity": [0.0, 0.0]}, "shaking.gamma", ("gravity", "shaking.amplitude")),
    "few steps": (SHAKEN, {"shaking.period": 1e-4}, "shaking.period", ("10 steps", "at least 20")),
    "few whole steps": (PERIODIC, {"shaking.period_steps": 10}, "shaking.period_steps", ("at least 20",)),
    "stop before start": (SHAKEN, {"shaking.start": 0.5, "shaking.stop": 0.4}, "shaking.stop", ("later", "0.5 s")),
    "unknown waveform": (SHAKEN, {"shaking.waveform": "square"}, "shaking.waveform", ("'cosine' or 'sine'",)),
    "negative ramp": (SHAKEN, {"shaking.ramp": -1.0}, "shaking.ramp", ("at least 0",)),
    "wall that is not there": (SHAKEN, {"shaking.walls": ["lid"]}, "shaking.walls.0", ("no wall of the box", "floor")),
    "wall twice": (SHAKEN, {"shaking.walls": ["floor", "floor"]}, "shaking.walls", ("twice",)),
    "no walls": (SHAKEN, {"box.walls": []}, "box.walls", ("missing", "[shaking]")),
    "row that nothing shakes": (
        RIGID,
        {"rows": [(_ROW := {"start": [0.0, 0.01], "end": [0.1, 0.01], "count": 5, "radius": 1e-3}) | {"shaken": True}]},
        "rows.0.shaken",
        ("[shaking]", "remove the key"),
    ),
    "row that moves twice": (
        SHAKEN,
        {"rows": [_ROW, _ROW | {"velocity": [1.0, 0.0]}]},
        "rows.1.velocity",
        ("moves with [shaking]", "shaken = false"),
    ),
    "no grains to shake": (
        RIGID,
        {
            "grains": GONE,
            "shaking": {"gamma": 1.0, "period": 0.1},
            "rows": [_ROW],
        },
        "shaking",
        ("free grains",),
    ),
    "intruder outside": (SHAKEN, {"intruders.0.x": 0.097}, "intruders.0.x", ("outside", "move it in")),
    "intruder too large": (SHAKEN, {"intruders.0.radius": 0.06}, "intruders.0.radius", ("larger than the box",)),
    "intruder of no density": (SHAKEN, {"intruders.0.density": GONE}, "intruders.0.density", ("missing",)),
    "intruders in one place": (SHAKEN, {"intruders.1.y": "middle"}, "intruders.1", ("overlaps intruders.0",)),
    "intruder in the middle by word and by number": (
        SHAKEN,
        {"intruders.1.x": 0.05, "intruders.1.y": 0.02, "intruders.0.y": 0.021},
        "intruders.1",
        ("overlaps intruders.0, 0.001 m",),
    ),
    "intruders across the seam": (
        PERIODIC,
        {"intruders.0.x": 0.001, "intruders.1.x": 0.098, "intruders.0.y": 0.1},
        "intruders.1",
        ("overlaps intruders.0, 0.003 m",),
    ),
    "intruder in a grain of a list": (
        SHAKEN,
        {
            "grains.sizes": [{"radius": 2e-3, "count": 2}],
            "grains.layout": "list",
            "grains.positions": [[0.05, 0.02], [0.05, 0.06]],
            "intruders.1.y": 0.062,
            "intruders.1.x": 0.051,
        },
        "intruders.1",
        ("grains.positions.1",),
    ),
    "large intruder that leaves no place": (
        SHAKEN,
        {"intruders.0.radius": 0.06, "grains.sizes.0.count": 900},
        "intruders.0.radius",
        ("larger than the box",),
    ),
    "intruder nowhere": (SHAKEN, {"intruders.0.x": "centre"}, "intruders.0.x", ("middle",)),
    "intruders without grains": (
        RIGID,
        {"grains": GONE, "rows": [_ROW], "intruders": [{"radius": 1e-3, "density": 1.0}]},
        "intruders",
        ("free grains",),
    ),
    "intruders that leave no place": (SHAKEN, {"grains.sizes.0.count": 1050}, "grains.sizes", ("lattice", "enlarge")),
    "name of an intruder that is taken": (SHAKEN, {"intruders.0.name": "floor"}, "intruders.0.name", ("taken",)),
    "pair of nobody": (
        SHAKEN,
        {"contact.pairs": [{"between": ["nut", "walls"], "friction": 0.0}]},
        "contact.pairs.0.between.0",
        ("no material",),
    ),
    "axis twice": (PERIODIC, {"box.periodic": ["x", "x"]}, "box.periodic", ("twice",)),
    "unknown axis": (PERIODIC, {"box.periodic": ["z"]}, "box.periodic.0", ("'x' or 'y'",)),
    "wall across": (PERIODIC, {"box.walls": ["left", "floor"]}, "box.walls", ("across the periodic axis x",)),
    "short period": (PERIODIC, {"box.width": 0.024}, "box.width", ("5 of the largest radii", "0.025 m")),
    "structure between periodic sides": (RIGID, {"box.periodic": ["x"]}, "box.periodic", ("structure",)),
    "spread of all": (SHAKEN, {"grains.sizes.0.spread": 1.0}, "grains.sizes.0.spread", ("less than 1",)),
    "grain as wide as its spread": (
        SHAKEN,
        {"grains.sizes.0.radius": 0.049, "grains.sizes.0.count": 1},
        "grains.sizes.0.radius",
        ("larger",),
    ),
    "integrator": (SHAKEN, {"time.integrator": "gear"}, "time.integrator", ("'leapfrog' or 'velocity_verlet'",)),
    "shaken bed": (GRAINS, {"grains": {"bed": "bed"}, "bed": SHAKEN}, "grains.bed", ("is no bed", "[shaking]")),
    "other intruders than the bed": (
        GRAINS,
        {"grains": {"bed": "bed"}, "bed": changed(SHAKEN, {"shaking": GONE}), "intruders": SHAKEN["intruders"][:1]},
        "intruders",
        ("bed.intruders",),
    ),
    "other sides than the bed": (
        PERIODIC,
        {"grains": {"bed": "bed"}, "bed": changed(SHAKEN, {"shaking": GONE})},
        "box.periodic",
        ("otherwise than the bed",),
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_refusal(name: str, tmp_path: Path) -> None:
    require_refusal(BAD[name], tmp_path)


@pytest.mark.parametrize("scene", [SHAKEN, PERIODIC], ids=["walls", "periodic"])
def test_the_unspoiled_scene_is_accepted(scene: dict) -> None:
    assert Scene.model_validate(scene).shaking is not None
