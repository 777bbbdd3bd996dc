"""Moving pictures of a run: grains coloured by where they lay at the start, intruders, the structure, moving walls."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coupled.errors import LeitoError
from coupled.measuring.record import FREE, Floats, Frame, Record
from coupled.report.drawing import AbstractMovieWriter, Axes, FFMpegWriter, Line2D, PillowWriter, PolyCollection, plt
from coupled.report.raster import Canvas
from coupled.scene.grains import USUAL_WALLS

Arrays = dict[str, np.ndarray]

LAYERS = 8
MOST_FRAMES = 200  # of a film whose `every` is not given
FASTEST = 25.0  # frames per second of the film
WIDTH, HIGHEST, NARROWEST, DPI = 6.4, 6.4, 4.0, 100  # inches of the picture
TITLE, LETTERS = 0.45, 14  # inches, letters per inch
INTRUDER, PRESCRIBED = (200, 30, 45), (110, 110, 110)
SHADES = (
    (68, 101, 137), (126, 166, 196), (196, 216, 226), (240, 228, 190),
    (226, 190, 120), (197, 142, 84), (150, 98, 66), (92, 64, 51),
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class View:
    """What is seen: corners [m], and colours (n, 3) of the grains."""

    low: Floats
    high: Floats
    colours: np.ndarray | None


def animate(folder: Path, *, out: Path | None = None, every: int | None = None, seconds: float | None = None) -> Path:
    """Draw the frames of a run as a film.

    Parameters
    ----------
    folder : Path
        Of the run.
    out : Path, optional
        A .gif, or an .mp4 where ffmpeg is installed; absent: ``figures/animation.gif`` of the run.
    every : int, optional
        Show every n-th frame; absent: as few are left out as a film of `MOST_FRAMES` asks for.
    seconds : float, optional
        Length of the film [s]; absent: a tenth of a second per frame, 10 s at most.

    Raises
    ------
    LeitoError
        If there is nothing to show, or the film cannot be written in that format.
    """
    record = Record(folder)
    total = max(len(record.frame_paths(name)) for name in ("grains", "structure"))
    if total < 2:
        held = f"{total} frame{'s' * (total != 1)}"
        raise LeitoError(f"{folder} holds {held}; a film needs two: run it with a larger output.frames_per_second")
    step = every if every is not None else -(-total // MOST_FRAMES)
    shown = len(range(0, total, step))
    if shown < 2:
        raise LeitoError(f"--every {step} leaves {shown} of {total} frames; give at most {total - 1}")
    length = seconds if seconds is not None else min(10.0, 0.1 * shown)
    target = out if out is not None else folder / "figures" / "animation.gif"
    target.parent.mkdir(parents=True, exist_ok=True)
    _film(record, target, _writer(target, min(FASTEST, shown / length)), step)
    return target


def _writer(target: Path, rate: float) -> AbstractMovieWriter:
    kind = target.suffix.lower()
    if kind == ".gif":
        return PillowWriter(fps=rate)
    if kind != ".mp4":
        raise LeitoError(f"--out {target}: a film is a .gif or an .mp4; give one of these endings")
    if not FFMpegWriter.isAvailable():
        raise LeitoError(
            f"--out {target}: an .mp4 needs the program ffmpeg, which is not found; install it (on Debian: apt-get "
            "install ffmpeg), or give a .gif"
        )
    return FFMpegWriter(fps=rate)


def _film(record: Record, target: Path, writer: AbstractMovieWriter, every: int) -> None:
    view = _view(record, every)
    shape = float((view.high - view.low)[1] / (view.high - view.low)[0])
    tall = min(WIDTH * shape, HIGHEST)
    figure = plt.figure(figsize=(max(tall / shape, NARROWEST), max(tall, 0.15 * WIDTH) + TITLE), dpi=DPI)
    height = figure.get_figheight()
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0 - TITLE / height))
    axes.set(xlim=(view.low[0], view.high[0]), ylim=(view.low[1], view.high[1]), aspect="equal")
    axes.axis("off")
    canvas = Canvas(view.low, view.high, round(tall / shape * DPI))
    picture = axes.imshow(
        canvas.image(), origin="lower", extent=(view.low[0], view.high[0], view.low[1], view.high[1]), aspect="equal"
    )
    cells = PolyCollection([], facecolors="#4d5a63", edgecolors="#20262b", linewidths=0.4)
    axes.add_collection(cells)
    walls = _draw_walls(record, axes)
    title = figure.text(0.5, 1.0 - 0.5 * TITLE / height, "", ha="center", va="center", fontsize=9)
    said = textwrap.shorten(record.title, round(LETTERS * figure.get_figwidth()), placeholder=" ...")
    with writer.saving(figure, str(target), DPI):
        for time, grains, structure in _moments(record, every):
            if grains is not None:
                canvas.clear()
                _paint(canvas, record, grains, view.colours)
                picture.set_data(canvas.image())
            if structure is not None:
                cells.set_verts(_outlines(structure))
            for name, line, home in walls:
                line.set_data(*(home + record.moved(time, name)).T)
            title.set_text(f"{said}\n{_clock(record, time)}")
            writer.grab_frame()
    plt.close(figure)


def _moments(record: Record, every: int) -> Iterator[tuple[float, Arrays | None, Arrays | None]]:
    """Time [s], arrays of the grains, arrays of the structure."""
    names = [name for name in ("grains", "structure") if record.frame_paths(name)]
    for moment in zip(*(record.frames(name, every) for name in names), strict=False):
        arrays = dict(zip(names, (frame[1] for frame in moment), strict=True))
        yield moment[0][0], arrays.get("grains"), arrays.get("structure")


def _view(record: Record, every: int) -> View:
    """Corners that hold all that is seen in some ten of the frames, and the colours by height in the first."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for name in ("grains", "structure"):
        count = len(record.frame_paths(name))
        for _, arrays in record.frames(name, max(1, count // 10)):
            points, reach = _places(record, arrays), arrays.get("radius", np.zeros(len(arrays["points"])))[:, None]
            low, high = np.minimum(low, (points - reach).min(axis=0)), np.maximum(high, (points + reach).max(axis=0))
    box = record.box
    if box is not None:
        aside = record.moved(np.append(record.frame_times("grains"), 0.0), "left", "right")[:, 0]
        low[0], high[0] = min(low[0], aside.min()), max(high[0], box["width"] + aside.max())
        for axis, length in enumerate(record.period):
            if length is not None:
                low[axis], high[axis] = 0.0, length
    margin = 0.02 * float((high - low).max()) * np.array([length is None for length in record.period])
    first = next(record.frames("grains", 1), None)
    return View(low=low - margin, high=high + margin, colours=_colours(record, first))


def _places(record: Record, arrays: Arrays) -> Floats:
    """Points (n, 2) of a frame where they are shown [m]: displaced, and folded into periodic sides."""
    points = np.array(arrays["points"], float)
    if "displacement" in arrays:
        points += arrays["displacement"][:, :2]
    for axis, length in enumerate(record.period):
        if length is not None:
            points[:, axis] %= length
    return points


def _colours(record: Record, first: Frame | None) -> np.ndarray | None:
    """Of each grain: its layer at the start, layers of equal numbers of grains."""
    if first is None:
        return None
    _, arrays = first
    body, y = arrays["body"], arrays["points"][:, 1]
    colours = np.tile(np.array(PRESCRIBED, np.uint8), (len(y), 1))
    free = np.nonzero(body == FREE)[0]
    rank = np.empty(len(free), np.int64)
    rank[np.argsort(y[free], kind="stable")] = np.arange(len(free))
    colours[free] = np.array(SHADES, np.uint8)[rank * LAYERS // max(len(free), 1)]
    colours[record.intruder_places(body)] = INTRUDER
    return colours


def _paint(canvas: Canvas, record: Record, arrays: Arrays, colours: np.ndarray | None) -> None:
    points, radius = _places(record, arrays), np.asarray(arrays["radius"], float)
    shifts = [(0.0,) if length is None else (-length, 0.0, length) for length in record.period]
    for shift_x in shifts[0]:
        for shift_y in shifts[1]:
            canvas.discs(points + np.array([shift_x, shift_y]), radius, colours)


def _outlines(arrays: Arrays) -> np.ndarray:
    """Corners (m, 3 or 4, 2) of the cells where they are now [m]."""
    corners = arrays["cells"][:, : 4 if arrays["cells"].shape[1] in (4, 9) else 3]
    return (arrays["points"] + arrays["displacement"][:, :2])[corners]


def _draw_walls(record: Record, axes: Axes) -> list[tuple[str, Line2D, Floats]]:
    """Floor, lid and sides of the box by name, as lines with their ends (2, 2) at home [m]."""
    box = record.box
    if box is None:
        return []
    width, height = box["width"], box["height"]
    ends = {
        "floor": [(0.0, 0.0), (width, 0.0)],
        "lid": [(0.0, height), (width, height)],
        "left": [(0.0, 0.0), (0.0, height)],
        "right": [(width, 0.0), (width, height)],
    }
    lines = []
    for name in box.get("walls", USUAL_WALLS):
        home = np.array(ends[name])
        (line,) = axes.plot(*home.T, color="0.25", linewidth=1.4)
        lines.append((name, line, home))
    return lines


def _clock(record: Record, time: float) -> str:
    shaken = record.shaken
    if shaken is None:
        return f"t = {time:.4g} {record.time_unit.replace('-', '')}"
    return f"Gamma = {shaken.gamma:.3g}, period {max(0.0, (time - shaken.start) / shaken.period):.1f}"
