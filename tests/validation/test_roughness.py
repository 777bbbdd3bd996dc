"""`make validate`: the drag of a rigid plate over a bed, with glued grains of several spacings and with facets.

Glued grains make a smooth plate rough: the source names it as the drawback of its interface. Here a plate slides
over a bed under a constant load, with no freedom but that to rise and sink; the ratio of the two components of
the grains' force on it is the coefficient of friction that it sees. Writes `docs/validation/roughness.md`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
import pytest

from coupled.build import build
from coupled.model import Model
from coupled.scene import Scene

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

FOLDER = Path(__file__).parents[2] / "docs" / "validation"
RADII, SHARES, DENSITY, STEP, SUBSTEPS = (5.5e-3, 5e-3, 4.5e-3), (0.25, 0.5, 0.25), 2500.0, 5e-5, 4
DIAMETER, COUNT, LEFT, WIDTH = 1e-2, 400, 0.15, 0.4  # mean diameter; the bed, between two columns
LENGTH, HEIGHT, FACET = 0.7, 0.02, 0.02
BED_FRICTION, LOAD, PLATE_DENSITY, SPEED = 0.8, 2000.0, 2000.0, 0.1
PRESS, START = 0.15, 0.05  # s: the load comes; the plate takes its speed
ONSET, WAY = 0.04, 0.06  # m: not counted, counted
SLOW = 0.5  # of the speed, once more without friction
SEEDS, FRICTIONS, SPACINGS = (1, 2, 3), (0.0, 0.1, 0.3, 0.5), (1.0, 0.5, 0.25, 0.125)
GAPPED, GAPPED_FRICTIONS = (0.5, 0.25), (0.0, 0.3)  # glued diameters over a spacing of half a grain, and friction
CONTACT = {
    "normal_stiffness": 1e6,
    "restitution": 0.5,
    "tangential_stiffness": 5e5,
    "tangential_damping": 5.0,
    "friction": BED_FRICTION,
    "rolling_friction": 0.2,
    "rolling_damping_ratio": 0.3,
}


def rows(height: float) -> list[dict[str, object]]:
    """A rough floor and two columns up to `height` [m], of fixed discs."""
    radius, right = 5e-3, LEFT + WIDTH
    floor = {"start": (0.0, 0.0), "end": (LENGTH, 0.0), "count": round(LENGTH / 0.01) + 1, "radius": radius}
    count = max(2, round((height - 2 * radius) / 9e-3) + 1)
    columns = [
        {"start": (x, 2 * radius), "end": (x, height - radius), "count": count, "radius": radius} for x in (LEFT, right)
    ]
    return [floor, *columns]


def scene(radius: np.ndarray, places: np.ndarray) -> dict[str, object]:
    """Grains from the largest to the smallest, as tables of a scene."""
    sizes = [{"radius": size, "count": int(np.sum(radius == size))} for size in RADII]
    return {
        "title": "A plate over a bed",
        "gravity": (0.0, -9.81),
        "time": {"duration": 1.0, "step": STEP},
        "grains": {"sizes": sizes, "density": DENSITY, "layout": "list", "positions": places.tolist()},
        "contact": CONTACT,
    }


def bed(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Radii (n,) from the largest and places (n, 2) [m] of a bed that has settled between tall columns."""
    random = np.random.default_rng(seed)
    radius = np.repeat(RADII, [round(share * COUNT) for share in SHARES])
    columns, pitch = 33, 0.0117
    place = np.column_stack(
        [LEFT + 0.012 + pitch * (np.arange(COUNT) % columns), 0.012 + pitch * (np.arange(COUNT) // columns)]
    )
    places = random.permutation(place) + random.uniform(-3e-4, 3e-4, place.shape)
    tables = scene(radius, places) | {"rows": rows(0.2), "damping": {"translational": 5.0}}
    model = build(Scene.model_validate(tables)).model
    model.advance(round(1.0 / STEP))
    grains = model.particles.grains
    order = np.argsort(grains.number[:COUNT])
    return radius, np.column_stack([grains.x, grains.y])[:COUNT][order]


@dataclass(frozen=True)
class Face:
    """What the plate meets grains with: facets, or touching glued grains `spacing` [m] apart."""

    spacing: float | None
    diameter: float | None = None

    def table(self) -> dict[str, object]:
        own = {"boundaries": ["bottom"], "substeps": SUBSTEPS, "largest_stiffness_ratio": 10.0}
        if self.spacing is None:
            return own | {"kind": "facets"}
        own |= {"per_facet": round(FACET / self.spacing)}
        return own if self.diameter is None else own | {"diameter": self.diameter}

    @property
    def name(self) -> str:
        if self.spacing is None:
            return "facets"
        gap = "" if self.diameter is None else f", {self.diameter / self.spacing:g} of it wide"
        return f"glued, {self.spacing / DIAMETER:g} d apart{gap}"

    @property
    def steepest(self) -> float:
        """Slope of the way of one mean grain over two neighbours, where it leaves one for the other."""
        if self.spacing is None:
            return 0.0
        reach = (DIAMETER + (self.diameter or self.spacing)) / 2
        return self.spacing / 2 / np.sqrt(reach**2 - self.spacing**2 / 4)


@dataclass(frozen=True)
class Drag:
    """Forces (n, 2) [N/m] of the grains on the plate during the slide, and the height (n,) [m] of its face."""

    force: np.ndarray
    height: np.ndarray

    @property
    def coefficient(self) -> float:
        """Friction that the plate sees: mean drag over mean load."""
        return float(-self.force[:, 0].mean() / self.force[:, 1].mean())


def drag(face: Face, friction: float, speed: float, settled: tuple[np.ndarray, np.ndarray]) -> Drag:
    radius, places = settled
    # below the pressed surface by less than a grain: the plate clears the columns, and no grain leaves over them
    columns = rows(float(np.sort(places[:, 1] + radius)[-30]) - 0.5 * DIAMETER)
    start, stop = PRESS, PRESS + START
    speed_up = {"kind": "table", "times": [start, start + 1e-3, stop - 1e-3, stop], "factors": [0.0, 1.0, 1.0, 0.0]}
    rate = speed / (START - 1e-3)
    tables = scene(radius, places) | {
        "structure": {
            "kind": "free_rigid",
            "density": PLATE_DENSITY,
            "beam": {"length": LENGTH, "height": HEIGHT, "along": round(LENGTH / FACET), "across": 1},
            "placement": {"x": LENGTH / 2, "y": "on_bed"},
            "loads": [
                {
                    "kind": "boundary",
                    "boundary": "top",
                    "total_force": (0.0, -LOAD),
                    "schedule": {"kind": "ramp", "over": 0.5 * PRESS},
                },
                {"kind": "body", "acceleration": (rate, 0.0), "schedule": speed_up},
            ],
        },
        "interface": face.table(),
        "rows": columns,
        "contact": CONTACT
        | {"pairs": [{"between": ("grains", "structure"), "friction": friction, "rolling_friction": 0.0}]},
    }
    model = build(Scene.model_validate(tables)).model
    guide(model)
    model.advance(round((stop + ONSET / speed) / model.window))
    force, height = [], []
    for _ in range(round(WAY / speed / model.window)):
        model.advance(1)
        force.append(model.reaction)  # the mean of the window
        height.append(model.structure.centroid()[1] - HEIGHT / 2)
    return Drag(np.array(force), np.array(height))


def guide(model: Model) -> None:
    """Let the grains move the plate up and down alone, as a guide does that takes their drag and their moment."""
    advance = model.structure.advance

    def guided(force: np.ndarray) -> None:
        advance(np.tile([0.0, force[:, 1].mean()], (len(force), 1)))

    model.structure.advance = guided


Coefficients = dict[tuple[Face, float, float], np.ndarray]  # by face, friction and speed


def measure() -> Coefficients:
    """Coefficients (seeds,) that the plate sees."""
    faces = [Face(spacing * DIAMETER) for spacing in SPACINGS] + [Face(None)]
    cases = [(face, friction, SPEED) for face in faces for friction in FRICTIONS]
    gapped = [Face(0.5 * DIAMETER, share * 0.5 * DIAMETER) for share in GAPPED]
    cases += [(face, friction, SPEED) for face in gapped for friction in GAPPED_FRICTIONS]
    cases += [(face, 0.0, SLOW * SPEED) for face in faces if face.spacing is not None]
    beds = [bed(seed) for seed in SEEDS]
    return {case: np.array([drag(*case, settled).coefficient for settled in beds]) for case in cases}


def draw(found: Coefficients) -> str:
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
    touching = sorted({face for face, _, _ in found if face.diameter is None}, key=lambda face: face.spacing or 0.0)
    for friction in FRICTIONS:
        spacing = np.array([(face.spacing or 0.0) / DIAMETER for face in touching])
        band(left, spacing, [found[face, friction, SPEED] for face in touching], f"mu = {friction:g}")
    fine = np.linspace(0.0, SPACINGS[0], 100)
    left.plot(fine, [Face(s * DIAMETER).steepest for s in fine], "k:", label="steepest slope for one grain")
    left.set(xlabel="glued spacing / mean grain diameter (0: facets)", ylabel="drag / load")
    for face in touching:
        band(right, np.array(FRICTIONS), [found[face, friction, SPEED] for friction in FRICTIONS], face.name)
    right.plot(FRICTIONS, FRICTIONS, "k:", label="Coulomb on a smooth plate")
    right.set(xlabel="mu between plate and grains", ylabel="drag / load")
    for axes in (left, right):
        axes.legend(fontsize=8, ncols=2, loc="upper center")
        axes.set_ylim(0.0, 0.75)
        axes.grid(alpha=0.3)
    figure.savefig(FOLDER / "roughness.png", dpi=120)
    plt.close(figure)
    return "roughness.png"


def band(axes: plt.Axes, x: np.ndarray, seen: list[np.ndarray], label: str) -> None:
    """Means with bars from the smallest to the largest of the seeds."""
    mean = np.array([values.mean() for values in seen])
    spread = [mean - [values.min() for values in seen], [values.max() for values in seen] - mean]
    axes.errorbar(x, mean, yerr=np.maximum(spread, 0.0), marker="o", capsize=3, label=label)


def summary(values: np.ndarray) -> tuple[float, float, float]:
    return values.mean(), values.min(), values.max()


def digits(value: float) -> str:
    return f"{round(value, 3) + 0.0:.3f}"  # no -0.000


def write_page(found: Coefficients, picture: str) -> None:
    faces = list(dict.fromkeys(face for face, _, _ in found))
    columns = [(friction, SPEED) for friction in FRICTIONS] + [(0.0, SLOW * SPEED)]
    names = [f"mu = {friction:g}" for friction in FRICTIONS] + [f"mu = 0, at {SLOW * SPEED:g} m/s"]
    head = ["face of the plate", "steepest slope", *names]
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    for face in faces:
        cells = [face.name, f"{face.steepest:.2f}"]
        for column in columns:
            values = found.get((face, *column))
            cells.append("" if values is None else "{} ({} to {})".format(*map(digits, summary(values))))
        lines.append(f"| {' | '.join(cells)} |")
    numbers = {"count": COUNT, "seeds": len(SEEDS), "load": LOAD, "speed": SPEED, "grains": BED_FRICTION}
    text = PAGE.format(**numbers, way=WAY / DIAMETER, first=ONSET / DIAMETER, picture=picture, table="\n".join(lines))
    (FOLDER / "roughness.md").write_text(text)


PAGE = """# How rough glued grains are

Written by `make validate`.

A rigid plate slides over a bed of {count} grains (10 mm +- 10 %, friction {grains:g} and rolling friction 0.2 among
them) under a constant load of {load:g} N/m at {speed:g} m/s; a guide takes its drag and its moment and lets it rise and
sink. The bed lies between two columns that end just below the plate. Drag over load is the friction that the plate
sees, over a way of {way:.0f} grain diameters after {first:.0f}; mean of {seeds} beds, and the smallest and largest of
them. mu is the friction between grains and plate. Glued grains touch each other where nothing else is said. The
steepest slope is that of one grain of the mean size d that rides over two of them.

![{picture}]({picture})

{table}

Facets show mu itself, to the digits given, as long as the bed bears it. Glued grains add to it, the less the closer
they stand, and far less than the slope of one grain on two of them: many grains at once hardly let the plate rise, and
only what the bed takes up for good is drag. At half the speed they add less, about half of it 0.25 and 0.5 d apart: a
part is the work of dashpots. Above a third or so the bed fails before the plate slides; then the face no longer
matters, and the beds differ more than the faces.
"""


@pytest.mark.validate
def test_roughness_of_glued_grains() -> None:
    found = measure()
    write_page(found, draw(found))
    smooth = Face(None)
    assert np.abs(found[smooth, 0.0, SPEED]).max() < 1e-12
    assert found[smooth, 0.1, SPEED] == pytest.approx(0.1, abs=1e-3)  # but for moments at which a grain sticks
    rough = [found[Face(spacing * DIAMETER), 0.0, SPEED].mean() for spacing in SPACINGS]
    assert np.all(np.diff(rough) < 0.0) and rough[-1] > 0.0
