"""One impact of two discs, or of a disc and a plane, solved in continuous time, independent of the code under test.

The contact law is that of model 1.2 written as differential equations: overlap, angle of the
normal, their rates, both spins and the tangential spring, integrated by DOP853 from event to event
(stick and slip, the dashpot's cap, the deepest point, zero force, separation).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import gamma

Floats = NDArray[np.float64]
Mode = Literal["stick", "capped", "slip"]
RTOL, ATOL = 1e-11, 1e-14  # the latter in units of the scales of one impact
# Contact time of Hertz's spring over deepest overlap times speed, 2 int_0^1 (1 - x^(5/2))^(-1/2) dx = 2.943.
HERTZ_TIME = 0.8 * math.sqrt(math.pi) * gamma(0.4) / gamma(0.9)


@dataclass(frozen=True, kw_only=True)
class Body:
    """A disc: radius [m], mass [kg] and moment of inertia ``m r^2/2``."""

    radius: float
    mass: float

    @property
    def inertia(self) -> float:
        return 0.5 * self.mass * self.radius**2


@dataclass(frozen=True, kw_only=True)
class Springs:
    """Contact law: spring ``k delta^p``, p = 1 (linear) or 3/2 (Hertz), tangential stiffness ``ratio`` times its slope.

    ``zeta``: normal dashpot over the one that is critical at every overlap; ``c_t``: tangential dashpot
    [N s/m], of one value. Friction is for contacts that may not pull.
    """

    k: float
    power: float
    zeta: float = 0.0
    ratio: float = 1.0
    mu: float = 0.0
    c_t: float = 0.0
    may_pull: bool = False

    def deepest(self, mass: float, speed: float) -> float:
        """Overlap [m] at which the undamped spring holds the energy of the impact."""
        return float((0.5 * (self.power + 1.0) * mass * speed**2 / self.k) ** (1.0 / (self.power + 1.0)))

    def duration(self, mass: float, speed: float) -> float:
        """Time of an undamped contact [s]."""
        return (math.pi if self.power == 1.0 else HERTZ_TIME) * self.deepest(mass, speed) / speed


class Rebound(NamedTuple):
    """Velocities along n and t as they were at touching, spins, contact time, deepest overlap, modes of friction."""

    v_n: float
    u_t: float
    spins: tuple[float, float]
    duration: float
    overlap: float
    modes: tuple[Mode, ...]

    def numbers(self) -> Floats:
        return np.array([self.v_n, self.u_t, *self.spins])


class Look(NamedTuple):
    delta: float
    v_n: float
    u_t: float
    v_t: float
    arms: tuple[float, float]
    turning: float  # rate of the normal's angle
    f_n: float
    limit: float  # Coulomb's
    limit_rate: float
    k_t: float
    softening: float  # rate at which k_t falls, over k_t
    c_t: float


Event = Callable[[Look, Floats], float]


@dataclass(frozen=True, kw_only=True)
class Impact:
    """`first` meets `second`, or a plane if that is None, at normal speed `v_n` < 0 and tangential velocity `u_t`.

    Velocities [m/s] are those of the second body against the first along n (towards it) and t (n turned to the
    left), `spins` [rad/s] counter-clockwise. The surfaces turn with the lever arms ``r - delta/2``.
    """

    first: Body
    second: Body | None
    springs: Springs
    v_n: float
    u_t: float = 0.0
    spins: tuple[float, float] = (0.0, 0.0)

    @property
    def mass(self) -> float:
        """Effective mass [kg]."""
        return 1.0 / (1.0 / self.first.mass + (0.0 if self.second is None else 1.0 / self.second.mass))

    @property
    def inverse_inertia(self) -> tuple[float, float]:
        return 1.0 / self.first.inertia, 0.0 if self.second is None else 1.0 / self.second.inertia

    def at(self, y: Floats) -> Look:
        """Kinematics and normal force of a state; the normal turns with ``u_t / d``."""
        law, (delta, _, v_n, u_t, w_1, w_2, _) = self.springs, y
        delta = max(delta, 0.0)
        arm_1, arm_2, turning = self.first.radius - 0.5 * delta, 0.0, 0.0
        if self.second is not None:
            arm_2 = self.second.radius - 0.5 * delta
            turning = u_t / (arm_1 + arm_2)
        slope = law.k * law.power * delta ** (law.power - 1.0)
        # constant damping ratio: c = 2 zeta sqrt(m S' (p+1)/(2p)), of degree (p-1)/2 in delta
        c = 2.0 * law.zeta * math.sqrt(0.5 * (law.power + 1.0) / law.power * self.mass * slope)
        f_n = law.k * delta**law.power - c * v_n
        c_slope = 0.5 * (law.power - 1.0) * c / delta if delta > 0.0 else 0.0
        rate = -(slope - c_slope * v_n) * v_n - c * (f_n / self.mass + u_t * turning)
        v_t = u_t - arm_1 * w_1 - arm_2 * w_2
        softening = (law.power - 1.0) * v_n / delta if delta > 0.0 else 0.0
        return Look(
            delta, v_n, u_t, v_t, (arm_1, arm_2), turning, f_n, law.mu * abs(f_n),
            law.mu * math.copysign(1.0, f_n) * rate, law.ratio * slope, softening, law.c_t,
        )  # fmt: skip

    def rate(self, y: Floats, phase: "Phase") -> list[float]:
        look = self.at(y)
        f_t = phase.force(look, y)
        spring_rate = 0.0 if phase.mode == "slip" else look.v_t if phase.opening else look.k_t * look.v_t
        (i_1, i_2), (a_1, a_2) = self.inverse_inertia, look.arms
        return [
            -look.v_n,
            look.turning,
            look.f_n / self.mass + look.u_t * look.turning,
            -f_t / self.mass - look.v_n * look.turning,
            a_1 * f_t * i_1,
            a_2 * f_t * i_2,
            spring_rate,
        ]

    def solve(self) -> Rebound:
        """Integrate from touching to the end of the contact."""
        law, speed = self.springs, abs(self.v_n)
        deep = law.deepest(self.mass, speed)
        quick = speed + abs(self.look_at_start().v_t)
        scales = [
            deep,
            1.0,
            speed,
            quick,
            quick / self.first.radius,
            quick / self.first.radius,
            law.k * deep**law.power,
        ]
        y = np.array([0.0, 0.0, self.v_n, self.u_t, *self.spins, 0.0])
        phase, t, modes, overlap = self.first_phase(), 0.0, [], 0.0
        while True:
            modes.append(phase.mode)
            assert len(modes) < 30, "a tangential dashpot lets this contact chatter between stick and slip"
            events = phase.events(self)
            # a damped contact without tension takes several times the undamped time
            run = solve_ivp(
                lambda _, y, phase=phase: self.rate(y, phase), (t, 100.0 * law.duration(self.mass, speed)), y, "DOP853",
                events=[terminal(self, *event) for event in events.values()], rtol=RTOL, atol=ATOL * np.array(scales),
            )  # fmt: skip
            assert run.status == 1, run.message
            t, y = float(run.t[-1]), run.y[:, -1].copy()
            name = next(n for n, times in zip(events, run.t_events, strict=True) if len(times))
            if name == "turn":
                overlap = float(y[0])
            if name == "end" or (phase.opening and y[0] < 1e-9 * deep):  # an event on the very last stretch
                break
            phase, y[6] = phase.after(name, self, y)
        return self.rebound(y, t, overlap, tuple(modes))

    def look_at_start(self) -> Look:
        return self.at(np.array([0.0, 0.0, self.v_n, self.u_t, *self.spins, 0.0]))

    def first_phase(self) -> "Phase":
        """At touching: the rates of spring and limit decide without a dashpot, the limit itself with one."""
        law, look = self.springs, self.look_at_start()
        side = math.copysign(1.0, look.v_t)
        if law.mu == 0.0 or law.zeta == 0.0 and law.ratio * abs(look.v_t) > law.mu * abs(look.v_n):
            return Phase("slip", side, False)
        capped = law.c_t * abs(look.v_t) > law.mu * abs(look.f_n)
        return Phase("capped" if capped else "stick", side, False)

    def rebound(self, y: Floats, t: float, overlap: float, modes: tuple[Mode, ...]) -> Rebound:
        _, angle, v_n, u_t, w_1, w_2, _ = (float(v) for v in y)
        cos, sin = math.cos(angle), math.sin(angle)
        return Rebound(v_n * cos - u_t * sin, v_n * sin + u_t * cos, (w_1, w_2), t, overlap, modes)


class Phase(NamedTuple):
    """What holds between two events: the mode of friction, its direction, whether the contact opens.

    The spring's state is its force while k_t grows; while it falls the stretch ``f / k_t``, which then
    follows v_t alone.
    """

    mode: Mode
    side: float
    opening: bool

    def spring(self, look: Look, y: Floats) -> float:
        return float(y[6] * look.k_t) if self.opening else float(y[6])

    def force(self, look: Look, y: Floats) -> float:
        """F_t for a law with the given mode."""
        if self.mode == "stick":
            return self.spring(look, y) + look.c_t * look.v_t
        return self.side * look.limit

    def slip_excess(self, look: Look, y: Floats) -> float:
        """How much faster the spring of a slider would grow than its limit, if it were held: < 0 ends the slip."""
        held = self.side * look.k_t * look.v_t
        if self.opening and look.delta > 0.0:  # k_t falls, and the force with it
            held -= look.limit * look.softening
        return held - look.limit_rate

    def events(self, impact: Impact) -> dict[str, tuple[Event, float]]:
        """Functions of look and state, and the direction in which each ends the phase."""
        law = impact.springs
        closed = law.may_pull or law.zeta == 0.0
        found: dict[str, tuple[Event, float]] = {
            "end": ((lambda look, y: y[0]) if closed else (lambda look, y: look.f_n), -1.0)
        }
        if not self.opening:
            found["turn"] = (lambda look, y: look.v_n, 1.0)
        if law.mu == 0.0:
            return found
        if self.mode == "slip":
            return found | {"hold": (self.slip_excess, -1.0)}
        # a slider that is held starts at the limit itself: the slack keeps round-off from making it slip again at once
        found["slip"] = (lambda look, y: abs(self.spring(look, y)) - look.limit * (1.0 + RTOL), 1.0)
        if law.c_t > 0.0:
            total: Event = lambda look, y: abs(self.spring(look, y) + look.c_t * look.v_t) - look.limit
            found["cap" if self.mode == "stick" else "free"] = (total, 1.0 if self.mode == "stick" else -1.0)
        return found

    def after(self, event: str, impact: Impact, y: Floats) -> tuple["Phase", float]:
        """The next phase and its spring state."""
        look = impact.at(y)
        force = self.side * look.limit if self.mode == "slip" else self.spring(look, y)
        mode, side, opening = self.mode, self.side, self.opening or event == "turn"
        if event == "slip":
            mode, side = "slip", math.copysign(1.0, force)
        elif event == "cap":
            mode, side = "capped", math.copysign(1.0, force + look.c_t * look.v_t)
        elif event == "free":
            mode = "stick"
        elif mode == "slip" and Phase(mode, side, opening).slip_excess(look, y) <= 0.0 or event == "hold":
            mode = "capped" if side * look.c_t * look.v_t > 0.0 else "stick"
        return Phase(mode, side, opening), force / look.k_t if opening else force


def terminal(impact: Impact, event: Event, direction: float) -> Callable[[float, Floats], float]:
    def value(_: float, y: Floats) -> float:
        return float(event(impact.at(y), y))

    value.terminal, value.direction = True, direction
    return value


@cache
def damping_ratio(restitution: float, *, may_pull: bool) -> float:
    """Dashpot over critical one of x'' = -x - 2 zeta x' that rebounds with `restitution`, by shooting."""
    if restitution == 1.0:
        return 0.0

    def miss(zeta: float) -> float:
        springs = Springs(k=1.0, power=1.0, zeta=zeta, may_pull=may_pull)
        unit = Body(radius=1e9, mass=1.0)
        return Impact(first=unit, second=None, springs=springs, v_n=-1.0).solve().v_n - restitution

    return float(brentq(miss, 1e-9, 0.999 if may_pull else 10.0, xtol=1e-13))
