"""What a user is told of Rayleigh's stiffness factor."""

import pytest

from coupled.report import cautions
from coupled.build import build
from coupled.scene import load_scene


@pytest.mark.parametrize(
    ("factor", "words"),
    [("3e-3", "all modes of this structure, whose lowest is at"), ("1e-5", "; the lowest of this structure is at")],
)
def test_over_damping_is_told_with_the_lowest_mode(factor: str, words: str) -> None:
    """The lowest mode of the beam, 270 Hz, is over-damped where 2/c_b is below 2 pi times that, c_b above 1.2e-3 s."""
    scene = load_scene("beam_vibration", [f"structure.rayleigh={{stiffness_factor={factor}}}"])
    (sentence,) = (said for said in cautions.before(build(scene)) if "over-damps" in said)
    assert words in sentence
    lowest = float(sentence.split("lowest")[1].split(" at ")[1].split(" Hz")[0])
    assert 200.0 < lowest < 300.0
