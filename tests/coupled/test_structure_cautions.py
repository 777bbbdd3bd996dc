"""What is said of a structure before it moves, and where its theory ends, against numbers that are measured here."""

import math
from pathlib import Path
from typing import Any

import pytest
from beam_on_bed import BEAM, GLUED, beam_on_bed

import meshes
from coupled.build import build
from coupled.errors import LeitoError
from coupled.report import cautions
from coupled.report.locking import bending_stiffness_ratio
from coupled.running.run import run_scene
from coupled.running.watchdog import Unstable
from coupled.scene import Scene
from coupled.scene.shape import Beam
from structure import ElasticStructure, PlaneStrain


@pytest.mark.parametrize(
    ("cell", "within"),
    # of ratios from 1.1 to 107; what is left is the beam's shear and, for triangles, the height that cannot curve
    [("quadrilateral", 0.03), ("triangle", 0.25)],
)
@pytest.mark.parametrize("shape", [(1e-3, 100, 1), (0.01, 100, 1), (0.05, 40, 2), (0.05, 40, 4), (0.02, 10, 2)])
def test_locking_is_told_as_the_frequency_shows_it(cell: str, within: float, shape: tuple[float, int, int]) -> None:
    """First frequency of a free beam of length 1: (4.730)^2/(2 pi) sqrt(E' H^2/12/rho)."""
    height, along, across = shape
    mesh = meshes.beam(length=1.0, height=height, along=along, across=across, cell=cell)
    material = PlaneStrain(youngs_modulus=1e9, poissons_ratio=0.3, density=1000.0)
    body = ElasticStructure(mesh, material=material, time_step=1e-6, element="standard")
    slender = 4.730040745**2 / (2 * math.pi) * math.sqrt(1e9 / (1 - 0.3**2) * height**2 / 12 / 1000.0)
    seen = (body.frequencies(1)[0] / slender) ** 2
    told = bending_stiffness_ratio(Beam(length=1.0, height=height, along=along, across=across, cell=cell), 0.3)
    assert told == pytest.approx(seen, rel=within)


def alone(structure: dict[str, Any], **tables: Any) -> dict[str, Any]:
    """An elastic beam without anything around it."""
    base = beam_on_bed(structure={"placement": {"x": 0.0, "y": 0.0}} | structure, **tables)
    return {key: base[key] for key in ("title", "time", "structure", "output")}


def test_a_brake_within_a_step_is_told() -> None:
    def said(factor: float) -> str:
        return " ".join(cautions.before(build(Scene.model_validate(alone({"rayleigh": {"mass_factor": factor}})))))

    assert "brakes every motion" in said(4.1e4) and "brakes" not in said(3.9e4)  # 2/5e-5 s


def test_walls_without_grains_are_told() -> None:
    scene = alone({"placement": {"x": 0.15, "y": 0.5}}) | {"box": {"width": 0.3, "height": 1.0}}
    assert "the structure goes through them" in " ".join(cautions.before(build(Scene.model_validate(scene))))


@pytest.mark.parametrize("substeps", [1, 10])
def test_the_step_that_is_named_is_within_the_limit_and_not_far_below(substeps: int) -> None:
    """With dashpots r grows more slowly than the square of the step."""

    def scene(step: float) -> Scene:
        return Scene.model_validate(beam_on_bed(step=step, interface=GLUED | {"substeps": substeps}))

    with pytest.raises(LeitoError) as caught:
        build(scene(2.5e-4))
    told = float(str(caught.value).partition("take time.step at most ")[2].split(" s")[0])
    limit = float(str(caught.value).partition("is above ")[2].split(",")[0])
    assert 0.8 * limit < build(scene(told)).stiffness_ratio <= limit


def test_a_body_that_turns_far_beyond_the_linear_theory_is_stopped(tmp_path: Path) -> None:
    """A couple turns it from rest: it grows like 1/cos of the angle, and had gone on with a note."""
    pull = [{"kind": "point", "point": [x, 0.0], "force": [0.0, 2e4 * x]} for x in (-0.1, 0.1)]
    scene = alone({"loads": pull, "beam": BEAM}, duration=0.02)
    with pytest.raises(
        Unstable, match="has turned by 0.5[0-9]* rad, which the linear theory does not follow"
    ) as caught:
        run_scene(Scene.model_validate(scene), out=tmp_path / "run", threads=1, progress=False)
    assert "a theory that goes farther" in str(caught.value)
