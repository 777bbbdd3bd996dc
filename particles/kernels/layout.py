"""The groups of arrays and numbers that walk through the kernels together.

Grains are ordered: the free ones first, sorted by cell, then the prescribed ones (glued grains,
rows), whose order never changes. Free grains are cut into blocks whose number depends on their
count alone; the prescribed ones are the last block. A block scatters forces inside itself and
leaves those on grains of later blocks in `crossing`, so that every sum has one order, whatever
the number of threads.
"""

from typing import NamedTuple

import numpy as np

Array = np.ndarray

# Columns of LedgerArrays.loss [J/m]
NORMAL_DASHPOT, TANGENTIAL_DASHPOT, SLIDING, ROLLING_DASHPOT, ROLLING_SLIP = 0, 1, 2, 3, 4
GLOBAL_DAMPING, DAMPING_AHEAD, WALL_WORK = 5, 6, 7
LEDGER_COLUMNS = 8


class Grid(NamedTuple):
    """Uniform square cells."""

    x_min: float
    y_min: float
    size: float
    columns: int
    rows: int


class GrainArrays(NamedTuple):
    """State of all grains; n of them, the first `n_free` integrated."""

    x: Array  # (n,) position at the integer step
    y: Array
    theta: Array
    vx: Array  # (n,) velocity at the half step that follows the position
    vy: Array
    omega: Array
    fx: Array  # (n,) contact forces and torque at the integer step
    fy: Array
    torque: Array
    radius: Array
    mass: Array
    inertia: Array
    inverse_mass: Array  # 0 for a prescribed grain
    inverse_inertia: Array
    roll_compliance: Array  # (n,) 1/(I + m r^2), 0 for a prescribed grain
    material: Array  # (n,) row in the table of laws, if there is one
    x_listed: Array  # (n,) position when the contact list was made
    y_listed: Array
    impulse: Array  # (n_prescribed, 3) of force x, y and torque since it was cleared [N s/m, N m s/m]
    block_start: Array  # (n_blocks + 1,) first grain of each block; the last block is prescribed
    period_x: float | None  # after which everything repeats; None: it does not
    period_y: float | None


class PairArrays(NamedTuple):
    """Half list of near pairs, by rows of the lower index, and their history."""

    start: Array  # (n + 1,) first slot of each row
    owner: Array  # (n_slots,) uint32, the row's grain
    partner: Array  # (n_slots,) uint32
    spring: Array  # (n_slots,) tangential spring f [N/m]
    moment: Array  # (n_slots,) rolling spring M on the lower index [N]
    dash_n: Array  # (n_slots,) dashpot forces of the step before, for the ledger
    dash_t: Array
    dash_r: Array
    crossing_start: Array  # (n_blocks + 1,)
    crossing: Array  # (n_crossing, 3) force x, y and torque on the partner
    incoming_grain: Array  # (n_incoming,) grains hit from earlier blocks, ascending
    incoming_start: Array  # (n_incoming + 1,)
    incoming: Array  # (n_crossing,) numbers in `crossing`
    incoming_block: Array  # (n_blocks + 1,) first of `incoming_grain` in each block
    first_source: Array  # (n_blocks,) first block that leaves forces on this one, or itself


class WallArrays(NamedTuple):
    """Half planes with inward unit normals, and the grains near them."""

    px: Array  # (n_walls,) a point of the wall
    py: Array
    nx: Array
    ny: Array
    vx: Array  # (n_walls,) velocity at the half step before the present
    vy: Array
    gain_x: Array  # (n_walls,) what that gains until the present, 0 for a constant velocity
    gain_y: Array
    material: Array
    px_listed: Array  # (n_walls,) the point when the near grains were listed
    py_listed: Array
    force: Array  # (n_blocks, n_walls, 2) force of the grains on the wall
    grain: Array  # (n_near,) uint32
    wall: Array  # (n_near,) uint32
    block: Array  # (n_blocks + 1,) first near pair of each block
    spring: Array  # (n_near,)
    moment: Array  # (n_near,)
    dash_n: Array  # (n_near,)
    dash_t: Array
    dash_r: Array


class ShakingNumbers(NamedTuple):
    """Motion of walls and prescribed grains along a line, a waveform of the time since `start` (`kernels.shaking`)."""

    moves: Array  # (n_walls,) bool
    home_x: Array  # (n_walls,) the point of each wall at no displacement
    home_y: Array
    carried: Array | None  # (n_carried,) places of the prescribed grains that move along; None: there are none
    carried_x: Array  # (n_carried,) where they are at no displacement
    carried_y: Array
    along_x: float  # unit vector of the motion
    along_y: float
    amplitude: float
    period: float
    start: float
    stop: float  # infinite if it does not end
    ramp: float
    from_rest: bool  # 1 - cos, else sin


class FacetArrays(NamedTuple):
    """A moving polyline: nodes, features in chain order, and the grains near them (`kernels.features`).

    A feature is a facet from the node `before` to the node `after`, or the node `at` between the
    nodes `before` and `after` of its facets; -1 stands for none.
    """

    x: Array  # (n_nodes,) position at the integer step
    y: Array
    vx: Array  # (n_nodes,) velocity at the half step that follows the position
    vy: Array
    fx: Array  # (n_nodes,) force of the grains at the integer step
    fy: Array
    impulse: Array  # (n_nodes, 2) of the grains since it was cleared [N s/m]
    work: Array  # (n_nodes,) done on the grains, for the ledger
    x_listed: Array  # (n_nodes,) position when the near grains were listed
    y_listed: Array
    before: Array  # (n_features,) nodes
    at: Array  # (n_features,) -1 for a facet
    after: Array
    previous: Array  # (n_features,) neighbours in the chain
    following: Array
    material: Array  # (1,)
    grain: Array  # (n_near,) uint32, ascending
    feature: Array  # (n_near,) uint32
    block: Array  # (n_blocks + 1,) first near pair of each block
    side: Array  # (n_near,) uint8, where the grain stands along the feature
    side_now: Array
    spring: Array  # (n_near,)
    moment: Array  # (n_near,)
    dash_n: Array  # (n_near,)
    dash_t: Array
    dash_r: Array
    pushes: Array  # (n_near,) bool, whether `push` counts
    push: Array  # (n_near, 3, 2) force of the grain on the nodes before, at and after


class LeadArrays(NamedTuple):
    """What the velocities of all grains gain in the half step that ends at the present."""

    x: Array  # (n,)
    y: Array
    spin: Array


class LedgerArrays(NamedTuple):
    """Accumulated losses and works of every block."""

    loss: Array  # (n_blocks, LEDGER_COLUMNS)
    prescribed_work: Array  # (n_prescribed,) done by each prescribed grain on the others


class GlobalDamping(NamedTuple):
    alpha_t: float
    alpha_r: float
