"""What a cell contributes: stiffness and strain, by the formulation that is asked for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, Protocol

import numpy as np
from dolfinx import fem
from numpy.typing import NDArray
from petsc4py import PETSc

from structure import compat, forms
from structure.discrete import DiscreteBody
from structure.enhanced import EnhancedCells
from structure.errors import StructureError
from structure.material import PlaneStrain
from structure.nodes import fill

ElementName = Literal["standard", "enhanced"]
Strain = Callable[[NDArray[np.float64]], NDArray[np.float64]]
ENHANCEABLE = ("quadrilateral", 1)  # cell and order
BLOCK = 8192  # cells whose matrices are in memory at a time


class Element(Protocol):
    """A formulation on a body's cells."""

    def stiffness_matrix(self) -> PETSc.Mat:
        """Stiffness [Pa], of the pattern of the mass."""
        ...

    def strain_at(self, points: NDArray[np.float64]) -> Strain:
        """Function from flat nodal displacements to strain.

        Parameters
        ----------
        points : (p, 2)
            In the reference cell of dolfinx.

        Returns
        -------
        Function of this rank's (owned unknowns,) [m] with values (owned cells, p, 3), as xx, yy, xy
        (tensor component).
        """
        ...


class StandardElement:
    """Displacements alone: ``int sigma(v) : eps(w) dx`` with full integration."""

    def __init__(self, body: DiscreteBody, material: PlaneStrain) -> None:
        self._body, self._material = body, material

    def stiffness_matrix(self) -> PETSc.Mat:
        """See `Element`."""
        return forms.stiffness_matrix(self._body.space, self._material, self._body.mesh.order)

    def strain_at(self, points: NDArray[np.float64]) -> Strain:
        """See `Element`; compiled here."""
        function = fem.Function(self._body.space)
        expression = compat.compiled_expression(forms.strain_components(function), points)
        domain = self._body.mesh.domain
        cells = np.arange(domain.topology.index_map(2).size_local, dtype=np.int32)

        def strain(displacement: NDArray[np.float64]) -> NDArray[np.float64]:
            fill(function, displacement)
            return compat.evaluate(expression, domain, cells).reshape(len(cells), -1, 3)

        return strain


class EnhancedElement:
    """Quadrilaterals of order 1 with enhanced strain; see `EnhancedCells`."""

    def __init__(self, body: DiscreteBody, material: PlaneStrain) -> None:
        mesh = body.mesh
        if (mesh.cell, mesh.order) != ENHANCEABLE:
            raise StructureError(
                f"element = 'enhanced' is for quadrilaterals of order 1, not for a {mesh.cell} of order "
                f"{mesh.order}: use element = 'standard'"
            )
        self._body, self._elasticity = body, material.elasticity
        owned = mesh.domain.topology.index_map(2).size_local
        self._nodes = compat.cell_dofs(body.space)[:owned]
        self._corners = mesh.domain.geometry.x[compat.cell_nodes(mesh.domain)[:owned], :2]

    def stiffness_matrix(self) -> PETSc.Mat:
        """See `Element`."""
        matrix = self._body.mass_matrix.duplicate()
        for part in self._blocks():
            stiffness = EnhancedCells(self._corners[part], self._elasticity).stiffness()
            dofs = (2 * self._nodes[part, :, None] + np.arange(2, dtype=np.int32)).reshape(-1, 8)
            matrix.setValuesLocalRCV(dofs, dofs, stiffness.reshape(-1, 64), addv=PETSc.InsertMode.ADD)
        matrix.assemble()
        return matrix

    def strain_at(self, points: NDArray[np.float64]) -> Strain:
        """See `Element`; the enhanced part is in it."""
        function = fem.Function(self._body.space)
        operator = np.empty((len(self._nodes), len(points), 3, 8))
        for part in self._blocks():
            cells = EnhancedCells(self._corners[part], self._elasticity)
            for k, point in enumerate(2.0 * np.asarray(points) - 1.0):
                operator[part, k] = cells.strain_operator(point)[0]
        operator[:, :, 2] /= 2.0

        def strain(displacement: NDArray[np.float64]) -> NDArray[np.float64]:
            fill(function, displacement)
            local = function.x.array.reshape(-1, 2)[self._nodes].reshape(-1, 1, 8, 1)
            return (operator @ local)[..., 0]

        return strain

    def _blocks(self) -> list[slice]:
        return [slice(begin, begin + BLOCK) for begin in range(0, len(self._nodes), BLOCK)]


ELEMENTS: dict[ElementName, type[StandardElement] | type[EnhancedElement]] = {
    "standard": StandardElement,
    "enhanced": EnhancedElement,
}


def element_of(name: ElementName | None, body: DiscreteBody, material: PlaneStrain) -> Element:
    """The formulation of this name on a body; without a name enhanced where the cells allow it, else standard.

    Raises
    ------
    StructureError
        The name is not known, or the formulation is not for these cells.
    """
    if name is None:
        name = "enhanced" if (body.mesh.cell, body.mesh.order) == ENHANCEABLE else "standard"
    if name not in ELEMENTS:
        raise StructureError(f"element = {name!r} is not known: use one of {', '.join(ELEMENTS)}")
    return ELEMENTS[name](body, material)
