"""The stiffness ratio of the contacts that are closed, against mass matrices and bodies known otherwise."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from independent_beam import IndependentBeam
from small_models import discs_on_free_beam

from coupled.report import cautions
from coupled.build import Built, build
from coupled.running.observe import observe
from coupled.output.history import read_history
from coupled.running.run import run_scene
from coupled.scene import Scene, load_scene


def ratio_of(built: Built) -> float:
    return observe(built.model, None).numbers["stiffness_ratio"]


def test_a_beam_on_all_its_springs_has_the_ratio_that_was_expected() -> None:
    own = IndependentBeam(length=1.0, height=0.05, along=40, across=2, young=70e9, poisson=0.35)
    fastest = own.fastest_on_springs(np.linspace(0.0, 1.0, 121), 1.97e7, 2700.0)
    built = build(load_scene("winkler_beam", ["structure.loads.0.schedule.over=1e-3"]))
    assert ratio_of(built) == 0.0, "grains just touch"
    built.model.advance(200)
    expected = 2e-5**2 * fastest * (1.0 + 2.0 * 156.24 / (1.97e7 * 2e-5))
    # Lanczos is below; its error falls with the square of the steps
    assert 0.97 * expected < ratio_of(built) <= 1.001 * expected


@pytest.mark.parametrize("kind", ["glued", "facets"])
def test_springs_on_a_rigid_beam_feel_its_mass_and_inertia(kind: str) -> None:
    """Springs in both directions at arms (x, y) on three unknowns; one alone: ``H^2 k (1/m + (x^2 + y^2)/I)``."""
    step, k, m = 1e-5, 1e6, 0.2 * 0.02 * 1000.0
    inertia = m * (0.2**2 + 0.02**2) / 12
    standoff = 5e-3 / 3 if kind == "glued" else 0.0
    interface: dict[str, Any] = {"largest_stiffness_ratio": 100.0} | ({"kind": kind} if kind == "facets" else {})

    def rigid(places: list[float]) -> Built:
        discs = [[x, 0.01 + standoff - 1e-5, 0.0, 0.0, 0.0] for x in places]
        tables = discs_on_free_beam(discs, step=step, interface=interface).scene.model_dump(exclude_none=True)
        tables["structure"] = {
            "kind": "free_rigid", "density": 1000.0, "beam": tables["structure"]["beam"],
            "placement": tables["structure"]["placement"],
        }  # fmt: skip
        return build(Scene.model_validate(tables))

    assert ratio_of(rigid([0.5])) == 0.0
    for places in ([0.0], [0.09], [-0.09, 0.09], [-0.03, 0.0, 0.09]):
        reach = np.concatenate([[[1.0, 0.0, -0.01], [0.0, 1.0, x]] for x in places])  # of (x, y, angle) at the face
        expected = step**2 * k * np.linalg.eigvals(reach.T @ reach / [[m], [m], [inertia]]).real.max()
        assert ratio_of(rigid(places)) == pytest.approx(expected, rel=1e-6)


def test_the_ratio_is_a_column_of_the_history_and_its_limit_is_told(tmp_path: Path) -> None:
    tables = discs_on_free_beam([[0.0, 0.03, 0.0, -3.0, 0.0]], step=2e-6).scene.model_dump(exclude_none=True)
    tables["time"] |= {"duration": 8e-3}
    tables["contact"] = {"normal": "hertz", "hertz_stiffness": 2e8, "restitution": 1.0}
    tables["structure"]["density"] = 50.0
    tables["interface"]["largest_stiffness_ratio"] = 100.0
    tables["output"] = {"history_interval": 1e-4, "frames_per_second": 0.0, "figures": False}
    scene = Scene.model_validate(tables)
    run_scene(scene, out=tmp_path / "run", threads=1, progress=False)
    seen = read_history(tmp_path / "run" / "history.csv")["stiffness_ratio"]
    assert seen[0] == 0.0 and seen.max() > 0.0
    built = build(scene)
    expected = built.stiffness_ratio
    said = cautions.beyond_exchange(built, {"stiffness_ratio": 2.5})
    assert "r = 2.5, above 2" in said["stiffness_ratio"] and f"{expected:.3g} was expected" in said["stiffness_ratio"]
    assert cautions.beyond_exchange(built, {"stiffness_ratio": 1.9}) == {}
