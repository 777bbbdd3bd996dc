"""`leito measure` on runs made by hand, whose rises, rolls and profiles are known."""

import csv
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from shaken_record import AMPLITUDE, FINE, PERIOD, RADIUS, ROWS, START, floor_at, make
from typer.testing import CliRunner

from coupled.cli.app import app
from coupled.errors import LeitoError
from coupled.measuring.findings import find
from coupled.measuring.measure import draw_run, measure, rows_told
from coupled.measuring.record import Record
from coupled.measuring.rises import Periods, height_over_floor, speed_over_floor
from coupled.measuring.samples import groups_of
from coupled.output.frames import Frames, read_frame

MEAN, SPREAD = 0.004, 0.02


@pytest.fixture(scope="module")
def ensemble(tmp_path_factory):
    """Four samples of one case, one of another."""
    folder, rng = tmp_path_factory.mktemp("ensemble"), np.random.default_rng(3)
    for seed in (1, 2, 3, 4):
        make(folder / "slow" / f"seed_{seed}", MEAN + SPREAD * rng.standard_normal(240), seed=seed, frames=2)
    other = make(folder / "fast" / "seed_1", np.full(240, 0.05), frames=2)
    text = (other / "scene.toml").read_text()
    (other / "scene.toml").write_text(text.replace("density = 1.0", "density = 1.1"))
    return folder


@pytest.fixture(scope="module")
def found(ensemble):
    return {one.group.label: one for one in find([ensemble], Periods())}


def test_samples_of_one_scene_are_one_case(found):
    assert {label: len(one.group.records) for label, one in found.items()} == {"slow": 4, "fast": 1}


def test_the_floor_is_taken_out_of_the_rise(found):
    (rise,) = found["fast"].rises
    np.testing.assert_allclose(rise.samples[0].rise, 0.05, atol=1e-12)
    np.testing.assert_allclose(rise.mean, 2.0 + 0.05 * np.arange(241), atol=1e-11)
    assert rise.rate.mean == pytest.approx(0.05, rel=1e-12) and np.isnan(rise.half_width).all()


def test_rise_and_symmetry_of_gaussian_increments(found):
    (rise,) = found["slow"].rises
    assert rise.rate.count == 4
    # 960 increments: four standard errors; and the truth lies in intervals of the 95 % that this seed is among
    assert rise.rate.mean == pytest.approx(MEAN, abs=4.0 * SPREAD / math.sqrt(960))
    assert abs(rise.rate.mean - MEAN) < rise.rate.half_width
    windows = rise.deviations
    assert windows.lengths[:3] == (1, 2, 4) and not windows.lacks
    slope, half = windows.slope
    assert abs(slope - 2.0 * MEAN / SPREAD**2) < 1.5 * half
    assert windows.settled == 1  # independent increments: single periods say it all
    transform = windows.tilted[1]
    known = np.isfinite(transform.rate)
    expected = 0.5 * ((transform.v - MEAN) / SPREAD) ** 2
    # about the mean the bars shrink to nothing: there the error is of second order, (error of the mean/spread)^2/2
    second = 0.5 * 3.0**2 / 960
    assert (np.abs(transform.rate - expected)[known] < 1.5 * transform.half_width[known] + second).all()
    assert found["fast"].rises[0].deviations.lacks.startswith("all windows have the same mean")


@pytest.mark.parametrize(("bars", "settled"), [(0.5, True), (-3.0, False)])
def test_a_slope_that_still_turns_with_the_windows_is_told_as_not_settled(found, bars, settled):
    one = found["slow"]
    (rise,) = one.rises
    last = next(each for each in reversed(rise.deviations.symmetries) if each.slope is not None)
    slope = (last.slope + bars * last.half_width, last.half_width)
    rows = rows_told([replace(one, rises=(replace(rise, deviations=replace(rise.deviations, slope=slope)),))])
    told = {what: value for _, what, value in rows}
    assert told[f"{rise.name}: slope of the symmetry, windows of {last.periods}"].startswith(f"{last.slope:.4g} +- ")
    line = told[f"{rise.name}: slope of the symmetry, by a line over 1/n"]
    assert line.startswith(f"{slope[0]:.4g} +- ") and line.endswith(", not settled") != settled


