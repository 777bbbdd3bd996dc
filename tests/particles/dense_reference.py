"""Discs in plain numpy, every pair at every step: what the fast search must reproduce.

Written from model 1.1 to 1.4 on dense (n, n) arrays, without lists, cells, blocks or half
matrices: entry (i, j) is the force on i from j, and both entries are computed.
"""

from dataclasses import dataclass

import numpy as np


@dataclass
class Dense:
    """State (n, 2) and (n,), springs (n, n + walls); the first `n_free` discs move by their forces."""

    n_free: int
    x: np.ndarray
    v: np.ndarray
    omega: np.ndarray
    radius: np.ndarray
    mass: np.ndarray
    walls: list[tuple[np.ndarray, np.ndarray]]  # a point and the normal towards the discs
    law: dict[str, float]
    gravity: np.ndarray
    body: np.ndarray
    period: tuple[float | None, float | None] = (None, None)

    def __post_init__(self) -> None:
        shape = (len(self.x), len(self.x) + len(self.walls))
        self.spring, self.moment = np.zeros(shape), np.zeros(shape)

    def kinematics(self) -> dict[str, np.ndarray]:
        """Overlap, normal, velocities and arms of every disc with every disc and wall."""
        x, v, r, w = self.x, self.v, self.radius, self.omega
        n = len(x)
        apart = x[None] - x[:, None]
        for axis, length in enumerate(self.period):
            if length is not None:
                apart[..., axis] -= length * np.rint(apart[..., axis] / length)
        distance = np.hypot(apart[..., 0], apart[..., 1]) + np.eye(n)
        delta = r[:, None] + r[None] - distance
        same_body = (self.body[:, None] == self.body[None]) & (self.body[:, None] >= 0)
        delta[np.eye(n, dtype=bool) | same_body] = -1.0
        normal = apart / distance[..., None]
        relative = v[None] - v[:, None]
        arm_i, arm_j = r[:, None] - 0.5 * delta, r[None] - 0.5 * delta
        turning = arm_i * w[:, None] + arm_j * w[None]
        rolling = w[:, None] - w[None]
        reduced = r[:, None] * r[None] / (r[:, None] + r[None])
        parts = [(delta, normal, relative, arm_i, turning, rolling, reduced)]
        for point, inward in self.walls:
            depth = r - (x - point) @ inward
            depth[self.n_free :] = -1.0
            arm = r - 0.5 * depth
            column = (depth, np.broadcast_to(-inward, x.shape), -v, arm, arm * w, w, r)
            parts.append(tuple(part[:, None] for part in column))
        names = ("delta", "normal", "relative", "arm", "turning", "rolling", "reduced")
        return {name: np.concatenate([p[k] for p in parts], axis=1) for k, name in enumerate(names)}

    def rolling_inertia(self) -> np.ndarray:
        """I_r of every disc with every disc and wall; infinite mass for prescribed discs and walls."""
        one = np.zeros(len(self.x))
        free = slice(self.n_free)
        one[free] = 1.0 / (1.5 * self.mass[free] * self.radius[free] ** 2)
        pairs = one[:, None] + one[None]
        total = np.concatenate([pairs, np.repeat(one[:, None], len(self.walls), axis=1)], axis=1)
        return np.divide(1.0, total, out=np.zeros_like(total), where=total > 0.0)

    def forces(self, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Force (n, 2) and torque (n,) on every disc; springs stretch over `dt`."""
        k, law = self.kinematics(), self.law
        touch = k["delta"] > 0.0
        tangent = np.stack([-k["normal"][..., 1], k["normal"][..., 0]], axis=-1)
        v_n = (k["relative"] * k["normal"]).sum(-1)
        v_t = (k["relative"] * tangent).sum(-1) - k["turning"]
        f_n = np.maximum(law["k_n"] * k["delta"] - law["c_n"] * v_n, 0.0)
        born = touch & (k["delta"] + v_n * dt < 0.0)  # touched within this step, delta / -v_n ago
        held = np.where(born, k["delta"] / np.where(born, -v_n, 1.0), dt)
        limit = law["mu"] * f_n
        trial = self.spring + law["k_t"] * v_t * held
        self.spring = np.clip(trial, -limit, limit) * touch
        f_t = np.where(abs(trial) > limit, self.spring, np.clip(self.spring + law["c_t"] * v_t, -limit, limit))
        k_r = law["k_t"] * k["reduced"] ** 2
        c_r = 2.0 * law["eta_r"] * np.sqrt(self.rolling_inertia() * k_r)
        limit = law["mu_r"] * k["reduced"] * f_n
        trial = self.moment - k_r * k["rolling"] * held
        self.moment = np.clip(trial, -limit, limit) * touch
        moment = np.where(abs(trial) > limit, self.moment, np.clip(self.moment - c_r * k["rolling"], -limit, limit))
        on_i = f_t[..., None] * tangent - f_n[..., None] * k["normal"]
        force = (on_i * touch[..., None]).sum(axis=1)
        return force, ((k["arm"] * f_t + moment) * touch).sum(axis=1)

    def kick(self, dt: float, force: np.ndarray, torque: np.ndarray) -> None:
        """Velocities of the free discs over `dt`."""
        free = slice(self.n_free)
        mass, radius = self.mass[free], self.radius[free]
        self.v[free] += dt * (force[free] / mass[:, None] + self.gravity)
        self.omega[free] += dt * torque[free] / (0.5 * mass * radius**2)

    def run(self, steps: int, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Half a kick, then `steps` leapfrog steps; the last forces and torques."""
        force, torque = self.forces(0.0)
        self.kick(0.5 * dt, force, torque)
        for _ in range(steps):
            self.x += dt * self.v
            force, torque = self.forces(dt)
            self.kick(dt, force, torque)
        return force, torque
