"""Tables of the structure: material, place, prescribed path."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from coupled.scene.loads import Load
from coupled.scene.refusal import refusal
from coupled.scene.schemes import SCHEMES, AlphaMethod, GeneralisedAlpha, Newmark
from coupled.scene.shape import Beam, Shape, Tube
from coupled.scene.types import Count, NonNegative, Number, Positive, Table


class Placement(Table):
    """Where the centroid of the structure starts."""

    x: Number = Field(0.0, description="centroid [m]")
    y: Number | Literal["on_bed"] = Field(
        0.0, description="centroid [m], or 'on_bed': lowered until it touches a grain or the floor"
    )
    gap: NonNegative = Field(0.0, description="extra height above the bed [m]")


class Rayleigh(Table):
    """Rayleigh damping ``C = c_a M + c_b K``."""

    mass_factor: NonNegative = Field(0.0, description="c_a [1/s]")
    stiffness_factor: NonNegative = Field(0.0, description="c_b [s]")


class Path(Table):
    """Prescribed motion, linear between way points, at rest after the last one."""

    points: tuple[tuple[Number, Number, Number], ...] = Field(
        min_length=2, description="rows [time s, displacement x m, displacement y m]"
    )


class Initial(Table):
    """Release from a free vibration mode."""

    mode: Count = Field(1, description="number of the elastic mode, 1 is the lowest")
    amplitude: Positive = Field(1e-3, description="largest displacement [m]")


_ENHANCEABLE = ("quadrilateral", 1)  # cell and order


def _usual_element(shape: Any, theory: Any) -> str:
    """Return the element that suits theory and cells of a shape, which may still be as it was read."""
    if theory == "large_strain":
        return "standard"
    given = shape if isinstance(shape, dict) else getattr(shape, "__dict__", {})
    defaults = {name: Tube.model_fields[name].default for name in ("cell", "order")}
    cells = tuple(given.get(name, default) for name, default in defaults.items())
    return "enhanced" if cells == _ENHANCEABLE else "standard"


class Structure(Table):
    """A structure: elastic (FEM), rigid along a path, or a free rigid body."""

    kind: Literal["elastic", "rigid", "free_rigid"] = Field(description="mechanical model")
    density: Positive | None = Field(None, description="mass per volume [kg/m3]")
    youngs_modulus: Positive | None = Field(None, description="Young's modulus E [Pa]")
    poissons_ratio: Annotated[Number, Field(gt=-1, lt=0.5)] | None = Field(
        None, description="Poisson's ratio nu [-], tested to 0.4999; no incompressible solid"
    )
    element: Literal["standard", "enhanced"] | None = Field(
        None,
        description="formulation of elastic cells; where it is absent 'enhanced', which lets coarse meshes bend, "
        "for quadrilaterals of order 1 and small strain, else 'standard'",
    )
    theory: Literal["linear", "corotational", "large_strain"] | None = Field(
        None,
        description="theory of an elastic body: 'linear', the default, for small rotation and strain, 'corotational' "
        "for small strain of a body that turns, 'large_strain'",
    )
    tube: Tube | None = Field(None, description="a ring")
    beam: Beam | None = Field(None, description="a rectangle")
    refinement: Positive | None = Field(
        None, description="factor on the numbers of cells of the shape [-]; as many glued grains as before share them"
    )
    placement: Placement = Field(default_factory=Placement, description="start of the centroid")
    rayleigh: Rayleigh | None = Field(None, description="damping of the material")
    newmark: Newmark | None = Field(None, description="time integration by Newmark, the default")
    generalised_alpha: GeneralisedAlpha | None = Field(None, description="time integration by generalised alpha")
    hht: AlphaMethod | None = Field(None, description="time integration by the alpha method")
    loads: tuple[Load, ...] = Field((), description="external loads")
    path: Path | None = Field(None, description="prescribed motion of a rigid structure")
    initial: Initial | None = Field(None, description="initial deformation")

    @model_validator(mode="before")
    @classmethod
    def _write_numerics(cls, data: Any) -> Any:
        """Write theory, element and scheme of an elastic structure when they are not given."""
        if isinstance(data, dict) and data.get("kind") == "elastic":
            chosen = any(data.get(name) is not None for name in SCHEMES)
            scheme = {} if chosen else {"newmark": {}}
            element = _usual_element(data.get("tube") or data.get("beam"), data.get("theory"))
            return {"theory": "linear", "element": element, **scheme, **data}
        return data

    @model_validator(mode="after")
    def _element_fits(self) -> Structure:
        """Check that the element is one for this kind and these cells."""
        if self.element is None:
            return self
        if self.kind != "elastic":
            raise refusal(
                "structure.element",
                self.element,
                f'means nothing for kind = "{self.kind}"; remove it or change structure.kind',
            )
        shape = self.tube or self.beam
        if self.element == "enhanced" and shape is not None and (shape.cell, shape.order) != _ENHANCEABLE:
            raise refusal(
                "structure.element",
                self.element,
                f"is for quadrilaterals of order 1, not for a {shape.cell} of order {shape.order}; "
                'give "standard" or change cell and order',
            )
        return self

    @property
    def shape(self) -> Shape:
        """The tube or the beam, whichever is given."""
        shape = self.tube or self.beam
        assert shape is not None, "the rules of the scene demand exactly one shape"
        return shape
