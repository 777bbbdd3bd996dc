"""A scene with numbers in place of its factors: coarsening, stiffness, refinement."""

from __future__ import annotations

import math
from typing import Any

from coupled.errors import SceneError
from coupled.scene.grains import Grains
from coupled.scene.knobs.contact import by_coarsening, by_stiffness, scaled
from coupled.scene.knobs.mesh import refined
from coupled.scene.refusal import refusal
from coupled.scene.scene import Scene

Tables = dict[str, Any]


def plain(scene: Scene) -> Scene:
    """The scene, its bed included, without the keys that are factors; itself if it has none.

    - `grains.coarsening` c: radii times c, counts over c^2, rounded; dashpots times c, so that restitution stays. With
      linear springs a packing is then as stiff as before, and its overlaps are the same shares of the radii: force
      and radius grow alike. Hertz's spring is scaled to that end, `hertz_stiffness` by c^-1/2, Young's modulus by
      1/c. Glued grains become as much larger and fewer. Rows and intruders stay; a list of places refuses.
    - `contact.stiffness_factor` f: springs times f, dashpots times its root.
    - `structure.refinement`: numbers of cells times that, and as many glued grains as before.
    - `time.refinement`: the step over that; a period in steps stays as long.

    Coarsening and stiffness hold for the bed as well, whatever it stands on: the grains of both are the same.

    Raises
    ------
    SceneError
        If a factor has nothing to act on, or the numbers that come out make no scene.
    """
    chain = [scene]
    while (bed := chain[-1].bed) is not None:
        chain.append(bed)
    if not any(_has_factors(one) for one in chain):
        return scene
    coarsening = math.prod(one.grains.coarsening or 1.0 for one in chain if one.grains is not None)
    stiffness = next((f for one in chain if one.contact and (f := one.contact.stiffness_factor) is not None), 1.0)
    _check_period(scene, coarsening, stiffness)
    try:
        return _applied(scene, coarsening, stiffness)
    except SceneError as error:
        made_by = _told(scene, coarsening, stiffness, error.key)
        raise SceneError(f"{str(error).removesuffix('.')}{made_by}.", key=error.key, file=error.file) from None


def _check_period(scene: Scene, coarsening: float, stiffness: float) -> None:
    """Refuse factors that would change the period of a shaking that counts steps."""
    counts = scene.shaking is not None and scene.shaking.period_steps is not None
    if counts and scene.time.step == "auto" and (coarsening, stiffness) != (1.0, 1.0):
        raise refusal(
            "shaking.period_steps",
            scene.shaking.period_steps,
            'counts steps that are left to the model (time.step = "auto"), and grains.coarsening or '
            "contact.stiffness_factor changes them, and so the period; give shaking.period, or time.step as a number",
        )


def _told(scene: Scene, coarsening: float, stiffness: float, key: str) -> str:
    """The factors that make the numbers a sentence on a key speaks of, unless it is one of them."""
    refinement = 1.0 if scene.structure is None else scene.structure.refinement or 1.0
    factors = {
        "grains.coarsening": coarsening,
        "contact.stiffness_factor": stiffness,
        "structure.refinement": refinement,
        "time.refinement": scene.time.refinement or 1.0,
    }
    given = [f"{key} = {factor:g}" for key, factor in factors.items() if factor != 1.0]
    return f" (these numbers are made by {', '.join(given)})" if given and key not in factors else ""


def _has_factors(scene: Scene) -> bool:
    given = (
        scene.time.refinement,
        None if scene.grains is None else scene.grains.coarsening,
        None if scene.contact is None else scene.contact.stiffness_factor,
        None if scene.structure is None else scene.structure.refinement,
    )
    return any(factor is not None for factor in given)


def _applied(scene: Scene, coarsening: float, stiffness: float) -> Scene:
    tables = scene.model_dump(exclude_none=True)
    if scene.bed is not None:
        tables["bed"] = _applied(scene.bed, coarsening, stiffness)
    if scene.contact is not None:
        tables["contact"].pop("stiffness_factor", None)
        for law in (by_coarsening(coarsening), by_stiffness(stiffness)):
            tables["contact"] = scaled(tables["contact"], law)
    if scene.grains is not None:
        tables["grains"].pop("coarsening", None)
        if isinstance(scene.grains, Grains):
            _coarsen(tables["grains"], scene.grains, coarsening)
    if scene.structure is not None:
        refined(tables, scene, tables["structure"].pop("refinement", 1.0), coarsening)
    if scene.time.refinement is not None:
        if scene.shaking is not None and scene.shaking.period_steps is not None:
            tables["shaking"]["period"] = tables["shaking"].pop("period_steps") * scene.time.step
        tables["time"]["step"] = scene.time.step / tables["time"].pop("refinement")
    return Scene.model_validate(tables)


def _coarsen(table: Tables, grains: Grains, factor: float) -> None:
    """Radii times a factor, as many grains as have the same area, in place."""
    if factor == 1.0:
        return
    if grains.layout == "list":
        raise refusal("grains.coarsening", factor, 'is for grains on a lattice, not for layout = "list"; remove it')
    for size in table["sizes"]:
        size["radius"] *= factor
        size["count"] = max(1, round(size["count"] / factor**2))
