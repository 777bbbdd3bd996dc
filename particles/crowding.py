"""A limit of the time step that holds in any packing of given grains."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from particles.contact import Contact, GlobalDamping
from particles.errors import ParticleError
from particles.kernels.slopes import Touching, slopes
from particles.state import Floats, Grains
from particles.timestep import ALLOWED_OVERLAP, DASHPOT_SHARE

ALIKE = 0.01  # share of radius and mass within which grains are put together, on the safe side
SHARES = np.geomspace(0.01, 1.0, 41)  # of the mass lent to shear, tried


@dataclass(frozen=True)
class _Kinds:
    """Grains of like size, (n,) each: the largest radius, lightest and heaviest mass, and their neighbours.

    `crowd` is the largest number of contacts, `aligned` the largest eigenvalue of the sum of n n^T over them.
    """

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
    and s the largest possible eigenvalue of the sum of ``n n^T`` over the contacts of a grain. Then,
    for every pair of sizes,

        normal   lambda = k_n (S_i/m_i + S_j/m_j)
        shear    lambda = k_t ((S_i/m_i + S_j/m_j)/q + r_i^2 z_i/I_i + r_j^2 z_j/I_j) + k_r (z_i/I_i + z_j/I_j)

    and gamma likewise from the dashpots, plus the global damping (twice both for velocity Verlet);
    ``mu = (gamma + sqrt(gamma^2 + 4 lambda))/2``; the largest mu counts, at the best q (any is
    valid; without friction q = 0). z and s follow from the smallest angle between two neighbours
    of a grain, ``sin(angle/2) = (1 - e/2) r/(r_i + r)``, r the smallest radius around. A wall or a
    prescribed grain is a partner without a term of its own.

    Valid for overlaps up to e = 5 % of the smaller radius (Hertz's slopes are taken there), for
    walls that meet at 60 degrees or more, and for prescribed grains that overlap those of their
    own body alone, at the spacing they have now. The limit of equal grains in a hexagonal packing
    without friction, ``omega_max^2 = 6 k_n/m``, is missed by 3 % of omega_max^2.

    Raises
    ------
    ParticleError
        If prescribed grains of one body lie so densely that the contacts with them cannot be counted.
    """
    if grains.n_free == 0:
        return math.inf
    kinds = _kinds(grains)
    i, j = np.triu_indices(len(kinds.radius))
    fixed = np.repeat(np.arange(len(kinds.radius)), contact.materials)
    materials = np.tile(np.arange(contact.materials), len(kinds.radius))
    k, c = _slopes(contact, kinds, np.append(i, fixed), j, materials)
    i, paired = np.append(i, fixed), np.append(np.ones(len(j)), np.zeros(len(fixed)))
    j = np.append(j, fixed)

    def sum_over(of_kind: Floats) -> Floats:
        return of_kind[i] + paired * of_kind[j]

    turning = kinds.crowd / (0.5 * kinds.lightest * kinds.radius**2)
    arms = turning * kinds.radius**2
    drag = np.zeros(2) if damping is None else DASHPOT_SHARE[scheme] * np.array(damping.numbers())
    c *= DASHPOT_SHARE[scheme]
    largest = math.inf
    for q in SHARES if contact.spins else [0.0]:
        shares = sum_over(((1.0 - q) * kinds.aligned + q * kinds.crowd) / kinds.lightest)
        rate = _rate(k[:, 0] * shares, c[:, 0] * shares + drag[0])
        if contact.spins:
            shear, roll = shares / q + sum_over(arms), sum_over(turning)
            rate = np.maximum(
                rate, _rate(k[:, 1] * shear + k[:, 2] * roll, c[:, 1] * shear + c[:, 2] * roll + drag.max())
            )
        largest = min(largest, float(rate.max()))
    return 2.0 / largest


def _rate(lam: Floats, gamma: Floats) -> Floats:
    return 0.5 * (gamma + np.sqrt(gamma**2 + 4.0 * lam))


