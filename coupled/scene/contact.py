"""Tables of the contact law and of the global damping of the grains."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from coupled.scene.types import NonNegative, Number, Positive, Table

Restitution = Annotated[Number, Field(ge=1e-12, le=1)]  # as `particles.contact.recipe`
PoissonsRatio = Annotated[Number, Field(gt=-1, le=0.5)]
End = Literal["zero_force", "zero_overlap"]
END = (
    "end of the contact that the restitution refers to: zero force, as the contact law without tension has it, or "
    "zero overlap, the textbook's spring and dashpot"
)


class Recipe(Table):
    """Contact coefficients from physical wishes (G 2.1.10, as corrected in the theory pages)."""

    from_drop_height: Positive | None = Field(None, description="height of a free fall [m]")
    from_impact_speed: Positive | None = Field(None, description="speed of an impact [m/s]")
    max_overlap: Annotated[Number, Field(gt=0, lt=1)] = Field(
        0.05, description="overlap allowed, as a fraction of the smallest radius [-]"
    )
    restitution: Restitution = Field(description="speed of rebound over speed of impact, for every pair [-]")
    restitution_at: End = Field("zero_force", description=END)
    stiffness_ratio: Positive = Field(0.05, description="tangential over normal stiffness [-]")


class Elasticity(Table):
    """Elastic constants of one material, for Hertz's spring."""

    youngs_modulus: Positive = Field(description="Young's modulus E [Pa]")
    poissons_ratio: PoissonsRatio = Field(description="Poisson's ratio nu [-]")


class ContactNumbers(Table):
    """Numbers of a contact law: of all contacts in [contact], of two materials in [[contact.pairs]]."""

    normal_stiffness: Positive | None = Field(None, description="normal spring k_n [N/m]")
    normal_damping: NonNegative | None = Field(None, description="normal dashpot c_n [N s/m]")
    restitution: Restitution | None = Field(
        None,
        description="speed of rebound over speed of impact e [-], instead of normal_damping: the dashpot of each "
        "contact follows from its own effective mass",
    )
    hertz_stiffness: Positive | None = Field(None, description="Hertz's spring k_h [N/m^(3/2)]")
    youngs_modulus: Positive | None = Field(
        None, description="Young's modulus E of both bodies [Pa], instead of hertz_stiffness"
    )
    poissons_ratio: PoissonsRatio | None = Field(None, description="Poisson's ratio nu of both bodies [-]")
    tangential_stiffness: Positive | None = Field(None, description="tangential spring k_t [N/m]")
    tangential_damping: NonNegative | None = Field(None, description="tangential dashpot c_t [N s/m]")
    tangential_ratio: Positive | None = Field(
        None,
        description="tangential spring over the slope of the normal one [-], instead of tangential_stiffness; "
        "absent with youngs_modulus: Mindlin's",
    )
    tangential_damping_ratio: NonNegative | None = Field(
        None, description="dashpot over critical of a tangential spring that follows the normal one [-]"
    )
    friction: NonNegative | None = Field(None, description="Coulomb's coefficient mu [-]")
    rolling_friction: NonNegative | None = Field(None, description="rolling friction coefficient mu_r [-]")
    rolling_damping_ratio: NonNegative | None = Field(None, description="rolling damping over critical eta_r [-]")
    rolling_stiffness: Positive | None = Field(
        None, description="rolling spring k_r [N m/rad]; absent: k_t R_r^2 of each contact"
    )

    def numbers(self) -> dict[str, float]:
        """The numbers that are given, by name."""
        return {name: value for name in ContactNumbers.model_fields if (value := getattr(self, name, None)) is not None}


class Pair(ContactNumbers):
    """Numbers that differ from [contact] where two materials meet."""

    between: tuple[str, str] = Field(
        description='two materials: "grains", "structure" (glued grains), "walls" or the name of one of them, or the '
        "name of a row or an intruder"
    )


