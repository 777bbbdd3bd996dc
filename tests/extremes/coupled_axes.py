"""Axes of the coupling."""

from __future__ import annotations

import math
from collections.abc import Callable

from body_scenes import HEIGHT, LENGTH
from coupled_scenes import (
    DENSITY,
    GRAIN_DENSITY,
    GRAVITY,
    RADIUS,
    STIFFNESS,
    WAYS,
    WEIGHT,
    WIDTH,
    bed_stiffness,
    carried,
    elastic,
    on_bed,
    rigid,
    rows_of_discs,
    thrown,
)
from trials import Axis, Finished, Measured, Trial


def of_stiffness(way: str) -> Callable[[float], Trial]:
    """The bar's modulus over the stiffness of the grains' contacts."""

    def trial(share: float) -> Trial:
        soft = elastic(youngs_modulus=share * STIFFNESS, rayleigh={"mass_factor": 50.0})
        return Trial(scene=on_bed(way, structure=soft), check=carried)

    return trial


def of_density(way: str) -> Callable[[float], Trial]:
    """Density of the bar over that of the grains.

    Let go on the bed it swings about its rest, with the reaction between zero and twice its weight. Over n periods
    the mean is off by up to 1/(pi n): 6 % for the five that the last half of a run holds, 10 % for the 3/4 of one that
    0.15 s gave a bar of 154 times the grains' density, where both exchanges agreed to six digits.
    """

    def trial(share: float) -> Trial:
        density = share * GRAIN_DENSITY
        weight = WEIGHT * density / DENSITY
        duration = max(0.15, 12 * 2.0 * math.pi * math.sqrt(weight / GRAVITY / bed_stiffness()))
        scene = on_bed(way, structure=elastic(density=density), duration=duration)
        return Trial(scene=scene, check=lambda run: carried(run, weight))

    return trial


def of_substeps(exchange: str) -> Callable[[float], Trial]:
    def trial(substeps: float) -> Trial:
        scene = on_bed(f"facets, {exchange}", step=5e-6, duration=0.1, interface={"substeps": int(substeps)})
        return Trial(scene=scene, check=carried)

    return trial


def of_gravity(share: float) -> Trial:
    """Gravity over 9.81 m/s2, on grains and bar."""
    pulled = elastic(loads=[{"kind": "body", "acceleration": [0.0, -share * GRAVITY]}])
    scene = on_bed("facets, predicted", structure=pulled, gravity=[0.0, -share * GRAVITY])
    if share == 0.0:
        return Trial(scene=scene, check=lambda run: [at_rest(run)])
    return Trial(scene=scene, check=lambda run: carried(run, share * WEIGHT))


def at_rest(run: Finished) -> Measured:
    speed = float(run.history["fastest_grain"].max())
    return Measured(what="speed of the fastest grain [m/s]", value=speed, expected=0.0, allowed=1e-9)


def of_units(scale: float) -> Trial:
    """The scene with all lengths scaled: times by the root, stiffness per length as the length, moduli as well."""
    time = math.sqrt(scale)
    beam = {"length": scale * LENGTH, "height": scale * HEIGHT, "along": 10, "across": 2}
    bar = elastic(
        beam=beam, youngs_modulus=7e10 * scale, placement={"x": 0.5 * scale * WIDTH, "y": "on_bed"}
    )  # fmt: skip
    scene = on_bed("glued, predicted", structure=bar, step=5e-5 * time, duration=0.15 * time)
    scene |= {"box": {"width": scale * WIDTH, "height": scale}}
    scene["grains"] |= {
        "sizes": [{"radius": scale * RADIUS, "count": len(rows_of_discs())}],
        "positions": rows_of_discs(scale),
    }
    scene["contact"] |= {"normal_stiffness": scale * STIFFNESS}
    return Trial(scene=scene, check=lambda run: carried(run, WEIGHT * scale**2))


def falling_onto(way: str) -> Callable[[float], Trial]:
    """A rigid bar accelerated so that it meets the bed at a speed [m/s] after 1 cm."""

    def trial(speed: float) -> Trial:
        acceleration = speed**2 / 0.02
        bar = rigid(
            loads=[{"kind": "body", "acceleration": [0.0, -acceleration]}],
            placement={"x": 0.5 * WIDTH, "y": "on_bed", "gap": 0.01},
        )
        scene = on_bed(way, structure=bar, duration=0.03 / speed, step=min(5e-5, 1e-3 / speed), gravity=[0.0, 0.0])

        def check(run: Finished) -> list[Measured]:
            h = run.history
            return [
                Measured(
                    what="error of the ledger over what was turned over",
                    value=h["ledger_relative_error"][-1],
                    expected=0.0,
                    allowed=0.02,
                ),
                Measured(
                    what="momentum balance, over the forces",
                    value=h["momentum_residual"].max(),
                    expected=0,
                    allowed=1e-9,
                ),
            ]

        return Trial(scene=scene, check=check)

    return trial