def test_rolls_and_profiles_of_the_frames(found):
    for one in found.values():
        a = 2.0 * math.pi / 8.0
        # rise 0.02 a cos(a x) sin(pi y/4), over the halves of the width and the height: see test_convection_and_strobe
        assert one.rolls.roll.mean == pytest.approx(2.0 * 0.02 * a * (2.0 / math.pi) ** 2, rel=1e-2)
        profiles = one.profiles
        inside = profiles.y < 1.3  # below the intruder and the upper edge of the lattice
        dense = 2 * FINE * FINE * math.pi * RADIUS**2 / 32.0
        # strips are 0.84 of the lattice's rows: their fractions beat about the mean of all
        assert np.mean(profiles.mean["packing"][inside]) == pytest.approx(dense, rel=0.05)
        assert (profiles.mean["coordination"][inside] == 4.0).all()
        assert np.nanmax(np.abs(profiles.mean["temperature"])) < 1e-20


def test_periods_are_chosen(ensemble):
    (fast, _) = find([ensemble], Periods(first=100, last=200))
    assert fast.group.label == "fast"
    (rise,) = fast.rises
    assert len(rise.samples[0].rise) == 100
    assert rise.mean[0] == pytest.approx(2.0 + 0.05 * 100) and rise.mean[-1] == pytest.approx(2.0 + 0.05 * 200)
    assert fast.rolls is None and "no frames of grains in the periods that count" in " ".join(fast.notes)


