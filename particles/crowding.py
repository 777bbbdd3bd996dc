"""A limit of the time step that holds in any packing of given grains."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from particles.contact import Contact, GlobalDamping
from particles.coordination import Neighbours, crowd
from particles.errors import ParticleError
from particles.kernels.slopes import Touching, slopes
from particles.state import Floats, Grains
from particles.timestep import ALLOWED_OVERLAP, DASHPOT_SHARE

ALIKE = 0.01  # share of radius and mass within which grains are put together, on the safe side
SHARES = np.geomspace(0.01, 1.0, 41)  # of the mass lent to shear, tried


@dataclass(frozen=True)
class _Kinds:
    """Grains of like size, (n,) each: the largest radius, lightest and heaviest mass, and what `crowd` says."""

    radius: Floats
    lightest: Floats
    heaviest: Floats
    material: np.ndarray
    crowd: Floats
    aligned: Floats


def packing_limit(
    grains: Grains, contact: Contact, *, damping: GlobalDamping | None = None, scheme: str = "leapfrog"
) -> float:
    """Time step [s] up to which a scheme is stable in every packing of these grains; infinite without free ones.

    With ``mu = 2/dt`` stability asks for ``u^T (K + mu C) u <= mu^2 u^T M u`` (`sharp_limit`). That
    holds for the whole if it holds for each contact with a part of its grains' mass, as long as
    the parts of a grain do not exceed it. A contact takes ``m (n n^T + q t t^T)/S``, ``0 < q <= 1``,
    and the inertia ``I/z``, with z the largest possible number of contacts, ``S = (1 - q) s + q z``,
    and s the largest possible eigenvalue of the sum of ``n n^T`` over the contacts of a grain
    (`particles.coordination`). Then, for every pair of sizes,

        normal   lambda = k_n (S_i/m_i + S_j/m_j)
        shear    lambda = k_t ((S_i/m_i + S_j/m_j)/q + r_i^2 z_i/I_i + r_j^2 z_j/I_j) + k_r (z_i/I_i + z_j/I_j)

    and gamma likewise from the dashpots, plus the global damping (twice both for velocity Verlet);
    ``mu = (gamma + sqrt(gamma^2 + 4 lambda))/2``; the largest mu counts, at the best q (any is
    valid; without friction q = 0). A wall has no terms of its own. A prescribed grain takes half
    the part of a free one, and so counts as half a contact, with the terms of its partner doubled.

    Valid for overlaps up to e = 5 % of the smaller radius (Hertz's slopes are taken there), for
    walls that meet at 60 degrees or more, and for prescribed grains that overlap neither walls nor
    others than those of their own body, at the spacing they have now. The limit of equal grains in a hexagonal packing
    without friction, ``omega_max^2 = 6 k_n/m``, is missed by 3 % of omega_max^2.

    Raises
    ------
    ParticleError
        If prescribed grains of one body lie so densely that the contacts with them cannot be counted.
    """
    if grains.n_free == 0:
        return math.inf
    kinds = _kinds(grains)
    touching = _touching(grains, contact, kinds)
    k, c = np.empty((len(touching.i), 3)), np.empty((len(touching.i), 3))
    slopes(contact.numbers(), touching.laws, k, c)
    c *= DASHPOT_SHARE[scheme]
    drag = np.zeros(2) if damping is None else DASHPOT_SHARE[scheme] * np.array(damping.numbers())

    def terms(of_kind: Floats) -> Floats:
        return of_kind[touching.i] + touching.paired * of_kind[touching.j]

    turning = kinds.crowd / (0.5 * kinds.lightest * kinds.radius**2)
    arms = terms(turning * kinds.radius**2)
    smallest = math.inf
    for q in SHARES if contact.spins else [0.0]:
        shares = terms(((1.0 - q) * kinds.aligned + q * kinds.crowd) / kinds.lightest)
        rate = _rate(k[:, 0] * shares, c[:, 0] * shares + drag[0])
        if contact.spins:
            shear, roll = shares / q + arms, terms(turning)
            shaken, slowed = k[:, 1] * shear + k[:, 2] * roll, c[:, 1] * shear + c[:, 2] * roll
            rate = np.maximum(rate, _rate(shaken, slowed + drag.max()))
        smallest = min(smallest, float(rate.max()))
    return 2.0 / smallest


def _rate(lam: Floats, gamma: Floats) -> Floats:
    return 0.5 * (gamma + np.sqrt(gamma**2 + 4.0 * lam))


@dataclass(frozen=True)
class _Contacts:
    """One contact (n,) of each possible pair: kinds i and j, whether j shares, and what the laws ask."""

    i: np.ndarray
    j: np.ndarray
    paired: Floats
    laws: Touching


def _touching(grains: Grains, contact: Contact, kinds: _Kinds) -> _Contacts:
    """All pairs of kinds, then every kind at a wall of any material, then with a prescribed grain of each body."""
    n, bodies = len(kinds.radius), list(grains.bodies().values())
    i, j = np.triu_indices(n)
    every, ease = np.arange(n), 1.0 / (1.5 * kinds.heaviest * kinds.radius**2)
    parts = [(i, j, kinds.radius[j], 1.0 / kinds.heaviest[j], ease[j], kinds.material[j], 1.0)]
    parts += [(every, every, np.inf, 0.0, 0.0, number, 0.0) for number in range(contact.materials)]
    parts += [(every, every, grains.radius[body].max(), 0.0, 0.0, grains.material[body.start], 1.0) for body in bodies]
    columns = zip(*(np.broadcast_arrays(*part) for part in parts), strict=True)
    i, j, partner, inverse_mass, compliance, material, paired = (np.concatenate(column) for column in columns)
    own = kinds.radius[i]
    asked = Touching(
        ALLOWED_OVERLAP * np.minimum(own, partner),
        own / (1.0 + own / partner),
        1.0 / kinds.heaviest[i] + inverse_mass,
        ease[i] + compliance,
        kinds.material[i],
        material.astype(np.int64),
    )
    return _Contacts(i, j, paired, asked)


def _kinds(grains: Grains) -> _Kinds:
    free = slice(grains.n_free)
    radius, mass, material = grains.radius[free], grains.mass[free], grains.material[free]
    keys = np.floor(np.log(np.column_stack([radius, mass])) / ALIKE).astype(np.int64)
    keys, kind = np.unique(np.column_stack([material, keys]), axis=0, return_inverse=True)
    n = len(keys)
    largest, lightest, heaviest = np.zeros(n), np.full(n, np.inf), np.zeros(n)
    np.maximum.at(largest, kind, radius)
    np.minimum.at(lightest, kind, mass)
    np.maximum.at(heaviest, kind, mass)
    around = _neighbours(grains)
    most, aligned = np.array([crowd(r, around) for r in largest]).T
    return _Kinds(largest, lightest, heaviest, keys[:, 0], most, aligned)


def _neighbours(grains: Grains) -> Neighbours:
    """The smallest free and prescribed grains, and the spacing of the latter in each body."""
    rows = []
    for body, places in grains.bodies().items():
        if places.stop - places.start > 1:
            own = np.column_stack([grains.x[places], grains.y[places]])
            spacing, radius = float(cKDTree(own).query(own, k=2)[0][:, 1].min()), float(grains.radius[places].max())
            if spacing <= ALLOWED_OVERLAP * radius:
                raise ParticleError(
                    f"the prescribed grains of body {body} lie {spacing:g} m apart, closer than {ALLOWED_OVERLAP:g} of "
                    f"their radius {radius:g} m, and no limit of the time step can be proven: space them out, or "
                    "give a time step"
                )
            rows.append((radius, spacing))
    return Neighbours(
        smallest=float(grains.radius[: grains.n_free].min()),
        prescribed=float(grains.radius[grains.n_free :].min()) if len(grains) > grains.n_free else None,
        rows=tuple(rows),
        overlap=ALLOWED_OVERLAP,
    )