def bounced(run: Finished) -> list[Measured]:
    """It has met the bar, and its kinetic energy with that of the springs is the one that it came with."""
    h, up = run.history, float(run.grains("vy")[0])
    energy = h["grains_kinetic"] + h["grains_normal_springs"]
    # (omega dt)^2/8 of the leapfrog, and where in its first and last step of contact the disc touches
    return [
        Measured(what="energy after over before", value=energy[-1] / energy[0], expected=1.0, allowed=1e-3),
        Measured(what="goes on as it came: 1, else 0", value=float(up < -0.999), expected=0.0, allowed=0.0),
    ]


def on_facets(ratio: float) -> Trial:
    """Diameter of the disc over the length of a facet."""
    along = 1 if ratio < 1 else min(1000, math.ceil(ratio * 10))
    radius = 0.5 * ratio * LENGTH / along
    return Trial(scene=thrown(radius=radius, interface={"kind": "facets"}, along=along), check=bounced)


def on_glued(ratio: float) -> Trial:
    """Diameter of the disc over that of a glued grain, glued grains side by side."""
    along = 10
    glued = LENGTH / along
    place = 0.05 * glued  # beside the crown of one
    interface = {"kind": "glued", "per_facet": 1, "boundaries": ["top"], "diameter": glued}
    return Trial(
        scene=thrown(radius=0.5 * ratio * glued, interface=interface, along=along, place=place, far=0.01 * glued),
        check=bounced,
    )


def between_glued(share: float) -> Trial:
    """Glued grains smaller than their distance, and a disc of half that distance."""
    along = 10
    spacing = LENGTH / along
    interface = {"kind": "glued", "per_facet": 1, "boundaries": ["top"], "diameter": share * spacing}
    return Trial(
        scene=thrown(radius=0.25 * spacing, interface=interface, along=along, place=0.5 * spacing, far=spacing),
        check=bounced,
    )


def to_a_tolerance(tolerance: float) -> Trial:
    scene = on_bed("glued, iterated", step=2e-4, interface={"tolerance": tolerance, "iterations": 5})
    return Trial(scene=scene, check=carried)


def taken_knowingly(exchange: str) -> Callable[[float], Trial]:
    """A bar so light that r of the coupling is about what is asked for on fixed partners."""

    def trial(ratio: float) -> Trial:
        density = 1.1 * GRAIN_DENSITY / ratio
        interface = {"largest_stiffness_ratio": 1e9}
        scene = on_bed(f"glued, {exchange}", structure=elastic(density=density), interface=interface)
        return Trial(scene=scene, check=lambda run: carried(run, WEIGHT * density / DENSITY))

    return trial


PLACES = {
    "on the bed": {"placement": {"x": 0.5 * WIDTH, "y": "on_bed"}},
    "in the bed": {"placement": {"x": 0.5 * WIDTH, "y": 0.02}},
    "around a grain": {"placement": {"x": 0.5 * WIDTH, "y": 0.5}},
    "outside the box": {"placement": {"x": 2 * WIDTH, "y": 0.5}},
    "beside all grains": {"placement": {"x": 0.5 * WIDTH, "y": 0.011}},
    "1 km above": {"placement": {"x": 0.5 * WIDTH, "y": 1000.0}},
    "leaving at 1e6 m/s2": {"loads": [{"kind": "body", "acceleration": [0.0, 1e6]}]},
}


def placed(name: str) -> Trial:
    structure, tables = rigid(**PLACES[name]), {}
    if name == "around a grain":
        tables["places"] = [*rows_of_discs(), [0.5 * WIDTH, 0.5]]
    if name == "beside all grains":
        tables["places"] = [[RADIUS, RADIUS]]
    if name == "1 km above":
        tables |= {"box": {"width": WIDTH, "height": 2000.0}, "step": 2e-4, "duration": 15.0}
    scene = on_bed("glued, predicted", structure=structure, **tables)
    return Trial(scene=scene, check=carried, limit=300.0)


PATHS = {
    "0.01 m/s into the bed": [[0.0, 0.0, 0.0], [0.1, 0.0, -0.001]],
    "10 m/s": [[0.0, 0.0, 0.0], [1e-4, 0.0, -0.001]],
    "1000 m/s": [[0.0, 0.0, 0.0], [1e-5, 0.0, -0.01]],
    "a jump of 1 cm in 1 ns": [[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.010000001, 0.0, -0.01]],
    "through the floor": [[0.0, 0.0, 0.0], [0.1, 0.0, -0.1]],
    "crushing": [[0.0, 0.0, 0.0], [0.1, 0.0, -0.02]],
}


def led(name: str) -> Trial:
    bar = rigid(path={"points": PATHS[name]}) | {"kind": "rigid"}
    for key in ("loads", "density"):
        del bar[key]

    def check(run: Finished) -> list[Measured]:
        h = run.history
        return [
            Measured(
                what="error of the ledger over what was turned over",
                value=h["ledger_relative_error"][-1],
                expected=0.0,
                allowed=0.02,
            )
        ]

    return Trial(scene=on_bed("facets, predicted", structure=bar), check=check)


