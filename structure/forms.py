"""The plane-strain forms in UFL and what is assembled from them."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc as fem_petsc
from dolfinx.mesh import meshtags
from numpy.typing import NDArray
from petsc4py import PETSc

from meshes import StructureMesh
from structure import compat
from structure.material import PlaneStrain


def strain(u: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
    """Small strain, ``(grad u + grad u^T)/2``."""
    return ufl.sym(ufl.grad(u))


def strain_components(u: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
    """Strain as a vector xx, yy, xy (tensor component)."""
    eps = strain(u)
    return ufl.as_vector([eps[0, 0], eps[1, 1], eps[0, 1]])


def _assembled(form: ufl.Form) -> PETSc.Mat:
    matrix = fem_petsc.assemble_matrix(compat.compiled(form))
    matrix.assemble()
    return matrix


def mass_matrix(space: fem.FunctionSpace, density: float, order: int) -> PETSc.Mat:
    """Consistent mass [kg/m], ``int rho v . w dx``; the rule integrates straight cells exactly."""
    trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
    rho = fem.Constant(space.mesh, PETSc.ScalarType(density))
    dx = ufl.dx(metadata={"quadrature_degree": 2 * order + 1})
    return _assembled(rho * ufl.inner(trial, test) * dx)


def stiffness_matrix(space: fem.FunctionSpace, material: PlaneStrain, order: int) -> PETSc.Mat:
    """Stiffness [Pa], ``int sigma(v) : eps(w) dx``; 2 x 2 Gauss points for Q4, 3 x 3 for Q9."""
    trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
    lam, mu = (fem.Constant(space.mesh, PETSc.ScalarType(value)) for value in material.lame)
    stress = lam * ufl.div(trial) * ufl.Identity(2) + 2 * mu * strain(trial)
    dx = ufl.dx(metadata={"quadrature_degree": 2 * order})
    return _assembled(ufl.inner(stress, strain(test)) * dx)


def boundary_weights(space: fem.FunctionSpace, mesh: StructureMesh, tags: tuple[int, ...]) -> NDArray[np.float64]:
    """Share [m] of a tagged boundary's length at this rank's nodes, shape (owned nodes,)."""
    marked = np.isin(mesh.facet_tags.values, tags)
    facets = mesh.facet_tags.indices[marked]
    on_boundary = meshtags(mesh.domain, 1, facets, np.ones(len(facets), dtype=np.int32))
    metadata = {"quadrature_degree": 2 * mesh.order + 1}
    ds = ufl.Measure("ds", domain=mesh.domain, subdomain_data=on_boundary, metadata=metadata)
    ones = fem.Constant(mesh.domain, np.ones(2, dtype=PETSc.ScalarType))
    vector = fem_petsc.assemble_vector(compat.compiled(ufl.inner(ones, ufl.TestFunction(space)) * ds(1)))
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    return vector.array.reshape(-1, 2)[:, 0].copy()
