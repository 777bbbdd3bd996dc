"""The springs and dashpots of the contacts as they stand, as one linear network."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, diags

from particles.kernels.slopes import Touching, slopes
from particles.periodic import nearest_image
from particles.state import Floats
from particles.system import ParticleSystem

Places = NDArray[np.int64]
FIXED = -1


@dataclass(frozen=True, kw_only=True)
class StiffnessNetwork:
    """Small motion about the present state: ``M a + C v + K u = 0``, ``K = B^T k B``, ``C = B^T c B + alpha M``.

    The unknowns are the displacements u [m] of the free grains along x, then along y, then, if
    grains turn, their angles [rad], each in the order of `Grains`. Walls, facets and
    prescribed grains are fixed.

    Attributes
    ----------
    stretch : (n_springs, n_unknowns) sparse matrix
        B: stretch of every spring per unknown (model 1.1; lever arms to mid-overlap).
    stiffness, damping : (n_springs,)
        k [N/m or N m] and c [N s/m or N m s].
    inertia : (n_unknowns,)
        Diagonal of M [kg/m or kg m].
    drag : (n_unknowns,)
        Global damping alpha [1/s].
    contacts : int
        Touching pairs, walls and facets.

    Notes
    -----
    Springs are taken at their slope at the present overlap. Every contact that has friction
    sticks: one at Coulomb's or at the rolling limit counts with its springs, and one that may not
    pull with its tension. The constant rolling torque (type A) has no slope and does not count.
    Where a disc covers a notch of facets, springs of a negative k take away what both have there.
    Near pairs that do not touch are left out, and so is the turn of the normal force with the
    contact, which takes the share delta/d of k_n from the transverse stiffness.
    """

    stretch: csr_matrix
    stiffness: Floats
    damping: Floats
    inertia: Floats
    drag: Floats
    contacts: int

    def stiffness_matrix(self) -> csr_matrix:
        """K."""
        return (self.stretch.T @ diags(self.stiffness) @ self.stretch).tocsr()

    def damping_matrix(self) -> csr_matrix:
        """C."""
        return (self.stretch.T @ diags(self.damping) @ self.stretch + diags(self.drag * self.inertia)).tocsr()

    def by_inertia(self) -> csr_matrix:
        """``B M^(-1/2)``."""
        return (self.stretch @ diags(1.0 / np.sqrt(self.inertia))).tocsr()


@dataclass(frozen=True)
class _Contacts:
    """Touching contacts: grains i, and j or FIXED, normals (n, 2) from i to j, lever arms, what laws ask, charges."""

    i: Places
    j: Places
    normal: Floats
    arm_i: Floats
    arm_j: Floats
    laws: Touching
    charge: Floats


def stiffness_network(system: ParticleSystem) -> StiffnessNetwork:
    """The network of the contacts of a system at its present positions.

    Free of contacts it has no springs. Changes nothing but that the system is started.
    """
    system.start()
    parts = [_pairs(system), _walls(system), *([] if system.facets is None else [_facets(system)])]
    i, j, normal, arm_i, arm_j, charge = (
        np.concatenate([getattr(part, name) for part in parts])
        for name in ("i", "j", "normal", "arm_i", "arm_j", "charge")
    )
    asked = Touching(*(np.concatenate(column) for column in zip(*(part.laws for part in parts), strict=True)))
    k, c = np.empty((len(i), 3)), np.empty((len(i), 3))
    slopes(system.contact.numbers(), asked, k, c)
    k, c = charge[:, None] * k, charge[:, None] * c
    g, n, spins = system.grains, system.grains.n_free, system.contact.spins
    stretch = _stretch(i, np.where(j < n, j, FIXED), normal, arm_i, arm_j, n, spins)
    present = np.nonzero((k.T.ravel() != 0.0) | (c.T.ravel() != 0.0))[0]
    alpha_t, alpha_r = (0.0, 0.0) if system.damping is None else system.damping.numbers()
    mass, inertia = g.mass[:n], g.inertia[:n]
    return StiffnessNetwork(
        stretch=stretch[present],
        stiffness=k.T.ravel()[present],
        damping=c.T.ravel()[present],
        inertia=np.concatenate([mass, mass, inertia] if spins else [mass, mass]),
        drag=np.repeat([alpha_t, alpha_t, alpha_r][: 3 if spins else 2], n),
        contacts=int(charge.sum()),
    )


def _pairs(system: ParticleSystem) -> _Contacts:
    g, listed = system.grains, system.list.pairs
    i, j = listed.owner.astype(np.int64), listed.partner.astype(np.int64)
    apart = np.column_stack(
        [nearest_image(g.x[j] - g.x[i], system.period[0]), nearest_image(g.y[j] - g.y[i], system.period[1])]
    )
    distance, reach = np.hypot(*apart.T), g.radius[i] + g.radius[j]
    touch = (distance < reach) & (i < g.n_free)
    i, j, distance, reach = i[touch], j[touch], distance[touch], reach[touch]
    delta = reach - distance
    asked = Touching(
        delta,
        g.radius[i] * g.radius[j] / reach,
        g.inverse_mass[i] + g.inverse_mass[j],
        g.roll_compliance[i] + g.roll_compliance[j],
        g.material[i].astype(np.int64),
        g.material[j].astype(np.int64),
    )
    normal = apart[touch] / distance[:, None]
    return _Contacts(i, j, normal, g.radius[i] - 0.5 * delta, g.radius[j] - 0.5 * delta, asked, np.ones(len(i)))


def _walls(system: ParticleSystem) -> _Contacts:
    g, walls = system.grains, system.list.walls
    i, w = walls.grain.astype(np.int64), walls.wall.astype(np.int64)
    delta = g.radius[i] - (g.x[i] - walls.px[w]) * walls.nx[w] - (g.y[i] - walls.py[w]) * walls.ny[w]
    touch = delta > 0.0
    i, w, delta = i[touch], w[touch], delta[touch]
    asked = Touching(
        delta, g.radius[i], g.inverse_mass[i], g.roll_compliance[i], g.material[i].astype(np.int64), walls.material[w]
    )
    normal = -np.column_stack([walls.nx[w], walls.ny[w]])
    arm = g.radius[i] - 0.5 * delta
    return _fixed(system, i, normal, arm, asked, np.ones(len(i)))


def _facets(system: ParticleSystem) -> _Contacts:
    g, facets = system.grains, system.facets
    i, charge, delta, *normal = facets.touching(g).T[:5]
    free = i < g.n_free
    i, charge, delta, normal = i[free].astype(np.int64), charge[free], delta[free], np.column_stack(normal)[free]
    material = np.broadcast_to(facets.arrays.material, len(i))
    asked = Touching(
        delta, g.radius[i], g.inverse_mass[i], g.roll_compliance[i], g.material[i].astype(np.int64), material
    )
    return _fixed(system, i, normal, g.radius[i] - delta, asked, charge)


def _fixed(
    system: ParticleSystem, i: Places, normal: Floats, arm: Floats, asked: Touching, charge: Floats
) -> _Contacts:
    """Contacts with something that does not give way."""
    return _Contacts(i, np.full(len(i), len(system.grains)), normal, arm, np.zeros(len(i)), asked, charge)


def _stretch(i: Places, j: Places, normal: Floats, arm_i: Floats, arm_j: Floats, n: int, spins: bool) -> csr_matrix:
    """B (3 contacts, unknowns): the normal rows of all contacts, then the tangential and the rolling ones."""
    contacts = len(i)
    tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
    one = np.ones(contacts)
    entries = [(0, axis, -normal[:, axis], normal[:, axis]) for axis in (0, 1)]
    if spins:
        entries += [(1, axis, -tangent[:, axis], tangent[:, axis]) for axis in (0, 1)]
        entries += [(1, 2, -arm_i, -arm_j), (2, 2, one, -one)]
    rows, columns, values = [], [], []
    for kind, unknown, of_i, of_j in entries:
        for grain, value in ((i, of_i), (j, of_j)):
            free = grain != FIXED
            rows.append(kind * contacts + np.nonzero(free)[0])
            columns.append(unknown * n + grain[free])
            values.append(value[free])
    place = (np.concatenate(rows), np.concatenate(columns))
    return csr_matrix((np.concatenate(values), place), shape=(3 * contacts, (3 if spins else 2) * n))
