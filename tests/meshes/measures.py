"""Lengths of boundaries by integration, areas by corners."""

import meshes
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI


def tagged_length(mesh: meshes.StructureMesh, name: str) -> float:
    ds = ufl.Measure(
        "ds",
        domain=mesh.domain,
        subdomain_data=mesh.facet_tags,
        metadata={"quadrature_degree": 8},
    )
    one = fem.Constant(mesh.domain, 1.0)
    share = sum(fem.assemble_scalar(fem.form(one * ds(tag))) for tag in mesh.boundaries[name])
    return mesh.domain.comm.allreduce(share, op=MPI.SUM)


def shoelace(points: np.ndarray) -> float:
    x, y = points.T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2)
