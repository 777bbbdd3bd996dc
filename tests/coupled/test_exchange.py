"""Exchange between grains and structure: where it is stable, and that the answer does not depend on it.

A rigid beam on 121 springs is one mass on one spring: r = 121 k H^2 / m, with H the structure's
step. It is pressed down gently, so that it oscillates about a static compression without lift-off.
"""

import numpy as np
import pytest
from independent_beam import IndependentBeam
from small_models import discs_on_free_beam, rigid_beam_on_springs

import structure as fem
from coupled.build import build
from coupled.errors import LeitoError
from coupled.exchange.limit import exchange_limit
from coupled.model import Model
from coupled.scene import load_scene

MASS, STIFFNESS, SPRINGS, LOAD = 135.0, 121 * 1.97e7, 121, 1.2e5


def oscillation(
    ratio: float, windows: int, *, damping_ratio: float = 0.0, substeps: int = 1, exchange: str = "predicted"
) -> np.ndarray:
    """Distance (windows,) from the static compression, over it; loaded over the first 100 windows."""
    window = np.sqrt(ratio * MASS / STIFFNESS)
    model = rigid_beam_on_springs(
        step=window / substeps,
        load=LOAD,
        ramp_over=100.5 * window,
        normal_damping=2 * damping_ratio * np.sqrt(STIFFNESS * MASS) / SPRINGS,
        interface={"substeps": substeps, "exchange": exchange},
    ).model
    height = np.zeros(windows)
    for k in range(windows):
        model.advance(1)
        height[k] = model.structure.centroid()[1]
    return (height - 0.025) * STIFFNESS / LOAD + 1.0


@pytest.mark.parametrize("damping_ratio", [0.0, 0.05, 0.3])
def test_predicted_exchange_is_stable_up_to_its_limit_and_not_beyond(damping_ratio: float) -> None:
    """One mode alternates in sign at the limit ``r + 2 c H/m = 2``; c H/m = 2 zeta sqrt(r)."""
    root = np.sqrt(4 * damping_ratio**2 + 2) - 2 * damping_ratio  # sqrt(r) at the limit
    below = oscillation(0.96 * root**2, 1500, damping_ratio=damping_ratio)
    assert np.abs(below[-100:]).max() < 1e-9
    above = oscillation(1.04 * root**2, 1500, damping_ratio=damping_ratio)
    assert np.abs(above[-100:]).max() > 1e-2  # it grows until springs open


@pytest.mark.parametrize("dashpot", [0.0, 156.24])
def test_elastic_beam_is_stable_up_to_the_limit_of_its_consistent_mass(dashpot: float) -> None:
    """``omega^2 H^2 (1 + 2 c/(k H)) = 2``, with omega the fastest of the bare mass on its springs.

    The beam's own stiffness, however large, does not move the limit: in the mode that alternates
    in sign at each step displacement and velocity vanish at the limit. Consistent mass makes that
    mode lighter than lumped nodes by the factor 2.2 here.
    """
    own = IndependentBeam(length=1.0, height=0.05, along=40, across=2, young=70e9, poisson=0.35)
    fastest = own.fastest_on_springs(np.linspace(0.0, 1.0, SPRINGS), 1.97e7, 2700.0)
    lag = 2 * dashpot / 1.97e7
    limit = (np.sqrt(lag**2 + 8 / fastest) - lag) / 2
    unevenness = []
    for share in (0.97, 1.03):
        model = elastic_beam(
            f"time.step={float(share * limit)!r}",
            "structure.loads.0.schedule.over=0.02",
            "structure.rayleigh.stiffness_factor=0.0",
            f"contact.normal_damping={dashpot}",
            "interface.largest_stiffness_ratio=10.0",
        )
        model.advance(1500)
        unevenness.append(np.ptp(model.contact_force[:, 1]))
    # At rest the forces range over 46 N of 1000 N; beyond the limit springs open.
    assert unevenness[0] < 60.0 and unevenness[1] > 1000.0


@pytest.mark.parametrize("substeps", [1, 2, 5, 20])
@pytest.mark.parametrize("ratio", [0.03, 0.3, 1.0])
def test_predicted_exchange_feeds_no_energy_without_any_damping(ratio: float, substeps: int) -> None:
    seen = np.abs(oscillation(ratio, 500, substeps=substeps))
    assert seen[-100:].max() <= seen[150:250].max()


@pytest.mark.parametrize("ratio", [0.01, 0.02])
def test_lagged_exchange_grows_by_half_the_stiffness_ratio_each_step(ratio: float) -> None:
    seen = np.abs(oscillation(ratio, 400, exchange="lagged"))
    inside = np.arange(110, 399)
    peaks = [k for k in inside if seen[k - 1] <= seen[k] >= seen[k + 1] and seen[k] < 0.9]
    growth = np.polyfit(peaks, np.log(seen[peaks]), 1)[0]
    assert len(peaks) > 5
    assert growth == pytest.approx(ratio / 2, rel=0.05)  # peaks are read on the grid of steps


def test_printed_ratio_is_that_of_the_independent_beam() -> None:
    """``r = H^2 (k + 2 c/H) lambda``: 2 at the limit that the runs above find."""
    own = IndependentBeam(length=1.0, height=0.05, along=40, across=2, young=70e9, poisson=0.35)
    fastest = own.fastest_on_springs(np.linspace(0.0, 1.0, SPRINGS), 1.97e7, 2700.0)
    expected = 2e-5**2 * fastest * (1.0 + 2.0 * 156.24 / (1.97e7 * 2e-5))
    built = build(load_scene("winkler_beam"))
    assert built.stiffness_ratio == pytest.approx(expected, rel=1e-3)  # the power iteration's tolerance


