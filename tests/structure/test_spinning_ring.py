"""A ring that swings while it spins: Bryan's precession, and the frequency at rest."""

import meshes
import numpy as np
import pytest
from moving import quarter, turned
from structure import ElasticStructure, PlaneStrain

PER_PERIOD, PERIODS = 40, 12


@pytest.mark.parametrize("theory", ["corotational", "large_strain"])
def test_pattern_of_a_spinning_ring_lags_as_bryan_found(theory: str, soft: PlaneStrain) -> None:
    """Of n = 2 lobes the pattern falls back by 2/(n^2 + 1) of the ring's own turn (Bryan 1890, thin ring)."""
    ring = meshes.tube(outer_radius=0.05, inner_radius=0.046, around=24, layers=1, order=2)
    omega = 2 * np.pi * ElasticStructure(ring, material=soft, time_step=1.0).frequencies(1)[0]
    spin, dt = 0.03 * omega, 2 * np.pi / omega / PER_PERIOD
    body = ElasticStructure(ring, material=soft, time_step=dt, theory=theory)
    body.release_from_mode(1, 2e-5)
    shape = body.fields().point_data["displacement"]
    body.set_initial(displacement=shape, velocity=spin * quarter(ring.points + shape))
    outer = ring.outer_polyline.points
    normal, lobes = outer / 0.05, np.exp(2j * np.arctan2(outer[:, 1], outer[:, 0]))
    seen = []
    for _ in range(PERIODS * PER_PERIOD):
        own = turned(outer + body.boundary_displacement, -body.mean_rotation()) - outer
        seen.append(np.mean((own * normal).sum(axis=1) * lobes))
        body.advance(np.zeros_like(outer))
    swing = np.array(seen)
    # swing = A cos(omega t) exp(2 i phi): the square, summed over periods, has four times the pattern's angle.
    pattern = np.unwrap(np.angle((swing**2).reshape(PERIODS, PER_PERIOD).sum(axis=1))) / 4
    rate = np.polyfit(np.arange(PERIODS) * PER_PERIOD * dt, pattern, 1)[0]
    # Beside it: (thickness/radius)^2 and (spin/omega)^2, 1 % each at most.
    assert rate == pytest.approx(-0.4 * spin, rel=0.02)
    # (x_{n+1} + x_{n-1})/2 = cos(w dt) x_n, and average acceleration makes tan(w dt/2) of omega dt/2.
    inner = swing[1:-1]
    cosine = np.vdot(inner, swing[2:] + swing[:-2]).real / 2 / np.vdot(inner, inner).real
    # The spin changes it by its square over that of omega, 1e-3, times about one.
    assert np.tan(np.arccos(cosine) / 2) == pytest.approx(omega * dt / 2, rel=3e-3)
