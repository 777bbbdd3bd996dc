"""A rigid beam bounces on a row of fixed grains: 121 springs and dashpots against the closed form."""

import numpy as np
import pytest
from small_models import on_row, rigid_beam_on_springs
from ways import WAYS, Way, assert_order

MASS, SPRINGS, K_N, C_N, LOAD = 135.0, 121, 1.97e7, 156.24, 1.2e5
STIFFNESS = SPRINGS * K_N
OMEGA = np.sqrt(STIFFNESS / MASS)  # 4202 rad/s
PROMPT = [way for way in WAYS if way.exchange != "lagged"]


def bounce(way: Way, duration: float, window: float, dashpot: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) [s] and displacement (n,) over the static one, after a load put on at once."""
    structure = {
        "kind": "free_rigid",
        "density": 2700.0,
        "beam": {"length": 1.0, "height": 0.05},
        "loads": [{"kind": "boundary", "boundary": "top", "total_force": (0.0, -LOAD)}],
    }
    contact = {"normal_stiffness": K_N, "normal_damping": dashpot}
    model = on_row(way, window=window, structure=structure, contact=contact, rows=[np.linspace(0.0, 1.0, SPRINGS)])
    height = np.zeros(round(duration / window))
    for k in range(len(height)):
        model.advance(1)
        height[k] = model.structure.centroid()[1]
    return window * np.arange(1, len(height) + 1), (0.025 - height) * STIFFNESS / LOAD


def closed_form(time: np.ndarray, dashpot: float) -> np.ndarray:
    """``m z'' + 121 c z' + 121 k z = load`` from rest."""
    decay = SPRINGS * dashpot / (2 * MASS)
    omega = np.sqrt(OMEGA**2 - decay**2)
    return 1 - np.exp(-decay * time) * (np.cos(omega * time) + decay / omega * np.sin(omega * time))


@pytest.mark.parametrize("way", PROMPT, ids=str)
def test_undamped_bounce_converges_with_the_order_of_the_exchange(way: Way) -> None:
    errors = []
    for window in (1e-5, 5e-6):
        time, seen = bounce(way, 4e-3, window)
        errors.append(np.abs(seen - closed_form(time, 0.0)).max())
    assert_order(way, errors)
    assert errors[-1] < 1e-3


@pytest.mark.parametrize("way", PROMPT, ids=str)
def test_period_and_decay_of_the_damped_bounce(way: Way) -> None:
    """The dashpots see the velocity half a step ago: error c dt/2 in inertia, 2e-4 at this step."""
    time, seen = bounce(way, 8e-3, 5e-6, C_N)
    about = seen - 1.0
    down = np.nonzero((about[:-1] < 0) & (about[1:] >= 0))[0]
    crossings = time[down] - about[down] * (time[1] - time[0]) / (about[down + 1] - about[down])
    decay = SPRINGS * C_N / (2 * MASS)
    assert len(crossings) == 6
    assert np.diff(crossings) == pytest.approx(2 * np.pi / np.sqrt(OMEGA**2 - decay**2), rel=5e-4)
    peaks = [about[a:b].max() for a, b in zip(down[:-1], down[1:])]
    assert np.diff(np.log(peaks)) == pytest.approx(-decay * np.diff(crossings)[:-1], rel=5e-3)


@pytest.mark.parametrize("way", [way for way in WAYS if way.exchange == "lagged"], ids=str)
def test_lagged_force_is_a_negative_dashpot_of_k_dt(way: Way) -> None:
    """The source's order: the beam moves as if each dashpot were c - k dt."""
    window = 5e-6
    time, seen = bounce(way, 4e-3, window, C_N)
    assert np.abs(seen - closed_form(time, C_N - K_N * window)).max() < 0.01  # next order: (omega dt)^2 omega t
    assert np.abs(seen - closed_form(time, C_N)).max() > 0.1


def test_eccentric_load_tilts_a_rigid_beam_as_springs_of_equal_length_do() -> None:
    """Statics of a rigid beam: pressures linear in x, sum k and sum k x^2 against force and moment."""
    step, arm, extra = 2e-5, 0.25, 2e4
    load = {"kind": "point", "point": [arm, 0.025], "force": [0.0, -extra], "schedule": {"kind": "ramp", "over": 0.1}}
    built = rigid_beam_on_springs(
        step=step, load=LOAD, ramp_over=0.1, normal_damping=C_N, tangential_damping=24.7, more_loads=[load]
    )
    model = built.model
    model.advance(round(0.3 / step))
    x = np.linspace(-0.5, 0.5, SPRINGS)
    expected = (LOAD + extra) / SPRINGS + extra * arm * x / np.sum(x**2)
    # Turned by 3e-5 rad on springs that lean with the beam's lower face.
    assert model.contact_force[:, 1] == pytest.approx(expected, rel=1e-3)