def _slopes(
    contact: Contact, kinds: _Kinds, i: np.ndarray, j: np.ndarray, materials: np.ndarray
) -> tuple[Floats, Floats]:
    """Springs and dashpots (n, 3) at the allowed overlap: of i with j, then of the rest of i with fixed bodies."""
    pairs = len(j)
    radius, mass, rest = kinds.radius[i], kinds.heaviest[i], i[pairs:]
    ease = 1.0 / (1.5 * kinds.heaviest * kinds.radius**2)
    delta = ALLOWED_OVERLAP * np.append(np.minimum(radius[:pairs], kinds.radius[j]), kinds.radius[rest])
    r_eff = np.append(radius[:pairs] * kinds.radius[j] / (radius[:pairs] + kinds.radius[j]), kinds.radius[rest])
    asked = Touching(
        delta,
        r_eff,
        1.0 / mass + np.append(1.0 / kinds.heaviest[j], np.zeros(len(rest))),
        ease[i] + np.append(ease[j], np.zeros(len(rest))),
        kinds.material[i],
        np.append(kinds.material[j], materials),
    )
    k, c = np.empty((len(i), 3)), np.empty((len(i), 3))
    slopes(contact.numbers(), asked, k, c)
    return k, c


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
    crowd, aligned = np.array([_crowd(_smallest_angle(r, grains)) for r in largest]).T
    return _Kinds(largest, lightest, heaviest, keys[:, 0], crowd, aligned)


def _smallest_angle(radius: float, grains: Grains) -> float:
    """Smallest angle [rad] between two neighbours of a free grain, which overlap each other as far as allowed."""
    smallest = float(grains.radius.min())
    angle = _angle(radius + smallest, (2.0 - ALLOWED_OVERLAP) * smallest, ALLOWED_OVERLAP * smallest)
    for body, places in grains.bodies().items():
        if places.stop - places.start > 1:
            own = np.column_stack([grains.x[places], grains.y[places]])
            apart, partner = float(cKDTree(own).query(own, k=2)[0][:, 1].min()), float(grains.radius[places].max())
            if apart <= ALLOWED_OVERLAP * partner:
                raise ParticleError(
                    f"the prescribed grains of body {body} lie {apart:g} m apart, closer than {ALLOWED_OVERLAP:g} of "
                    f"their radius {partner:g} m, and no limit of the time step can be proven: space them out, or "
                    "give a time step"
                )
            angle = min(angle, _angle(radius + partner, apart, ALLOWED_OVERLAP * partner))
    return angle


def _angle(distance: float, apart: float, overlap: float) -> float:
    """Smallest angle [rad] between two neighbours `apart`: both at a `distance`, or one nearer by an overlap."""
    near = distance - overlap
    cosines = (1.0 - 0.5 * (apart / distance) ** 2, (distance**2 + near**2 - apart**2) / (2.0 * distance * near))
    return math.acos(max(*cosines, -1.0))


def _crowd(angle: float) -> tuple[float, float]:
    """Largest number of contacts that keep an angle between them, and largest eigenvalue of their sum of n n^T.

    The eigenvalue is the largest sum of cos^2 of their directions from an axis: side by side around
    either end of it, p contacts have ``(p + cos(2 a) sin(p angle)/sin(angle))/2``, a the turn of their
    middle from the axis, with none of them beyond the perpendicular.
    """
    most = int(2.0 * math.pi / angle * (1.0 + 1e-9))
    side = np.arange(int(math.pi / angle * (1.0 + 1e-9)) + 2)
    spread = np.sin(side * angle) / math.sin(angle)
    turned = np.maximum(math.pi - (side - 1) * angle, 0.0)  # 2 a at most; tried where a turn is better
    held = 0.5 * (side + np.where(spread < 0.0, spread * np.cos(turned), spread))
    both = held[:, None] + held[None]
    return float(most), float(both[side[:, None] + side[None] <= most].max())
