"""Tables of the schemes of time integration; an elastic structure has one of them."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from coupled.scene.types import Number, Positive, Table

SCHEMES = ("newmark", "generalised_alpha", "hht")


class Newmark(Table):
    """Parameters of Newmark's scheme (G calls them alpha and delta)."""

    beta: Positive = Field(0.25, description="beta [-]")
    gamma: Positive = Field(0.5, description="gamma [-]")


class GeneralisedAlpha(Table):
    """Generalised alpha (Chung and Hulbert): the stiffest modes are damped, the others hardly."""

    spectral_radius: Annotated[Number, Field(ge=0, le=1)] = Field(
        0.8, description="factor of a step on the stiffest modes [-], 1 damps nothing"
    )


class AlphaMethod(Table):
    """The alpha method of Hilber, Hughes and Taylor."""

    alpha: Annotated[Number, Field(ge=-1 / 3, le=0)] = Field(-0.05, description="alpha [-], 0 damps nothing")
