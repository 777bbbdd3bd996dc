"""A free plane-strain beam on discrete springs, with numpy and scipy alone: what the tests compare with."""

from dataclasses import dataclass

import numpy as np
from independent_body import IndependentBody
from scipy.sparse import csr_matrix, diags
from scipy.sparse.linalg import eigsh, splu


@dataclass(frozen=True)
class Rest:
    """State at rest: displacement (2 n,) [m], push and shear (k,) [N/m] of each spring on the beam."""

    displacement: np.ndarray
    push: np.ndarray
    shear: np.ndarray
    slips: np.ndarray


class IndependentBeam(IndependentBody):
    """Rectangle of ``along x across`` bilinear cells from (0, 0), lower face on springs.

    Nodes are numbered row by row from below; unknowns are (x, y) of each node.
    """

    def __init__(self, *, length: float, height: float, along: int, across: int, young: float, poisson: float) -> None:
        self.length, self.height, self.along, self.across = length, height, along, across
        column, row = (a.ravel() for a in np.meshgrid(np.arange(along), np.arange(across)))
        first = row * (along + 1) + column
        corners = np.stack([first, first + 1, first + along + 2, first + along + 1], axis=1)
        x, y = np.meshgrid(np.linspace(0.0, length, along + 1), np.linspace(0.0, height, across + 1))
        super().__init__(np.column_stack([x.ravel(), y.ravel()]), corners, young=young, poisson=poisson)

    def fastest_on_springs(self, springs: np.ndarray, stiffness: float, density: float) -> float:
        """Largest omega^2 [1/s^2] of the mass on vertical `springs` [N/m], without its own stiffness."""
        below = self._at_springs(springs, 1)
        pulled = (stiffness * below.T @ below).tocsc()
        return float(eigsh(pulled, 1, self.mass(density).tocsc(), return_eigenvectors=False)[0])

    def uniform(self, total: float) -> np.ndarray:
        """Nodal forces of a vertical force `total` [N/m] spread evenly over the upper face."""
        share = np.ones(self.along + 1)
        share[[0, -1]] = 0.5
        return self.on_top(np.arange(self.along + 1), total * share / self.along)

    def on_top(self, column: np.ndarray | int, force: np.ndarray | float) -> np.ndarray:
        """Nodal forces of vertical forces [N/m] on nodes of the upper face, counted from the left."""
        nodal = np.zeros(self.size)
        nodal[2 * (self.across * (self.along + 1) + column) + 1] = force
        return nodal

    def middle(self, displacement: np.ndarray) -> np.ndarray:
        """Vertical displacement (along + 1,) [m] of the middle row of nodes."""
        return displacement[1::2].reshape(self.across + 1, -1)[self.across // 2]

    def rest(
        self,
        load: np.ndarray,
        springs: np.ndarray,
        *,
        normal: float,
        tangential: float,
        between: float,
        friction: float = np.inf,
        may_pull: bool = False,
        below_facets: float | None = None,
        couples: bool = True,
    ) -> Rest:
        """Equilibrium on springs at abscissae `springs`; the active set is found by iteration.

        Each spring is a pair of discs, one above the other, whose centres are `between` apart when
        they just touch. Compressed by delta and displaced sideways by x, the line of centres turns
        by ``phi = x/(between - delta)``, which tilts the normal force, and the tangential spring is
        stretched by the integral of ``(between - delta) dphi``; for a load that grows in
        proportion this is ``-x (between/delta) ln(1 - delta/between)``. Sideways each pair so has
        the stiffness ``k_t (1 + delta/(2 between) + ...) - F_n/(between - delta)``. At Coulomb's
        limit the tangential spring is replaced by its constant force. The upper disc turns with its facet, by the
        facet's slope s: the contact, ``(between - delta)/2`` below its centre, goes ``(between/2 - delta/4) s``
        farther, and the shear turns the facet with that arm; without `couples` the disc does neither.

        Discs of the radius `below_facets` [m] have no such line: `between` is infinite, the normal force leans
        with the facet's own slope, and stays where it is when the facet moves along.
        """
        across, along_x = self._at_springs(springs, 1), self._at_springs(springs, 0)
        closed, slips = np.ones(len(springs), bool), np.zeros(len(springs), bool)
        push, slide, climb, lean = np.zeros((4, len(springs)))
        turn = self._slope_at(springs) if couples and not below_facets else None
        for _ in range(100):
            delta = push / normal
            stretch = 1 + delta / (2 * between) + (delta / between) ** 2 / 3
            rub, reach, tilt = diags(stretch) @ along_x, along_x, closed * push / (between - delta)
            if turn is not None:
                rub, reach = rub + diags(between / 2 - delta / 4) @ turn, reach + diags((between - delta) / 2) @ turn
            sticks = closed * ~slips * tangential
            held = closed * np.where(slips, -friction * push * np.sign(slide), -tangential * climb)
            system = self.stiffness + across.T @ diags(closed * normal) @ across
            system = system + reach.T @ diags(sticks) @ rub - along_x.T @ diags(tilt) @ along_x
            if below_facets:
                slope = self._slope_at(springs - slide - below_facets * lean)  # the foot on the material
                turned = along_x.T @ diags(push) @ slope
                system = system + turned + turned.T
            moved = splu(system.tocsc()).solve(load + reach.T @ held)
            down, slide = -(across @ moved), rub @ moved
            if below_facets:
                lean = slope @ moved
                climb = -0.5 * lean * down  # of the way along a facet that turns while it goes down
            old = (push, closed, slips)
            push = closed * normal * down
            closed = np.full(len(springs), True) if may_pull else down > 0
            slips = np.abs(tangential * slide) > friction * np.maximum(push, 0)
            unchanged = (old[1] == closed).all() and (old[2] == slips).all()
            if unchanged and np.abs(push - old[0]).max() <= 1e-12 * np.abs(push).max():
                shear = held - sticks * slide + tilt * (along_x @ moved) - push * lean
                return Rest(moved, push, shear, slips & closed)
        raise AssertionError("the set of closed springs does not settle")

    def facet_of(self, abscissae: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """First and second node of the facet of the lower face at `abscissae` [m], and the share of the second."""
        place = abscissae * self.along / self.length
        node = np.minimum(np.floor(place + 1e-9).astype(int), self.along - 1)
        return node, node + 1, place - node

    def _slope_at(self, springs: np.ndarray) -> csr_matrix:
        """Slope of the facet above each spring from all unknowns; half that of both where a node is there."""
        slopes = []
        for beside in (-1e-9, 1e-9):
            first, second, _ = self.facet_of(np.maximum(springs + beside, 0.0))
            none = np.zeros(len(springs))
            slopes.append((self.between(second, first, none) - self.between(first, second, none))[1::2])
        return (slopes[0] + slopes[1]) * (self.along / self.length / 2)

    def _at_springs(self, springs: np.ndarray, component: int) -> csr_matrix:
        """Displacement component of the lower face at `springs` from all unknowns, linear in a facet."""
        return self.between(*self.facet_of(springs))[component::2]
