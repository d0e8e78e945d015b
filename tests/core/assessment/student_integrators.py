"""Integrators of free rotation as students write them, and random motions that they are run on."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from core.bodies import PrincipalMoments
from core.rotation.torque_free import TorqueFree

Rows = np.ndarray
Slope = Callable[[Rows], Rows]
Step = Callable[[Slope, Rows, float], Rows]


def gyration(moments: Rows) -> Slope:
    a, b, c = moments
    return lambda w: np.array([(b - c) / a * w[1] * w[2], (c - a) / b * w[2] * w[0], (a - b) / c * w[0] * w[1]])


def euler(f: Slope, w: Rows, h: float) -> Rows:
    return w + h * f(w)


def in_turn(f: Slope, w: Rows, h: float) -> Rows:
    new = w.copy()
    for k in range(3):
        new[k] += h * f(new)[k]
    return new


def explicit_midpoint(f: Slope, w: Rows, h: float) -> Rows:
    return w + h * f(w + h / 2 * f(w))


def heun(f: Slope, w: Rows, h: float) -> Rows:
    k = f(w)
    return w + h / 2 * (k + f(w + h * k))


def runge_kutta(f: Slope, w: Rows, h: float) -> Rows:
    k1 = f(w)
    k2 = f(w + h / 2 * k1)
    k3 = f(w + h / 2 * k2)
    return w + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(w + h * k3))


def midpoint(f: Slope, w: Rows, h: float) -> Rows:
    new = w
    for _ in range(100):
        new = w + h * f((w + new) / 2)
    return new


FIXED: dict[str, tuple[Step, float, float]] = {
    "explicit-euler": (euler, 0.002, 0.02),
    "semi-implicit-euler": (in_turn, 0.002, 0.02),
    "explicit-midpoint": (explicit_midpoint, 0.02, 0.1),
    "heun": (heun, 0.02, 0.1),
    "runge-kutta-4": (runge_kutta, 0.05, 0.2),
    "implicit-midpoint": (midpoint, 0.02, 0.1),
}
"""Integrators by their names here, with the range of steps that they are run with."""
SOLVERS = ("RK45", "DOP853", "LSODA")


def marched(step: Step, f: Slope, w: Rows, h: float, times: Rows) -> Rows:
    """Return the states at times: of the grid, and by one step of the remaining length between its points."""
    rows, n = [], 0
    for t in times:
        while (n + 1) * h <= t * (1 + 1e-12):
            w, n = step(f, w, h), n + 1
        rows.append(w if t - n * h <= 1e-12 * t else step(f, w, t - n * h))
    return np.array(rows)


def motion(chance: Random) -> tuple[Rows, Rows, TorqueFree]:
    a, b = sorted(chance.uniform(1.0, 2.0) for _ in range(2))
    moments = np.array(chance.sample([a, b, chance.uniform(b, a + b)], 3))
    start = np.array([chance.choice([-1, 1]) * chance.uniform(0.5, 2.0) for _ in range(3)])
    return moments, start, TorqueFree(PrincipalMoments(tuple(moments.tolist())).mass_properties(), start)


class Submitted(NamedTuple):
    """Samples that were made by an integrator with a setting: its step, or its relative tolerance."""

    system: TorqueFree
    times: Rows
    rows: Rows
    setting: float


def submitted(kind: str, digits: int | None, seed: int) -> Submitted:
    """Return samples of a random motion: at the ends of all steps, of some, or between them; rounded if wanted."""
    chance = Random(f"{kind} {digits} {seed}")
    moments, start, system = motion(chance)
    f = gyration(moments)
    if kind in FIXED:
        step, low, high = FIXED[kind]
        setting = chance.uniform(low, high)
        setting = float(f"{setting:.1g}") if chance.random() < 0.5 else setting
        spacing = setting * chance.choice([1, 2, 5, 7, chance.uniform(1.3, 6.0)])
        times = np.arange(max(30, int(200 * setting / spacing))) * spacing
        rows = marched(step, f, start, setting, times)
    else:
        times = np.linspace(0.0, chance.uniform(5.0, 20.0), chance.choice([50, 200]))
        setting = 10.0 ** -chance.randint(3, 8)
        atol = chance.choice([1e-6, setting, setting * 1e-3])
        rows = solve_ivp(lambda t, w: f(w), (0, times[-1]), start, kind, times, rtol=setting, atol=atol).y.T
    return Submitted(system, times, rows if digits is None else np.round(rows, digits), setting)
