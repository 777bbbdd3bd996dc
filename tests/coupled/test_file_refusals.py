"""Scene files that are missing, broken, or name beds that cannot be: refused in one sentence."""

from __future__ import annotations

import pytest
import tomli_w
from bad_scenes import GRAINS, changed

from coupled.scene import SceneError, load_scene


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"absent\.toml: there is no such file"):
        load_scene(tmp_path / "absent.toml")


def test_unknown_name_suggests_the_nearest_scene():
    with pytest.raises(SceneError, match="did you mean 'elastic_tube'"):
        load_scene("elastic_tueb")


def test_broken_toml_is_refused_with_its_line(tmp_path):
    path = tmp_path / "broken.toml"
    path.write_text('title = "broken"\n[time\nstep = 1e-5\n')
    with pytest.raises(SceneError, match=r"broken\.toml: .*not valid TOML.*line 2"):
        load_scene(path)


def test_two_beds_that_name_each_other_are_refused(tmp_path):
    for name, other in (("one", "two"), ("two", "one")):
        scene = {**GRAINS, "grains": {"bed": other}}
        (tmp_path / f"{name}.toml").write_text(tomli_w.dumps(scene))
    with pytest.raises(SceneError, match="leads back to this scene"):
        load_scene(tmp_path / "one.toml")


def test_error_inside_a_bed_names_the_file_of_the_bed(tmp_path):
    bad = changed(GRAINS, {"grains.density": -1.0})
    (tmp_path / "soil.toml").write_text(tomli_w.dumps(bad))
    (tmp_path / "scene.toml").write_text(tomli_w.dumps({**GRAINS, "grains": {"bed": "soil"}}))
    with pytest.raises(SceneError, match=r"^soil\.toml: grains\.density = -1"):
        load_scene(tmp_path / "scene.toml")
