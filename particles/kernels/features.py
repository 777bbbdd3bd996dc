"""Where a disc meets a polyline: facets and the nodes between them as features of one chain.

Along every facet a disc is before its start, beside it, or beyond its end. With H = 1 for "beyond"
and 0 for "before" some point, a feature between two such points has the charge H(first) - H(second):

- a facet: 1 where the foot of the disc's centre lies on it, else 0;
- a node: 1 in the wedge where neither of its facets has a foot (a corner that points at the disc), -1
  in the wedge where both have one (a notch), else 0.

The distance to the chain has a local minimum where the charge is 1 and a local maximum where it is
-1. A disc that passes a point moves one unit of charge from one feature to its neighbour: the sum
over the chain never changes, and neither does a force that is summed over it with the charges,
because at that moment both features have the same foot.
"""

import math
from typing import NamedTuple

import numpy as np

from particles.kernels.jit import inner_kernel, kernel

INSIDE = 0.5  # of a radius: how far behind a facet a centre still counts as pressed into it


class Foot(NamedTuple):
    """The point of a feature that is nearest to a disc's centre."""

    nx: float  # unit normal from the disc into the body
    ny: float
    distance: float  # of the centre, negative inside the body
    vx: float  # velocity of the material point there
    vy: float
    spin: float  # rate of turn of the facet, at a node of both by their shares
    share: float  # of the node after (facet), or of the facet after (node)


@inner_kernel
def beyond(x, y, from_x, from_y, to_x, to_y, at_x, at_y):
    """Whether (x, y) lies beyond the point `at` along the facet `from`-`to`."""
    return (x - at_x) * (to_x - from_x) + (y - at_y) * (to_y - from_y) >= 0.0


@inner_kernel
def charge_of(side):
    """Charge of a feature: bit 0 of `side` is H at its first point, bit 1 that at its second."""
    return (side & 1) - (side >> 1)


@inner_kernel
def side_of(facets, f, x, y):
    """Where a centre (x, y) stands along feature f."""
    a, c, b = facets.before[f], facets.at[f], facets.after[f]
    px, py = facets.x, facets.y
    if c < 0:
        first = beyond(x, y, px[a], py[a], px[b], py[b], px[a], py[a])
        second = beyond(x, y, px[a], py[a], px[b], py[b], px[b], py[b])
    else:
        first = a < 0 or beyond(x, y, px[a], py[a], px[c], py[c], px[c], py[c])
        second = b >= 0 and beyond(x, y, px[c], py[c], px[b], py[b], px[c], py[c])
    return int(first) | int(second) << 1


@inner_kernel
def turn_rate(facets, a, b):
    """Rate of turn of the facet a-b, counter-clockwise."""
    tx, ty = facets.x[b] - facets.x[a], facets.y[b] - facets.y[a]
    return (tx * (facets.vy[b] - facets.vy[a]) - ty * (facets.vx[b] - facets.vx[a])) / (tx * tx + ty * ty)


@inner_kernel
def along(facets, a, b):
    """Unit vector of the facet a-b; the body lies to its left."""
    tx, ty = facets.x[b] - facets.x[a], facets.y[b] - facets.y[a]
    inverse = 1.0 / math.sqrt(tx * tx + ty * ty)
    return tx * inverse, ty * inverse


@inner_kernel
def foot_on(facets, f, x, y):
    """The foot on feature f, which has a charge."""
    if facets.at[f] < 0:
        return foot_on_facet(facets, facets.before[f], facets.after[f], x, y)
    return foot_on_node(facets, facets.before[f], facets.at[f], facets.after[f], x, y)


@inner_kernel
def foot_on_facet(facets, a, b, x, y):
    ax, ay = facets.x[a], facets.y[a]
    tx, ty = facets.x[b] - ax, facets.y[b] - ay
    inverse = 1.0 / math.sqrt(tx * tx + ty * ty)
    share = ((x - ax) * tx + (y - ay) * ty) * inverse * inverse
    nx, ny = -ty * inverse, tx * inverse
    distance = -((x - ax) * nx + (y - ay) * ny)
    vx = facets.vx[a] + share * (facets.vx[b] - facets.vx[a])
    vy = facets.vy[a] + share * (facets.vy[b] - facets.vy[a])
    return Foot(nx, ny, distance, vx, vy, turn_rate(facets, a, b), share)