class Contact(ContactNumbers):
    """Contact law of grains, walls, rows and glued grains.

    Friction is modelled when a `friction` is given, rolling resistance when a `rolling_friction` is,
    here or in a pair; where a pair has none it is zero.
    """

    normal: Literal["linear", "hertz"] = Field("linear", description="normal spring")
    restitution_at: End | None = Field(None, description=END)
    rolling: Literal["elastic_plastic", "constant_torque"] | None = Field(
        None, description="rolling resistance: a moment spring with a limit, or the limit alone"
    )
    recipe: Recipe | None = Field(None, description="physical wishes instead of coefficients")
    stiffness_factor: Positive | None = Field(
        None,
        description="factor on all springs, those of pairs and of the bed too [-]; dashpots follow, so that "
        "restitution stays",
    )
    pairs: tuple[Pair, ...] = Field((), description="numbers that differ between two materials")
    materials: dict[str, Elasticity] | None = Field(
        None, description="elastic constants by material, mixed for each pair (Hertz)"
    )

    @model_validator(mode="before")
    @classmethod
    def _write_defaults(cls, data: Any) -> Any:
        """Write the dashpots, zero if not given, and the choices of the features that are modelled."""
        if not isinstance(data, dict):
            return data
        return {**_normal_defaults(data), **_tangential_defaults(data), **_rolling_defaults(data), **data}

    def given_in(self, name: str) -> str | None:
        """Path of the first place where a number is given, or None."""
        for path, table in self.tables():
            if getattr(table, name) is not None:
                return f"{path}.{name}"
        return None

    def tables(self) -> list[tuple[str, ContactNumbers]]:
        """[contact] and its pairs, by path."""
        return [("contact", self), *((f"contact.pairs.{k}", pair) for k, pair in enumerate(self.pairs))]

    @property
    def rubs(self) -> bool:
        """Whether friction is modelled."""
        return self.given_in("friction") is not None

    @property
    def rolls(self) -> bool:
        """Whether rolling resistance is modelled."""
        return self.given_in("rolling_friction") is not None

    @property
    def follows_normal(self) -> bool:
        """Whether the tangential spring follows the slope of the normal one; the first that is given decides."""
        if self.recipe is not None:
            return False
        for _, table in self.tables():
            if table.tangential_stiffness is not None or table.tangential_ratio is not None:
                return table.tangential_stiffness is None
        return self.normal == "hertz"


def _given(data: dict[str, Any], *names: str) -> str | None:
    """The first of some numbers that [contact] or a pair gives; the pairs may be no tables yet."""
    pairs = data.get("pairs", ())
    for table in (data, *(pairs if isinstance(pairs, (list, tuple)) else ())):
        for name in names:
            if isinstance(table, dict) and table.get(name) is not None:
                return name
    return None


def _normal_defaults(data: dict[str, Any]) -> dict[str, Any]:
    if "recipe" in data:
        return {}
    if data.get("normal") == "hertz":
        return {"restitution": 1.0, "restitution_at": "zero_force"}
    return {"restitution_at": "zero_force"} if "restitution" in data else {"normal_damping": 0.0}


def _tangential_defaults(data: dict[str, Any]) -> dict[str, Any]:
    if "recipe" in data or _given(data, "friction") is None:
        return {}
    spring = _given(data, "tangential_stiffness", "tangential_ratio")
    follows = spring == "tangential_ratio" or (spring is None and data.get("normal") == "hertz")
    return {"tangential_damping_ratio" if follows else "tangential_damping": 0.0}


def _rolling_defaults(data: dict[str, Any]) -> dict[str, Any]:
    if _given(data, "rolling_friction") is None:
        return {}
    if data.get("rolling") == "constant_torque":
        return {}
    return {"rolling": "elastic_plastic", "rolling_damping_ratio": 0.0}


class Damping(Table):
    """Global damping of the free grains: ``-alpha_t m v`` and ``-alpha_r I omega`` (G 2.1.9)."""

    translational: NonNegative = Field(0.0, description="alpha_t [1/s]")
    rotational: NonNegative = Field(0.0, description="alpha_r [1/s]")
