"""The example of the README runs and finds the weight of its plank."""

import re
from pathlib import Path
from typing import Any

README = Path(__file__).parents[1] / "README.md"


def test_the_library_example_carries_the_plank() -> None:
    (example,) = re.findall(r"```python\n(.*?)```", README.read_text(), flags=re.S)
    names: dict[str, Any] = {}
    exec(compile(example, "README.md", "exec"), names)
    weight = 9.81 * 1000.0 * 0.1 * 0.01
    # what is left after one second is the ringing of a bed without global damping
    assert abs(names["model"].reaction[1] / weight - 1.0) < 0.02
    top_of_bed = (names["grains"].y + names["grains"].radius)[: names["grains"].n_free].max()
    assert 0.0 < names["plank"].centroid()[1] < top_of_bed + 0.02
