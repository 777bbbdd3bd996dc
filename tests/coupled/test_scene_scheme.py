"""The schemes of time integration in a scene: read, written, refused, and told by the ledger."""

from pathlib import Path

import numpy as np
import pytest
from bad_scenes import RIGID, TUBE, Case, require_refusal

import structure as fem
from coupled.balance import take_balance
from coupled.build import build
from coupled.scene import dump_scene, load_scene

CASES: dict[str, Case] = {
    "two schemes": (
        TUBE,
        {"structure.newmark": {}, "structure.hht": {"alpha": -0.1}},
        "structure.hht",
        ("together with structure.newmark", "keep one"),
    ),
    "two that dissipate": (
        TUBE,
        {"structure.generalised_alpha": {}, "structure.hht": {}},
        "structure.hht",
        ("together with structure.generalised_alpha",),
    ),
    "radius above one": (
        TUBE,
        {"structure.generalised_alpha": {"spectral_radius": 1.5}},
        "structure.generalised_alpha.spectral_radius",
        ("at most 1", "factor of a step"),
    ),
    "alpha too negative": (TUBE, {"structure.hht": {"alpha": -0.5}}, "structure.hht.alpha", ("at least -0.333",)),
    "scheme of a rigid body": (
        RIGID,
        {"structure.generalised_alpha": {}},
        "structure.generalised_alpha",
        ("means nothing",),
    ),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_bad_schemes_are_refused(case: Case, tmp_path: Path) -> None:
    require_refusal(case, tmp_path)


@pytest.mark.parametrize(
    ("tables", "scheme"),
    [
        ({}, fem.Newmark()),
        ({"newmark": {"beta": 0.3025, "gamma": 0.6}}, fem.Newmark(beta=0.3025, gamma=0.6)),
        ({"generalised_alpha": {}}, fem.GeneralizedAlpha(spectral_radius=0.8)),
        ({"generalised_alpha": {"spectral_radius": 0.5}}, fem.GeneralizedAlpha(spectral_radius=0.5)),
        ({"hht": {"alpha": -0.1}}, fem.HilberHughesTaylor(alpha=-0.1)),
    ],
)
def test_scene_chooses_the_scheme_and_the_ledger_closes(tables: dict, scheme: fem.Scheme, tmp_path: Path) -> None:
    """A beam let go from a bent shape, 400 steps; what is written down reads back the same."""
    sets = [f"structure.{table}.{key}={value}" for table, keys in tables.items() for key, value in keys.items()]
    sets += [f"structure.{table}={{}}" for table, keys in tables.items() if not keys]
    scene = load_scene("beam_vibration", sets)
    (tmp_path / "scene.toml").write_text(dump_scene(scene))
    assert load_scene(tmp_path / "scene.toml") == scene
    model = build(scene).model
    assert model.structure.scheme == scheme
    start = take_balance(model, None, None).entries
    model.advance(400)
    end = take_balance(model, None, start)
    assert ("structure_loss_scheme" in end.entries) == (not scheme.conserves)
    if not scheme.conserves:
        assert end.entries["structure_loss_scheme"] > 0.0
    # Round-off of 400 solutions: 1e-10 to 1.3e-9 J/m, whichever the order of operations; what is forgotten shows above 1e-6.
    assert abs(end.error) < 4e5 * np.finfo(float).eps * start["structure_strain"]
