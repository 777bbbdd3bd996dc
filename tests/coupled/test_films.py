"""Films of runs: discs painted where they are, as many pictures as asked for, refusals in a sentence."""

import json
import math
import shutil
import subprocess

import numpy as np
import pytest
from PIL import Image
from shaken_record import make
from typer.testing import CliRunner

from coupled.cli.app import app
from coupled.errors import LeitoError
from coupled.report.animation import INTRUDER, animate
from coupled.report.drawing import FFMpegWriter
from coupled.report.raster import Canvas


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return make(tmp_path_factory.mktemp("film") / "run", np.full(12, 0.1))


@pytest.mark.parametrize("radius", [0.02, 0.3])  # some pixels, and beyond the stamps
def test_a_disc_covers_its_area_about_its_centre(radius):
    canvas = Canvas(np.array([0.0, 0.0]), np.array([2.0, 1.0]), 400)
    canvas.discs(np.array([[1.3, 0.4]]), np.array([radius]), np.array([[0, 0, 0]], np.uint8))
    dark = 1.0 - canvas.image()[:, :, 0] / 255.0
    assert dark.shape == (200, 400)
    r = 200.0 * radius
    # the outline crosses 8 r sub-pixels of a quarter of a pixel, each off by half of it at random
    assert dark.sum() == pytest.approx(math.pi * r**2, abs=3.0 * 0.25 * 0.5 * math.sqrt(8.0 * 2.0 * r))
    rows, columns = np.indices(dark.shape) + 0.5
    assert (dark * columns).sum() / dark.sum() == pytest.approx(260.0, abs=0.2)
    assert (dark * rows).sum() / dark.sum() == pytest.approx(80.0, abs=0.2)


def test_later_discs_lie_on_earlier_ones_and_what_is_outside_is_cut():
    canvas = Canvas(np.array([0.0, 0.0]), np.array([1.0, 1.0]), 50)
    red, blue = [255, 0, 0], [0, 0, 255]
    canvas.discs(np.array([[0.5, 0.5], [0.5, 0.5], [0.0, 1.0], [9.0, 9.0]]), np.array([0.3, 0.15, 0.1, 1.0]),
                 np.array([red, blue, red, blue], np.uint8))  # fmt: skip
    image = canvas.image()
    assert image[25, 25].tolist() == blue and image[25, 37].tolist() == red
    assert image[49, 0].tolist() == red and image[0, 49].tolist() == [255, 255, 255]


def test_a_film_has_the_frames_asked_for_in_the_time_asked_for(run, tmp_path):
    whole = animate(run)
    assert whole == run / "figures" / "animation.gif"
    with Image.open(whole) as film:
        assert film.n_frames == 6
    half = animate(run, out=tmp_path / "half.gif", every=2, seconds=1.5)
    with Image.open(half) as film:
        assert film.n_frames == 3 and film.info["duration"] == 500
        picture = np.array(film.convert("RGB")).astype(int)
    near = np.abs(picture - INTRUDER).sum(axis=2) < 40
    assert near.any()  # the intruder in its colour
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 8  # layers


@pytest.mark.skipif(not FFMpegWriter.isAvailable() or shutil.which("ffprobe") is None, reason="needs ffmpeg")
def test_an_mp4_has_the_frames_asked_for_in_the_time_asked_for(run, tmp_path):
    film = animate(run, out=tmp_path / "film.mp4", seconds=3.0)
    shown = "stream=codec_name,pix_fmt,nb_read_frames,r_frame_rate,width,height"
    asked = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", shown, "-of", "json", str(film)]
    stream = json.loads(subprocess.run(asked, capture_output=True, check=True, text=True).stdout)["streams"][0]
    assert (stream["nb_read_frames"], stream["r_frame_rate"]) == ("6", "2/1")
    assert (stream["codec_name"], stream["pix_fmt"]) == ("h264", "yuv420p"), "what browsers and slides can play"
    still = tmp_path / "still.png"
    subprocess.run(["ffmpeg", "-v", "error", "-i", str(film), "-vframes", "1", str(still)], check=True)
    picture = np.array(Image.open(still).convert("RGB")).astype(int)
    assert picture.shape == (stream["height"], stream["width"], 3)
    # colours are stored coarser than places, and compressed
    assert (np.abs(picture - INTRUDER).sum(axis=2) < 60).any()


def test_the_command_says_where_the_film_is(run, tmp_path):
    said = CliRunner().invoke(app, ["animate", str(run), "--out", str(tmp_path / "film.gif"), "--every", "3"])
    assert said.exit_code == 0 and said.output.strip() == str(tmp_path / "film.gif")
    assert (tmp_path / "film.gif").stat().st_size > 0


def test_refusals(run, tmp_path, monkeypatch):
    monkeypatch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda cls: False))
    for out, said in (
        ("film.mp4", "needs the program ffmpeg, .* apt-get install ffmpeg"),
        ("film.avi", "a .gif or an .mp4"),
    ):
        with pytest.raises(LeitoError, match=said):
            animate(run, out=tmp_path / out)
    with pytest.raises(LeitoError, match="--every 6 leaves 1 of 6 frames; give at most 5"):
        animate(run, every=6)
    with pytest.raises(LeitoError, match="holds no run"):
        animate(tmp_path)
    short = make(tmp_path / "short", np.full(3, 0.1), frames=1)
    with pytest.raises(LeitoError, match="holds 1 frame; a film needs two: run it with a larger output.frames"):
        animate(short)
    with pytest.raises(LeitoError, match="there is no such folder"):
        animate(tmp_path / "nowhere")