def test_step_beyond_the_stable_ratio_is_refused() -> None:
    with pytest.raises(LeitoError, match=r"stiffness ratio r = 8\.99 .* above 2, .* time\.step at most"):
        build(load_scene("winkler_beam", ["time.step=2e-4"]))
    build(load_scene("winkler_beam", ["time.step=2e-4", "interface.largest_stiffness_ratio=10.0"]))


def elastic_beam(*options: str) -> Model:
    return build(load_scene("winkler_beam", ["structure.loads.0.schedule.over=0.2", *options])).model


def test_substeps_do_not_change_the_answer_at_rest() -> None:
    forces = []
    for substeps in (1, 2, 5):
        model = elastic_beam(f"interface.substeps={substeps}", "interface.largest_stiffness_ratio=3.0")
        model.advance(round(0.45 / model.window))
        forces.append(model.contact_force)
    # The bounce has decayed by exp(-70 * 0.25) = 3e-8.
    for force in forces[1:]:
        assert np.abs(force - forces[0]).max() < 1e-7 * np.abs(forces[0]).max()


def test_lagged_and_predicted_exchange_agree_at_small_steps() -> None:
    """Their difference is k dt beside the dashpot c, so it falls with dt."""
    gaps = []
    for step in (4e-6, 2e-6, 1e-6):
        reactions = []
        for exchange in ("predicted", "lagged"):
            model = elastic_beam(f"time.step={step!r}", f"interface.exchange={exchange}")
            seen = []
            for _ in range(20):
                model.advance(round(1e-4 / step))
                seen.append(model.reaction[1])
            reactions.append(np.array(seen))
        gaps.append(np.abs(reactions[1] - reactions[0]).max() / reactions[0].max())
    assert gaps[-1] < 0.02
    assert gaps[0] > 1.8 * gaps[1] > 1.8**2 * gaps[2]


def test_a_structure_that_starts_in_contact_starts_accelerated() -> None:
    """One disc that overlaps the beam by 10 um at t = 0 pushes it down at once, with F = k delta."""
    radius = discs_on_free_beam([[0.0, 0.5, 0.0, 0.0, 0.0]], step=1e-6).model.interface.radius
    built = discs_on_free_beam([[0.0, 0.01 + radius - 1e-5, 0.0, 0.0, 0.0]], step=1e-6)
    assert built.model.reaction[1] == pytest.approx(-1e6 * 1e-5, rel=1e-9)
    built.model.advance(1)
    # after one step the beam has the momentum of that force, but for what the overlap lost within it
    assert built.model.structure.momentum()[1] == pytest.approx(-1e6 * 1e-5 * 1e-6, rel=1e-3)


def test_two_discs_cannot_share_a_centre() -> None:
    with pytest.raises(ValueError, match="grains 0 and 1 have the same centre"):
        discs_on_free_beam([[0.0, 0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0, 0.0]], step=1e-6)


def test_limit_of_a_dissipative_scheme_is_safe_and_that_of_newmark_is_not() -> None:
    """A soft beam without any damping, whose modes lie where generalised alpha lags behind the predicted places."""
    limit = exchange_limit(fem.GeneralizedAlpha(spectral_radius=0.9))
    assert 0.5 < limit < 1.0
    soft = ("structure.youngs_modulus=7e8", "structure.rayleigh.stiffness_factor=0.0", "contact.normal_damping=0.0")
    at_1e_5 = build(load_scene("winkler_beam", ["time.step=1e-5", *soft])).stiffness_ratio
    unevenness = []
    for ratio in (0.95 * limit, 1.9):
        model = elastic_beam(
            f"time.step={float(1e-5 * np.sqrt(ratio / at_1e_5))!r}",
            "structure.generalised_alpha={spectral_radius=0.9}",
            "structure.loads.0.schedule.over=0.02",
            "interface.largest_stiffness_ratio=10.0",
            *soft,
        )
        model.advance(1500)
        unevenness.append(np.ptp(model.contact_force[:, 1]))
    # At rest the forces range over 103 N of 1000 N; beyond the limit springs open.
    assert unevenness[0] < 150.0 and unevenness[1] > 1000.0


@pytest.mark.parametrize("substeps", [1, 3])
def test_iterated_exchange_has_no_limit_where_a_dissipative_scheme_has_one(substeps: int) -> None:
    """The same beam at the ratio where the predicted exchange opens springs."""
    soft = ("structure.youngs_modulus=7e8", "structure.rayleigh.stiffness_factor=0.0", "contact.normal_damping=0.0")
    at_1e_5 = build(load_scene("winkler_beam", ["time.step=1e-5", *soft])).stiffness_ratio
    model = elastic_beam(
        f"time.step={float(1e-5 * np.sqrt(1.9 / at_1e_5)) / substeps!r}",
        f"interface.substeps={substeps}",
        "interface.exchange=iterated",
        "structure.generalised_alpha={spectral_radius=0.9}",
        "structure.loads.0.schedule.over=0.02",
        *soft,
    )
    model.advance(1500)
    # At rest the forces range over 103 N of 1000 N.
    assert np.ptp(model.contact_force[:, 1]) < 150.0


def test_limit_of_schemes_that_conserve_is_two_and_half_of_it_with_substeps() -> None:
    for scheme in (fem.Newmark(), fem.GeneralizedAlpha(spectral_radius=1.0)):
        assert (exchange_limit(scheme), exchange_limit(scheme, 5)) == (2.0, 1.0)
