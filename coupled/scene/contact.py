"""Tables of the contact law and of the global damping of the grains."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from coupled.scene.types import NonNegative, Number, Positive, Table


class Recipe(Table):
    """Contact coefficients from physical wishes (G 2.1.10, as corrected in the theory pages)."""

    drop_height: Positive | None = Field(None, description="height of a free fall [m]")
    impact_speed: Positive | None = Field(None, description="speed of an impact [m/s]")
    largest_overlap: Annotated[Number, Field(gt=0, lt=1)] = Field(
        0.05, description="overlap allowed, as a fraction of the smallest radius [-]"
    )
    restitution: Annotated[Number, Field(gt=0, le=1)] = Field(description="speed of rebound over speed of impact [-]")
    restitution_at: Literal["zero_force", "zero_overlap"] = Field(
        "zero_force",
        description="end of the contact that the restitution refers to: zero force, as the contact "
        "law without tension has it, or zero overlap, the textbook's spring and dashpot",
    )
    stiffness_ratio: Positive = Field(0.05, description="tangential over normal stiffness [-]")


class Contact(Table):
    """Contact law of grains, walls, rows and glued grains.

    Friction is modelled when `friction` is given, rolling resistance when `rolling_friction` is.
    """

    normal_stiffness: Positive | None = Field(None, description="normal spring k_n [N/m]")
    normal_damping: NonNegative | None = Field(None, description="normal dashpot c_n [N s/m]")
    tangential_stiffness: Positive | None = Field(None, description="tangential spring k_t [N/m]")
    tangential_damping: NonNegative | None = Field(None, description="tangential dashpot c_t [N s/m]")
    friction: NonNegative | None = Field(None, description="Coulomb's coefficient mu [-]")
    rolling_friction: NonNegative | None = Field(None, description="rolling friction coefficient mu_r [-]")
    rolling_damping_ratio: NonNegative | None = Field(None, description="rolling damping over critical eta_r [-]")
    rolling_stiffness: Positive | None = Field(
        None, description="rolling spring k_r [N m/rad]; absent: k_t R_r^2 of each contact"
    )
    recipe: Recipe | None = Field(None, description="physical wishes instead of coefficients")

    @model_validator(mode="before")
    @classmethod
    def _write_dashpots(cls, data: Any) -> Any:
        """Write the zero dashpots of the features that are modelled."""
        if not isinstance(data, dict):
            return data
        zeros: dict[str, float] = {}
        if "recipe" not in data:
            zeros["normal_damping"] = 0.0
            if "friction" in data:
                zeros["tangential_damping"] = 0.0
        if "rolling_friction" in data:
            zeros["rolling_damping_ratio"] = 0.0
        return {**zeros, **data}


class Damping(Table):
    """Global damping of the free grains: ``-alpha_t m v`` and ``-alpha_r I omega`` (G 2.1.9)."""

    translational: NonNegative = Field(0.0, description="alpha_t [1/s]")
    rotational: NonNegative = Field(0.0, description="alpha_r [1/s]")
