"""The key structure.element: written, refused where it does not fit, and handed to the structure."""

import re
from pathlib import Path

import pytest

from coupled.build import build
from coupled.report.cautions import before
from coupled.errors import SceneError
from coupled.scene import Structure, Tube, dump_scene, load_scene


@pytest.mark.parametrize(
    ("name", "overrides", "element"),
    [
        ("elastic_tube", [], "enhanced"),
        ("elastic_beam", [], "enhanced"),
        ("elastic_tube", ["structure.tube.order=2"], "standard"),
        ("elastic_tube", ["structure.tube.cell=triangle"], "standard"),
        ("elastic_beam", ["structure.beam.cell=triangle", "structure.beam.order=2"], "standard"),
        ("beam_vibration", [], "standard"),  # of order 2
        ("beam_vibration", ["structure.beam.order=1"], "enhanced"),
        ("elastic_tube", ["structure.element=standard"], "standard"),
        ("rigid_tube", [], None),
    ],
)
def test_scene_says_the_element_it_uses(name: str, overrides: list[str], element: str | None, tmp_path: Path) -> None:
    """Overrides included; what is written down reads back the same."""
    scene = load_scene(name, overrides)
    assert scene.structure.element == element
    (tmp_path / "scene.toml").write_text(dump_scene(scene))
    assert load_scene(tmp_path / "scene.toml") == scene


def test_tables_made_in_python_choose_alike() -> None:
    ring = {"outer_radius": 0.05, "inner_radius": 0.04}
    metal = {"youngs_modulus": 70e9, "poissons_ratio": 0.35, "density": 2700.0}
    for order, element in ((1, "enhanced"), (2, "standard")):
        assert Structure(kind="elastic", tube=Tube(**ring, order=order), **metal).element == element


@pytest.mark.parametrize(
    ("name", "overrides", "words"),
    [
        ("elastic_tube", ["structure.element=reduced"], ("'standard' or 'enhanced'",)),
        ("elastic_tube", ["structure.element=enhanced", "structure.tube.order=2"], ("of order 2", "change cell")),
        ("elastic_tube", ["structure.element=enhanced", "structure.tube.cell=triangle"], ("for a triangle",)),
        ("rigid_tube", ["structure.element=standard"], ('kind = "rigid"', "remove it")),
    ],
)
def test_element_that_does_not_fit_is_refused(name: str, overrides: list[str], words: tuple[str, ...]) -> None:
    with pytest.raises(SceneError) as refusal:
        load_scene(name, overrides)
    assert refusal.value.key == "structure.element"
    assert all(word in str(refusal.value) for word in words)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (["order=2"], None),
        (["order=1"], None),
        (["order=1", "nu=0.4999"], None),
        (["order=1", "element=standard"], 'order 1 lock: .* times as stiff.*"enhanced" or order = 2'),
        (["order=1", "cell=triangle"], 'order 1 lock.*"enhanced" or order = 2'),
        (["order=1", "theory=large_strain"], "times too high: take order = 2"),
        (["order=2", "nu=0.49"], "0.49 is near 0.5.*no stress to rely on"),
        (["order=1", "cell=triangle", "nu=0.49"], "0.49 is near 0.5.*no stress to rely on"),
    ],
)
def test_locking_is_told_before_a_run(overrides: list[str], words: str | None) -> None:
    path = {"order": "beam.order", "cell": "beam.cell", "nu": "poissons_ratio"}
    pairs = [override.split("=") for override in overrides]
    scene = load_scene("beam_vibration", [f"structure.{path.get(key, key)}={value}" for key, value in pairs])
    notes = before(build(scene))
    assert len(notes) == (words is not None)
    assert words is None or re.search(words, notes[0])


def test_element_reaches_the_structure() -> None:
    """The beam of the scene swings 8.7 % faster as locked cells than as enhanced ones (40 x 2 cells)."""
    found = {}
    for element in ("standard", "enhanced"):
        scene = load_scene("beam_vibration", ["structure.beam.order=1", f"structure.element={element}"])
        found[element] = build(scene).model.structure.frequencies(1)[0]
    assert found["standard"] > 1.05 * found["enhanced"]