@inner_kernel
def foot_on_node(facets, a, c, b, x, y):
    """The node c between a and b. An open end is a tip: what lies beyond it is outside."""
    dx, dy = x - facets.x[c], y - facets.y[c]
    share, spin, ox, oy, open_end = 0.0, 0.0, 0.0, 0.0, a < 0 or b < 0
    past = left = 0.0
    if a >= 0:
        tx, ty = along(facets, a, c)
        past = dx * tx + dy * ty
        ox, oy, spin = ty, -tx, turn_rate(facets, a, c)
    if b >= 0:
        tx, ty = along(facets, c, b)
        left = -(dx * tx + dy * ty)
        share = 1.0 if a < 0 else past / (past + left)
        ox, oy, spin = ox + ty, oy - tx, spin + share * (turn_rate(facets, c, b) - spin)
    d = math.sqrt(dx * dx + dy * dy)
    outside = 1.0 if open_end or dx * ox + dy * oy >= 0.0 else -1.0
    if d > 0.0:
        nx, ny = -outside * dx / d, -outside * dy / d
    else:
        size = math.sqrt(ox * ox + oy * oy)
        nx, ny = -ox / size, -oy / size
    return Foot(nx, ny, outside * d, facets.vx[c], facets.vy[c], spin, share)


@kernel
def touching_features(x, y, radius, facets):
    """Touching grains and features: (n, 7) place of the grain, charge, overlap, normal into the body, its velocity."""
    found = np.empty((facets.grain.shape[0], 7))
    count = 0
    for k in range(facets.grain.shape[0]):
        i = facets.grain[k]
        charge = charge_of(side_of(facets, facets.feature[k], x[i], y[i]))
        if charge != 0:
            foot = foot_on(facets, facets.feature[k], x[i], y[i])
            if radius[i] > foot.distance > -INSIDE * radius[i]:
                found[count, 0], found[count, 1], found[count, 2] = i, charge, radius[i] - foot.distance
                found[count, 3], found[count, 4] = foot.nx, foot.ny
                found[count, 5], found[count, 6] = foot.vx, foot.vy
                count += 1
    return found[:count]


@kernel
def slot_of(facets, first, last, f):
    """Slot of feature f among those of one grain, or -1."""
    if f >= 0:
        for k in range(first, last):
            if facets.feature[k] == f:
                return k
    return -1


@kernel
def note_sides(first, last, x, y, facets):
    """See where the grains of the slots first to last stand, and hand the memory of their contacts over."""
    k = first
    while k < last:
        i, start, passed = facets.grain[k], k, False
        while k < last and facets.grain[k] == i:
            side = side_of(facets, facets.feature[k], x[i], y[i])
            facets.side_now[k] = side
            passed |= side != facets.side[k]
            k += 1
        if passed:
            hand_over(facets, start, k)


@kernel
def hand_over(facets, first, last):
    """Move the units of charge that one grain moved, with the memory of the contacts, slots first to last."""
    for k in range(first, last):  # onwards in the order of the chain, then backwards
        if facets.side_now[k] >> 1 > facets.side[k] >> 1:
            other = slot_of(facets, first, last, facets.following[facets.feature[k]])
            if other >= 0:
                behind = slot_of(facets, first, last, facets.previous[facets.feature[k]])
                ahead = slot_of(facets, first, last, facets.following[facets.feature[other]])
                give(facets, k, other, behind, ahead)
                facets.side[k], facets.side[other] = facets.side[k] | 2, facets.side[other] | 1
    for k in range(last - 1, first - 1, -1):
        if facets.side_now[k] & 1 < facets.side[k] & 1:
            other = slot_of(facets, first, last, facets.previous[facets.feature[k]])
            if other >= 0:
                behind = slot_of(facets, first, last, facets.following[facets.feature[k]])
                ahead = slot_of(facets, first, last, facets.previous[facets.feature[other]])
                give(facets, k, other, behind, ahead)
                facets.side[k], facets.side[other] = facets.side[k] & 2, facets.side[other] & 1
    for k in range(first, last):
        facets.side[k] = facets.side_now[k]


@kernel
def give(facets, giver, taker, behind, ahead):
    """One unit of charge goes from the slot giver to taker; `behind` and `ahead` are their other neighbours."""
    own, other = charge_of(facets.side[giver]), charge_of(facets.side[taker])
    for memory in (facets.spring, facets.moment, facets.dash_n, facets.dash_t, facets.dash_r):
        if memory.shape[0]:
            if own == 1 and other == 0:
                memory[taker], memory[giver] = memory[giver], 0.0
            elif own == 1 and other == -1:  # a minimum and the maximum beside it end in each other
                if ahead >= 0:
                    memory[ahead] += memory[giver] - memory[taker]
                memory[giver] = memory[taker] = 0.0
            elif own == 0 and other == 0 and behind >= 0:  # both begin, out of the contact behind them
                memory[giver] = memory[taker] = memory[behind]
            elif own == 0 and other == -1:
                memory[giver], memory[taker] = memory[taker], 0.0
