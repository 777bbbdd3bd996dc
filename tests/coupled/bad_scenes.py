"""Good scenes that the tests of refusals spoil, and the check of what is said about it."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any, TypeAlias

import pytest
import tomli_w

from coupled.scene import SceneError, load_scene

# scene, the keys that are changed, the key that must be named, words that must be said
Case: TypeAlias = tuple[dict[str, Any], dict[str, Any], str, tuple[str, ...]]

GRAINS: dict[str, Any] = {
    "title": "a few grains",
    "gravity": [0.0, -9.81],
    "time": {"duration": 1.0, "step": 1e-5},
    "box": {"width": 0.1, "height": 0.2},
    "grains": {"sizes": [{"radius": 2e-3, "count": 50}], "density": 1600.0},
    "contact": {"normal_stiffness": 1e6, "tangential_stiffness": 5e4, "friction": 0.5},
}
TUBE: dict[str, Any] = {
    **GRAINS,
    "title": "a tube on a few grains",
    "structure": {
        "kind": "elastic",
        "youngs_modulus": 70e9,
        "poissons_ratio": 0.35,
        "density": 2700.0,
        "tube": {"outer_radius": 0.02, "inner_radius": 0.015},
        "placement": {"x": 0.05, "y": "on_bed"},
        "loads": [{"kind": "boundary", "boundary": "loaded_arc", "total_force": [0.0, -10.0]}],
    },
    "interface": {"per_facet": 2},
}
RIGID: dict[str, Any] = {
    **TUBE,
    "structure": {
        "kind": "rigid",
        "tube": {"outer_radius": 0.02, "inner_radius": 0.015},
        "placement": {"x": 0.05, "y": "on_bed"},
        "path": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, -0.01]]},
    },
}
BEAM_ON_ROW: dict[str, Any] = {
    "title": "a beam on a row",
    "time": {"duration": 1.0, "step": 1e-5},
    "structure": {
        "kind": "elastic",
        "youngs_modulus": 70e9,
        "poissons_ratio": 0.35,
        "density": 2700.0,
        "beam": {"length": 1.0, "height": 0.05},
    },
    "interface": {"per_facet": 3, "boundaries": ["bottom"]},
    "rows": [{"under": "bottom", "radius": 4e-3}],
    "contact": {"normal_stiffness": 1e7},
}
HERTZ: dict[str, Any] = {
    **GRAINS,
    "title": "a few grains with Hertz's spring",
    "contact": {
        "normal": "hertz",
        "youngs_modulus": 1e8,
        "poissons_ratio": 0.3,
        "restitution": 0.8,
        "friction": 0.5,
        "materials": {"floor": {"youngs_modulus": 1e9, "poissons_ratio": 0.2}},
        "pairs": [{"between": ["grains", "walls"], "friction": 0.2}],
    },
}
SURFACES: dict[str, Any] = {
    **RIGID,
    "title": "a rigid tube, a row and walls of their own materials",
    "rows": [{"start": [0.01, 0.15], "end": [0.01, 0.15], "count": 1, "radius": 2e-3, "name": "kerb"}],
    "contact": {
        "normal_stiffness": 1e6,
        "restitution": 0.8,
        "tangential_ratio": 0.05,
        "friction": 0.5,
        "pairs": [
            {"between": ["grains", "structure"], "friction": 0.2},
            {"between": ["kerb", "structure"], "friction": 0.2},
            {"between": ["floor", "grains"], "rolling_friction": 0.1, "normal_stiffness": 2e6},
        ],
    },
}
SHAKEN: dict[str, Any] = {
    **GRAINS,
    "title": "an intruder in a shaken box",
    "grains": {"sizes": [{"radius": 2e-3, "count": 50, "spread": 0.05}], "density": 1600.0},
    "intruders": [{"radius": 5e-3, "density": 800.0}, {"radius": 3e-3, "density": 1600.0, "y": 0.1}],
    "shaking": {"gamma": 2.0, "period": 0.05},
}
PERIODIC: dict[str, Any] = {
    **SHAKEN,
    "title": "a shaken floor with periodic sides",
    "box": {"width": 0.1, "height": 0.2, "periodic": ["x"]},
    "shaking": {"amplitude": 1e-3, "period_steps": 5000, "waveform": "sine"},
}
GONE = object()


def changed(scene: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return a copy of a scene with keys set, or removed where the value is GONE."""
    data = copy.deepcopy(scene)
    for path, value in changes.items():
        *tables, last = path.split(".")
        here: Any = data
        for part in tables:
            here = here[int(part)] if isinstance(here, list) else here.setdefault(part, {})
        if value is GONE:
            del here[last]
        else:
            here[last] = value
    return data


def require_refusal(case: Case, folder: Path) -> None:
    """The spoiled scene is refused in one sentence."""
    scene, changes, key, words = case
    path = folder / "scene.toml"
    path.write_text(tomli_w.dumps(changed(scene, changes)))
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    sentence = str(caught.value)
    assert caught.value.key == key
    assert sentence.startswith(f"scene.toml: {key} ")
    assert all(word in sentence for word in words), sentence
    assert "\n" not in sentence and sentence.endswith(".")
