"""What differs between versions of dolfinx: this module alone asks, by looking for a name, never for a number.

Tested with 0.5.2 (Debian 12: UFL 2022, PETSc 3.18) and 0.9.0 (Debian 13: UFL 2024, PETSc 3.22). Read in the
documentation and NOT tested: 0.10 (`interpolation_points` is an attribute, vectors are created of spaces) and 0.11
(`Geometry.dofmaps`, a list, takes the place of `dofmap`). The `petsc_options_prefix` that `LinearProblem` and
`NonlinearProblem` demand from 0.10 on does not concern us: solvers are made with petsc4py and named there. The one
difference outside is a name that `meshes` needs, which opens on nothing of ours: `gmshio`, from 0.10 on `gmsh`, in
`meshes/session.py`.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import basix
import dolfinx
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc as fem_petsc
from numpy.typing import NDArray
from petsc4py import PETSc

# Seconds for which dolfinx waits for another process that compiles the same form; its own 10 are few on a busy machine.
WAIT = 120
_defaults = getattr(dolfinx.jit, "DOLFINX_DEFAULT_JIT_OPTIONS", None) or dolfinx.jit.DOLFINX_DEFAULT_JIT_PARAMETERS
_defaults["timeout"] = (WAIT, _defaults["timeout"][1])


def clear_broken_builds(cache: Path) -> None:
    """Remove what a killed process began to compile in dolfinx's cache: all later ones would wait for it in vain.

    A build under way is younger than the time for which others wait for it.
    """
    for begun in cache.glob("*.c"):
        with suppress(OSError):  # another process clears it too
            if not begun.with_suffix(".c.cached").exists() and time.time() - begun.stat().st_mtime > WAIT:
                begun.unlink()


clear_broken_builds(Path(str(_defaults["cache_dir"][0])).expanduser())

CELLS = {"quadrilateral": basix.CellType.quadrilateral, "triangle": basix.CellType.triangle}


@contextmanager
def quiet_compiler() -> Iterator[None]:
    """Keep the compiler's chatter on the root logger away from the user."""
    before = logging.root.manager.disable
    logging.disable(max(before, logging.INFO))
    try:
        yield
    finally:
        logging.disable(before)


def compiled(form: ufl.Form) -> fem.Form:
    """A form, compiled."""
    with quiet_compiler():
        return fem.form(form)


def compiled_expression(expression: ufl.core.expr.Expr, points: NDArray[np.float64]) -> fem.Expression:
    """An expression at reference points, compiled."""
    with quiet_compiler():
        return fem.Expression(expression, points)


def empty_vector(form: fem.Form) -> PETSc.Vec:
    """Zeros with room for ghosts, to assemble a linear form into.

    dolfinx creates it of a form up to 0.9 and of a space from 0.10 on; all versions assemble one out of a form.
    """
    vector = fem_petsc.assemble_vector(form)
    with vector.localForm() as local:
        local.set(0.0)
    return vector


def vector_space(domain: dolfinx.mesh.Mesh, order: int) -> fem.FunctionSpace:
    """Continuous Lagrange space of plane vectors."""
    with quiet_compiler():
        if hasattr(fem, "functionspace"):
            return fem.functionspace(domain, ("Lagrange", order, (2,)))
        return fem.VectorFunctionSpace(domain, ("Lagrange", order), dim=2)


def cell_nodes(domain: dolfinx.mesh.Mesh) -> NDArray[np.int32]:
    """Local geometry nodes of this rank's cells, ghosts included, shape (cells, nodes)."""
    by_kind_of_cell = getattr(domain.geometry, "dofmaps", None)
    if isinstance(by_kind_of_cell, list):
        return by_kind_of_cell[0]
    return _table(domain.geometry.dofmap, domain)


def cell_dofs(space: fem.FunctionSpace) -> NDArray[np.int32]:
    """Local nodes of the unknowns of this rank's cells, ghosts included, shape (cells, nodes)."""
    return _table(space.dofmap.list, space.mesh)


def _table(rows: object, domain: dolfinx.mesh.Mesh) -> NDArray[np.int32]:
    """One row for each cell: an array since 0.7, an adjacency list before."""
    if isinstance(rows, np.ndarray):
        return rows
    cells = domain.topology.index_map(domain.topology.dim)
    return rows.array.reshape(cells.size_local + cells.num_ghosts, -1)


def interpolation_points(space: fem.FunctionSpace) -> NDArray[np.float64]:
    """Reference points of the nodes of a cell, in the order of the cell's unknowns."""
    points = space.element.interpolation_points
    return points() if callable(points) else points


def gauss_points(cell: str, degree: int) -> NDArray[np.float64]:
    """Reference points of a Gauss rule exact to `degree`."""
    return basix.make_quadrature(CELLS[cell], degree)[0]


def evaluate(expression: fem.Expression, domain: dolfinx.mesh.Mesh, cells: NDArray[np.int32]) -> NDArray[np.float64]:
    """Values of an expression on cells."""
    if hasattr(fem, "functionspace"):
        return expression.eval(domain, cells)
    return expression.eval(cells)


def facet_nodes(space: fem.FunctionSpace, facets: int) -> list[NDArray[np.int32]]:
    """Of each of the `facets` of a cell, the nodes on it among the cell's: its two vertices, then the others."""
    layout = space.dofmap.dof_layout
    return [np.array(layout.entity_closure_dofs(1, facet)) for facet in range(facets)]