AXES = (
    *(
        Axis(
            part="Coupling",
            name=f"Modulus of the bar over the stiffness of contacts, {way}",
            text="A bar on three rows of discs, 0.15 s. Right: the bed carries its weight, to 10 %, and the ledger "
            "closes to 5 %.",
            values=(1e-3, 1e-2, 0.1, 1.0, 10.0, 1e3, 1e6, 1e9),
            trial=of_stiffness(way),
            quick={"facets, predicted": {1.0: "right"}, "glued, iterated": {1e-3: "right"}}.get(way, {}),
        )
        for way in WAYS
    ),
    *(
        Axis(
            part="Coupling",
            name=f"Density of the bar over that of the grains, {way}",
            text="The same bar of 7e10 Pa, for 0.15 s or twelve of its swings on the bed.",
            values=(1e-6, 1e-3, 0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e6),
            trial=of_density(way),
            quick={"facets, predicted": {1e-3: "refused", 1e3: "stopped"}}.get(way, {}),
            sharpen=1.2,
        )
        for way in ("facets, predicted", "glued, iterated")
    ),
    *(
        Axis(
            part="Coupling",
            name=f"Substeps, {exchange}",
            text="Steps of the grains of 5e-6 s in one of the structure.",
            values=(1, 2, 5, 10, 20, 50, 100, 200, 500, 1000),
            trial=of_substeps(exchange),
            quick={"predicted": {1000: "refused"}, "iterated": {100: "right"}}[exchange],
            show=str,
        )
        for exchange in ("predicted", "iterated")
    ),
    Axis(
        part="Coupling",
        name="Gravity over 9.81 m/s2",
        text="On grains and bar. Right: as above; without gravity nothing moves.",
        values=(0.0, 1e-9, 1e-3, 1.0, 10.0, 100.0, 1e3, 1e6),
        trial=of_gravity,
        quick={0.0: "right", 1e3: "stopped"},
    ),
    Axis(
        part="Coupling",
        name="Scale of all lengths",
        text="The scene with similar stiffness and times. Right: the bed carries the weight.",
        values=(1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6),
        trial=of_units,
        quick={1e-3: "right"},
    ),
    *(
        Axis(
            part="Coupling",
            name=f"Speed of the bar at the bed [m/s], {way}",
            text="A rigid bar is driven onto the bed with steps of 5e-5 s, or 1 mm of its way. Right: the ledger "
            "closes to 2 %, "
            "forces on both sides cancel to round-off.",
            values=(0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e5),
            trial=falling_onto(way),
            quick={"facets, predicted": {100.0: "stopped"}}.get(way, {}),
        )
        for way in ("facets, predicted", "glued, predicted")
    ),
    Axis(
        part="Coupling",
        name="Diameter of a disc over the length of a facet",
        text="A disc is thrown at 1 m/s at the flat face of a bar at rest, without losses. Right: it is turned back "
        "and keeps its energy, to 1e-3.",
        values=(1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0, 1e3),
        trial=on_facets,
        quick={1e-3: "right", 1e3: "right"},
    ),
    Axis(
        part="Coupling",
        name="Diameter of a disc over that of a glued grain",
        text="The same on glued grains side by side, beside the crown of one.",
        values=(1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0, 1e3),
        trial=on_glued,
        quick={1e-2: "right", 100.0: "right"},
    ),
    Axis(
        part="Coupling",
        name="Diameter of glued grains over their distance",
        text="A disc of half the distance is thrown between two glued grains. Right: it is turned back and keeps its "
        "energy.",
        values=(0.1, 0.3, 0.45, 0.55, 0.7, 0.9, 1.0, 1.1),
        trial=between_glued,
        quick={0.1: "stopped", 1.1: "refused"},
    ),
    Axis(
        part="Coupling",
        name="Tolerance of the iterated exchange",
        text="At most five iterations, steps of 2e-4 s. Right: the bed carries the bar.",
        values=(1.0, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15, 1e-300),
        trial=to_a_tolerance,
        quick={1.0: "refused", 1e-15: "right"},
    ),
    *(
        Axis(
            part="Coupling",
            name=f"Stiffness ratio taken knowingly, {exchange}",
            text="A bar so light that r is about this on fixed partners, which is refused unless it is allowed.",
            values=(0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 100.0, 1e3, 1e4, 1e6),
            trial=taken_knowingly(exchange),
            quick={"predicted": {100.0: "stopped"}}.get(exchange, {}),
        )
        for exchange in ("predicted", "lagged", "iterated")
    ),
    Axis(
        part="Coupling",
        name="Place of the bar",
        text="A free rigid bar. Right: the bed carries it.",
        values=tuple(PLACES),
        trial=placed,
        quick={"around a grain": "refused", "beside all grains": "stopped"},
    ),
    Axis(
        part="Coupling",
        name="Path into the bed",
        text="A rigid bar along way points. Right: the ledger closes to 2 %.",
        values=tuple(PATHS),
        trial=led,
        quick={"1000 m/s": "refused", "crushing": "stopped"},
    ),
)
