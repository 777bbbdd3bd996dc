"""What a study leaves: study.csv, study.md, pictures, from settings with known errors and times."""

from __future__ import annotations

import csv

import matplotlib.image
import numpy as np
import pytest
from study_cases import QUANTITY, exactly, ran

from coupled.study.judging.errors import judge
from coupled.study.pages.labels import Label, write_labels
from coupled.study.pages.picture import draw_front
from coupled.study.pages.table import percent, rows, without_result, write_csv
from coupled.study.pages.words import Told, text_of
from coupled.study.settings.knobs import BY_NAME
from coupled.study.settings.setting import Ran, Setting

RIGHT = exactly(1.0)
UNITS = {QUANTITY: "mm"}


@pytest.fixture
def settings():
    """Errors fall with the square of the step, times with its inverse; one that is slow and bad, one refused."""
    done = [
        ran("step = 4", 1.0, [1.16], knob=("step", "4")),
        ran("step = 2", 2.0, [1.04], knob=("step", "2")),
        ran("as it is", 4.0, [1.01], role="base"),
        ran("step = 0.5", 8.0, [1.0025], knob=("step", "0.5")),
        ran("mesh = 2", 16.0, [1.01], knob=("mesh", "2")),
    ]
    refused = Ran(
        setting=Setting(name="step = 9", role="knob", knobs=(("step", "9"),)), status="refused",
        message="time.step = 9 is above the stability limit, choose less",
    )  # fmt: skip
    return [*done, refused]


@pytest.fixture
def judged(settings):
    return {QUANTITY: [judge(item, QUANTITY, RIGHT, chance=False) for item in settings if item.done]}


def told(settings, judged, tmp_path, **more):
    given = dict(
        title="a drop", seeds=(), rans=settings, judged=judged,
        references={QUANTITY: RIGHT}, units=UNITS, knobs={BY_NAME["step"]: 1.0, BY_NAME["mesh"]: 1.0},
        pictures={QUANTITY: tmp_path / "front.png"},
    )  # fmt: skip
    return text_of(Told(**(given | more)))


def test_csv_has_a_row_per_setting_and_reads_back_with_all_digits(settings, judged, tmp_path):
    write_csv(tmp_path / "study.csv", settings, judged, {QUANTITY: RIGHT}, UNITS)
    with open(tmp_path / "study.csv", newline="") as file:
        found = {row["setting"]: row for row in csv.DictReader(file)}
    assert set(found) == {item.setting.name for item in settings}
    assert float(found["step = 2"]["error"]) == judged[QUANTITY][1].error
    assert {name for name, row in found.items() if row["on_front"] == "True"} == {
        "step = 4", "step = 2", "as it is", "step = 0.5",
    }  # fmt: skip
    assert found["step = 9"]["status"] == "refused" and "stability limit" in found["step = 9"]["message"]


def test_terminal_goes_from_fast_to_slow_and_stars_the_front(settings, judged):
    table = rows(judged, UNITS)
    assert [row[1] for row in table] == ["step = 4", "step = 2", "as it is", "step = 0.5", "mesh = 2"]
    assert [row[-1] for row in table] == ["*"] * 4 + [""]
    assert without_result(settings) == ["step = 9: refused: time.step = 9 is above the stability limit, choose less"]


def test_text_says_order_price_and_what_is_dominated(settings, judged, tmp_path):
    text = told(settings, judged, tmp_path)
    assert "order 2.00" in text
    # 7 s for the factor 64 in error: 7/1.806
    assert "3.9 s per decade" in text
    assert '"mesh = 2" by "step = 0.5"' in text and "buys no accuracy" in text
    assert "step = 9: refused: time.step = 9 is above" in text
    assert "Wall and processor time" not in text


def test_text_tells_of_a_machine_at_work_for_others(settings, judged, tmp_path):
    busy = [
        Ran(setting=item.setting, status="done", values=item.values, wall_seconds=1.3, cpu_seconds=1.0)
        for item in settings
        if item.done
    ]
    assert "Wall and processor time of 5 of 5" in told(busy, judged, tmp_path)


def test_text_says_when_a_knob_of_speed_changes_results(judged, tmp_path):
    def threads(same):
        return Ran(
            setting=Setting(name="threads = 2", role="knob", knobs=(("threads", "2"),), threads=2), status="done",
            values={QUANTITY: (1.0,)}, wall_seconds=1.0, cpu_seconds=2.0, same_bits=same,
        )  # fmt: skip

    assert "the same bits as" in told([threads(True)], judged, tmp_path)
    assert "NOT the same bits" in told([threads(False)], judged, tmp_path)


@pytest.mark.parametrize(("error", "half_width", "shown"), [(0.0123, 0.0, "+1.2 %"), (-0.5, 0.01, "-50 +- 1 %")])
def test_percent(error, half_width, shown):
    assert percent(error, half_width) == shown


def test_picture_has_ink_where_settings_are(settings, judged, tmp_path):
    path = tmp_path / "front.png"
    draw_front(path, "a drop", judged[QUANTITY])
    pixels = matplotlib.image.imread(path)
    assert pixels.shape[0] > 500 and (pixels[..., :3].min(axis=2) < 0.5).mean() > 0.002


def test_labels_of_points_close_by_do_not_cover_each_other():
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.0, 4.0))
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    write_labels(axes, [Label(text, 0.5, 0.5 + 0.01 * k) for k, text in enumerate(("first", "second", "third"))])
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in axes.texts]
    overlaps = [a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[k + 1 :]]
    plt.close(figure)
    assert len(boxes) == 3 and not np.any(overlaps)
