"""The key structure.theory: written, refused where it does not fit, handed on, and watched while a run goes."""

from pathlib import Path

import numpy as np
import pytest
import tomli_w
from bad_scenes import TUBE, changed

from coupled.build import build
from coupled.report.modelled import models
from coupled.errors import SceneError
from coupled.running.run import run_scene
from coupled.scene import Scene, dump_scene, load_scene

METAL = {"youngs_modulus": 70e5, "poissons_ratio": 0.35, "density": 2700.0}


def driven(theory: str, load: float) -> Scene:
    """A free beam of 0.2 m x 0.01 m, pushed off centre by a load of fixed direction [N/m]."""
    structure = {
        "kind": "elastic",
        **METAL,
        "theory": theory,
        "beam": {"length": 0.2, "height": 0.01, "along": 10, "across": 1},
        "loads": [{"kind": "point", "point": [0.1, 0.0], "force": [0.0, load]}],
    }
    tables = {
        "title": "a pushed beam",
        "time": {"duration": 0.2, "step": 1e-3},
        "structure": structure,
        "output": {"history_interval": 0.01, "figures": False},
    }
    return Scene.model_validate(tables)


@pytest.mark.parametrize(
    ("name", "overrides", "theory", "element"),
    [
        ("elastic_tube", [], "linear", "enhanced"),
        ("elastic_tube", ["structure.theory=corotational"], "corotational", "enhanced"),
        ("elastic_tube", ["structure.theory=large_strain"], "large_strain", "standard"),
        ("rigid_tube", [], None, None),
    ],
)
def test_scene_says_the_theory_it_uses(
    name: str, overrides: list[str], theory: str | None, element: str | None, tmp_path: Path
) -> None:
    scene = load_scene(name, overrides)
    assert (scene.structure.theory, scene.structure.element) == (theory, element)
    (tmp_path / "scene.toml").write_text(dump_scene(scene))
    assert load_scene(tmp_path / "scene.toml") == scene
    told = [model for model in models(scene) if model.endswith("theory")]
    assert told == ([] if theory is None else [f"{theory} theory".replace("_", "-")])


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"structure.theory": "cubic"}, "structure.theory", ("'linear', 'corotational' or 'large_strain'",)),
        (
            {"structure.theory": "corotational", "structure.newmark": {"beta": 0.3025, "gamma": 0.6}},
            "structure.newmark",
            ("angular momentum", "beta = 0.25", "remove it"),
        ),
        (
            {"structure.theory": "large_strain", "structure.generalised_alpha": {}},
            "structure.generalised_alpha",
            ("angular momentum", "remove it"),
        ),
        (
            {"structure.theory": "large_strain", "structure.element": "enhanced"},
            "structure.element",
            ("small strains", 'give "standard"'),
        ),
        (
            {"structure.kind": "free_rigid", "structure.theory": "corotational", "structure.youngs_modulus": None},
            "structure.theory",
            ('"corotational" means nothing for kind = "free_rigid"',),
        ),
    ],
)
def test_theory_that_does_not_fit_is_refused(
    changes: dict[str, object], key: str, words: tuple[str, ...], tmp_path: Path
) -> None:
    tables = changed(TUBE, {path: value for path, value in changes.items() if value is not None})
    for value in changes.values():
        if value is None:
            for name in ("youngs_modulus", "poissons_ratio"):
                del tables["structure"][name]
    (tmp_path / "scene.toml").write_text(tomli_w.dumps(tables))
    with pytest.raises(SceneError) as refusal:
        load_scene(tmp_path / "scene.toml")
    assert refusal.value.key == key
    assert all(word in str(refusal.value) for word in words), str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_theory_reaches_the_structure() -> None:
    """Pushed off centre the beam turns; only the linear one grows by that."""
    length = {}
    for theory in ("linear", "corotational", "large_strain"):
        model = build(driven(theory, load=5.0)).model
        model.advance(200)
        points = model.structure.polyline.points
        corners = [int(np.argmin(points @ [1.0, 1.0])), int(np.argmax(points @ [1.0, -1.0]))]
        left, right = (points + model.structure.boundary_displacement)[corners]
        length[theory] = np.hypot(*(right - left))
        assert abs(model.structure.mean_rotation()) > 0.2
    assert length["linear"] > 1.02 * 0.2
    assert length["corotational"] == pytest.approx(0.2, rel=0.01)
    assert length["large_strain"] == pytest.approx(0.2, rel=0.01)


@pytest.mark.parametrize(
    ("theory", "load", "said", "silent"),
    [
        ("linear", 2.0, ("has turned by", 'take theory "corotational"'), ("parts of the structure",)),
        ("corotational", 150.0, ("parts of the structure have turned by", "largest strain"), ("has turned by 0",)),
        ("large_strain", 150.0, (), ("leaves", "turned", "compressed")),
    ],
)
def test_run_warns_when_first_seen_and_at_the_end(
    theory: str, load: float, said: tuple[str, ...], silent: tuple[str, ...], tmp_path: Path
) -> None:
    run_scene(driven(theory, load), out=tmp_path / "run", progress=False)
    log = (tmp_path / "run" / "log.txt").read_text().splitlines()
    notes = [line for line in log if " note: " in line]
    for words in said:
        first, last = (line for line in notes if words in line)
        assert " t = 0." in first and " t = " not in last
    assert not [line for line in notes for words in silent if words in line]