def test_tables_and_pictures(ensemble, tmp_path):
    found, written = measure([ensemble], out=tmp_path / "out", periods=Periods())
    names = {path.name for path in written}
    assert {"rises.csv", "height.csv", "profiles.csv", "convection.csv", "large_deviation.csv", "measures.json"} < names
    assert {"height.png", "rise_rate.png", "profiles.png", "convection_1.png", "large_deviation_2.png"} < names
    assert all(path.stat().st_size > 0 for path in written)
    with open(tmp_path / "out" / "rises.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 5 * 241
    last = [row for row in rows if row["case"] == "fast"][-1]
    assert float(last["height"]) == pytest.approx(14.0) and last["rise"] == ""
    numbers = {one["case"]: one for one in json.loads((tmp_path / "out" / "measures.json").read_text())}
    assert numbers["fast"]["gamma"] == pytest.approx(AMPLITUDE * (2.0 * math.pi / PERIOD) ** 2)
    assert numbers["slow"]["intruders"][0]["rise_per_period"]["samples"] == 4
    assert numbers["fast"]["intruders"][0]["rise_per_period"]["half_width"] is None


def test_a_run_is_measured_alone_and_too_short_a_one_says_what_is_missing(tmp_path):
    run = make(tmp_path / "run", np.full(30, 0.1))
    pictures = {path.name for path in draw_run(run, tmp_path / "pictures")}
    assert {"height.png", "rise_rate.png", "convection.png", "profiles.png", "portrait.png"} == pictures
    short = make(tmp_path / "short", np.full(0, 0.1), frames=1)
    (one,) = find([short], Periods())
    assert not one.rises and one.rolls is None and one.profiles is not None
    assert "run longer" in one.notes[0] and "of 1 frames" in one.notes[1]


def test_frames_off_the_phase_make_no_convection(tmp_path):
    run = make(tmp_path / "run", np.full(20, 0.1), frames=3, periods_per_frame=2)
    text = (run / "scene.toml").read_text()
    (run / "scene.toml").write_text(text.replace("period = 4.0", "period = 3.0"))
    (one,) = find([run], Periods())
    assert one.rolls is None
    assert any("2.67 periods apart at most" in note and "set output.frames_per_second" in note for note in one.notes)


@pytest.mark.parametrize(
    ("written", "instead", "said"),
    [
        ("[[intruders]]\nradius = 0.6\ndensity = 1.0\n", "", "run: the scene names no [[intruders]]: no rises"),
        ("[shaking]\namplitude = 0.5\nperiod = 4.0\nstart = 6.0\n", "", "run: no walls shake: no rises, no convection"),
        ("duration = 86.0", "duration = 500.0", "ends at t = 86 of 500: leito run with --resume goes on with it"),
    ],
)
def test_a_run_that_lacks_something_is_measured_for_the_rest_and_says_what(tmp_path, written, instead, said):
    run = make(tmp_path / "run", np.full(20, 0.1))
    text = (run / "scene.toml").read_text()
    assert written in text
    (run / "scene.toml").write_text(text.replace(written, instead))
    (one,) = find([run], Periods())
    assert one.profiles is not None and any(note.endswith(said) for note in one.notes)
    assert bool(one.rises) == ("duration" in written)


def test_refusals(tmp_path):
    with pytest.raises(LeitoError, match="no such folder"):
        groups_of([tmp_path / "nowhere"])
    (tmp_path / "file").write_text("")
    with pytest.raises(LeitoError, match="file is a file; give folders of runs"):
        groups_of([tmp_path / "file"])
    (tmp_path / "empty").mkdir()
    with pytest.raises(LeitoError, match="holds no run"):
        groups_of([tmp_path / "empty"])
    with pytest.raises(LeitoError, match="nothing to measure.*no frames"):
        find([make(tmp_path / "run", np.full(0, 0.1), frames=0)], Periods())
    run = make(tmp_path / "other", np.full(5, 0.1))
    (one,) = find([run], Periods(first=7))
    assert "holds 5 periods, none of them from 7 to the end" in one.notes[0]


def test_many_samples_are_drawn_whole_at_the_quietest_phase(tmp_path):
    """Samples rise at rates of their own on a swing of two periods: their spread grows with n, the swing fades."""
    rng, own = np.random.default_rng(5), 0.02
    for seed in range(1, 25):
        rises = 0.1 + own * rng.standard_normal() + 0.02 * rng.standard_normal(40)
        make(tmp_path / "all" / f"seed_{seed}", rises, seed=seed, frames=0, swing=lambda p: 0.5 * np.cos(np.pi * p))
    (one,) = find([tmp_path / "all"], Periods(phase=None))
    (rise,) = one.rises
    assert rise.phase == 0.5  # where the swing of two periods goes through zero at every look
    found = rise.deviations
    assert found.whole and found.lengths == (1, 2, 4, 8, 16)
    grown = found.moments[-1].variance
    # 0.02^2 (1 + 16): half a look is in each end of a window, which leaves 1 - 1/(2 n) of the noise
    assert abs(grown.value - 0.02**2 * (16.0 + 1.0)) < grown.half_width
    # that of 24 means; blocks within samples would take each for several
    assert found.moments[0].mean.half_width == pytest.approx(rise.rate.half_width, rel=0.15)
    (swung,) = find([tmp_path / "all"], Periods())[0].rises
    assert swung.deviations.moments[0].variance.value == pytest.approx(1.0, rel=0.02)  # up and down by 1, in turns
    assert [curve.periods for curve in swung.deviations.curves] == [2, 4, 8, 16]  # no single rise is near the mean
    assert swung.rate.mean == pytest.approx(rise.rate.mean, abs=2.0 * 0.5 / 40)
    _, written = measure([tmp_path / "all"], out=tmp_path / "swung", periods=Periods())
    assert tmp_path / "swung" / "large_deviation.png" in written
    _, written = measure([tmp_path / "all"], out=tmp_path / "out", periods=Periods(phase=None))
    assert tmp_path / "out" / "windows.csv" in written
    (numbers,) = json.loads((tmp_path / "out" / "measures.json").read_text())
    told = numbers["intruders"][0]
    assert (told["phase"], told["resampled"], len(told["moments"])) == (0.5, "samples", 5)


def test_the_command_tells_means_and_notes(ensemble, tmp_path):
    said = CliRunner().invoke(app, ["measure", str(ensemble), "--out", str(tmp_path / "out"), "--first", "20"])
    assert said.exit_code == 0, said.output
    assert "intruder: rise per period" in said.output and "4 samples" in said.output
    assert "convection" in said.output
    for phase in ("1.0", "loud"):
        wrong = CliRunner().invoke(app, ["measure", str(ensemble), "--phase", phase])
        assert isinstance(wrong.exception, LeitoError) and f"--phase {phase} must be a number" in str(wrong.exception)
    wrong = CliRunner().invoke(app, ["measure", str(ensemble), "--first", "20", "--last", "10"])
    assert isinstance(wrong.exception, LeitoError) and "--last 10 must be greater" in str(wrong.exception)


def test_walls_beside_a_floor_at_rest_do_not_lift_it(tmp_path):
    still = make(tmp_path / "still", np.full(40, 0.05))
    text = (
        (still / "scene.toml").read_text().replace('walls = ["floor"]\nperiodic = ["x"]', 'walls = ["left", "floor"]')
    )
    (still / "scene.toml").write_text(text + 'walls = ["left"]\n')
    record = Record(still)
    # the rows have the floor's motion in the intruder's height, as if something else had lifted it: it stays in
    np.testing.assert_allclose(height_over_floor(record, "intruder"), record.history["intruder_y"])
    assert (record.moved(8.0, "floor") == 0.0).all() and record.moved(8.0, "left")[1] == 2.0 * AMPLITUDE


def test_floor_is_where_the_shaking_says_between_rows_too(ensemble):
    record = Record(ensemble / "slow" / "seed_1")
    time = START + np.linspace(0.0, 2.0 * PERIOD, 31)
    np.testing.assert_allclose(record.box_moved(time)[:, 1], floor_at(time), atol=1e-12)


def test_rises_end_with_the_shaking(tmp_path):
    ended = make(tmp_path / "ended", np.append(np.full(20, 0.05), np.zeros(20)), frames=15)
    with open(ended / "scene.toml", "a") as file:
        file.write(f"stop = {START + 19.5 * PERIOD}\n")  # the period in hand is finished
    (found,) = find([ended], Periods())
    (rise,) = found.rises
    assert len(rise.samples[0].rise) == 20 and rise.rate.mean == pytest.approx(0.05, rel=1e-12)
    assert found.profiles.frames == 11  # two periods apart, both ends counted
    assert len(find([ended], Periods(last=40))[0].rises[0].samples[0].rise) == 40


@pytest.mark.parametrize("more", [[3.0 * PERIOD, 5.0 * PERIOD], [4.0 * PERIOD + 0.001, 6.4 * PERIOD]])
def test_frames_beside_the_usual_ones_do_not_hide_convection(tmp_path, more):
    """The last frame of a run that was prolonged later, and frames that follow each other closely."""
    run = make(tmp_path / "run", np.full(24, 0.05), frames=10)
    (alone,) = find([run], Periods())
    beside = Frames(run, "grains", keep_until=math.inf)
    _, arrays = read_frame(run / "frames" / "grains.000000.h5")
    points = arrays.pop("points")
    for time in more:
        beside.write(START + time, points + np.array([3.0, 0.0]), arrays)
    # frames of a folder are in the order of their numbers: put the new ones where their time is
    paths = sorted((run / "frames").glob("grains.*.h5"), key=lambda path: read_frame(path)[0])
    for k, path in enumerate(paths):
        path.rename(run / "frames" / f"grains.x{k:05d}.h5")
    (found,) = find([run], Periods())
    np.testing.assert_allclose(found.rolls.field.displacement, alone.rolls.field.displacement, atol=1e-12)


def test_the_floor_s_velocity_is_taken_out_of_the_portrait(tmp_path):
    """A grain that lies on the floor: the velocity of half a step later is the floor's."""
    run = make(tmp_path / "run", np.zeros(3))
    rows = (run / "history.csv").read_text().splitlines()
    step, names = 0.01, rows[0].split(",")
    told = [rows[0]]
    for row in rows[1:]:
        values = row.split(",")
        time = float(values[0])
        values[names.index("intruder_vy [m/s]")] = repr(float(floor_at(time + step) - floor_at(time)) / step)
        told.append(",".join(values))
    (run / "history.csv").write_text("\n".join(told) + "\n")
    # differences of numbers of 0.5 with 1e-16 over a step of 0.01
    np.testing.assert_allclose(speed_over_floor(Record(run), "intruder"), 0.0, atol=1e-13)


@pytest.mark.parametrize(("every", "first", "said"), [(ROWS, 10, 0), (ROWS, 3, 1), (2, 0, 0)])
def test_heights_between_far_rows_are_told(tmp_path, every, first, said):
    """One row a period on the phase of the looks, and off it; many rows."""
    run = make(tmp_path / "run", np.full(30, 0.05))
    rows = (run / "history.csv").read_text().splitlines()
    (run / "history.csv").write_text("\n".join([rows[0], *rows[1 + first :: every]]) + "\n")
    (found,) = find([run], Periods())
    assert sum("interpolated between rows" in note for note in found.notes) == said
