"""Small systems to integrate, none of them from core, each with what is known about it independently."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ellipj

from core.arrays import Floats
from core.compiled import kernel
from core.systems.question import MotionQuestion
from core.systems.state_motion import state_motion
from core.systems.system import DISCRETE_STEP, PART_FLOW, VECTOR_FIELD, ClosedForm, Model, Range, Splitting, Structure
from core.systems.trajectory import Trajectory

MODEL = Model("test system", "regular", "the test asks for it", 1)


@dataclass(frozen=True, eq=False)
class Exact:
    """A closed form given as a function of time."""

    solution: Callable[[Floats], Floats]
    bound: float = 1e-15
    period: float | None = None
    model: Model = MODEL
    over: tuple[float, float] = (-60.0, 60.0)

    @cached_property
    def largest_norm(self) -> float:
        """Over a span of time that has whole periods, or all in which the motion is not at rest."""
        times = np.linspace(*self.over, 120_001)
        with np.errstate(all="ignore"):
            return float(np.nanmax(np.linalg.norm(self.solution(times), axis=1)))

    def sample(self, times: Floats) -> Floats:
        return np.ascontiguousarray(self.solution(times))

    def error(self, times: Floats) -> float:
        return self.bound

    def inherited(self, times: Floats, uncertainty: float) -> float:
        return uncertainty * (1 + float(np.abs(times).max()))


@dataclass(frozen=True, eq=False)
class Given:
    """A system put together from parts."""

    equation: Any
    initial_state: Floats
    parameters: Floats = field(default_factory=lambda: np.zeros(1))
    exact: ClosedForm | None = None
    conserved: Callable[[Floats], Mapping[str, Floats]] = field(default=lambda states: {})
    structure: Structure = field(default_factory=Structure)
    model: Model = MODEL
    state_column: tuple[str, str] = ("state", "1")

    def closed_form(self) -> ClosedForm | None:
        return self.exact

    def trajectory(self, question: MotionQuestion) -> Trajectory:
        return state_motion(self, question)

    def invariants(self, states: Floats) -> Mapping[str, Floats]:
        return self.conserved(states)

    def ranges(self, states: Floats) -> Mapping[str, Range]:
        first = self.invariants(self.initial_state[None, :])
        return {
            name: Range(float(first[name][0]), float(values.min()), float(values.max()))
            for name, values in self.invariants(states).items()
        }


@kernel(VECTOR_FIELD)
def _oscillator(time, state, parameters, slope):
    slope[0] = state[1]
    slope[1] = -parameters[0] * parameters[0] * state[0]


@kernel(PART_FLOW)
def _oscillator_parts(part, duration, state, parameters):
    if part == 0:
        state[0] += duration * state[1]
    else:
        state[1] -= duration * parameters[0] * parameters[0] * state[0]


@kernel(DISCRETE_STEP)
def _oscillator_step(duration, state, parameters, increment):
    """Stormer's and Verlet's: the discrete Lagrangian of the trapezoidal rule."""
    force = parameters[0] * parameters[0]
    middle = state[1] - duration / 2 * force * state[0]
    increment[0] = duration * middle
    increment[1] = -duration / 2 * force * (2 * state[0] + increment[0])
    return True


def oscillator(rate: float = 1.0, position: float = 1.0, velocity: float = 0.0, exact: bool = True) -> Given:
    """x'' = -rate^2 x."""

    def solution(times: Floats) -> Floats:
        c, s = np.cos(rate * times), np.sin(rate * times)
        return np.column_stack((position * c + velocity / rate * s, velocity * c - position * rate * s))

    return Given(
        _oscillator,
        np.array([position, velocity]),
        np.array([rate]),
        Exact(solution, period=2 * np.pi / rate) if exact else None,
        lambda y: {"energy": y[:, 1] ** 2 / 2 + rate**2 * y[:, 0] ** 2 / 2},
        Structure(splitting=Splitting(2, _oscillator_parts), discrete=_oscillator_step),
    )


@kernel(VECTOR_FIELD)
def _euler(time, w, inertia, slope):
    slope[0] = (inertia[1] - inertia[2]) / inertia[0] * w[1] * w[2]
    slope[1] = (inertia[2] - inertia[0]) / inertia[1] * w[2] * w[0]
    slope[2] = (inertia[0] - inertia[1]) / inertia[2] * w[0] * w[1]


@kernel(PART_FLOW)
def _axis_rotations(part, duration, w, inertia):
    """With kinetic energy about one axis alone, the angular momentum turns about it at the rate w of that axis."""
    i, j, k = part, (part + 1) % 3, (part + 2) % 3
    angle = w[i] * duration
    c, s = np.cos(angle), np.sin(angle)
    momentum_j, momentum_k = inertia[j] * w[j], inertia[k] * w[k]
    w[j] = (c * momentum_j + s * momentum_k) / inertia[j]
    w[k] = (c * momentum_k - s * momentum_j) / inertia[k]


@kernel(DISCRETE_STEP)
def _moser_veselov(duration, w, inertia, increment):
    """By simple iteration of I e = (h M/2 - e x I e)/r, where core uses Newton's method."""
    e, turned = 0.5 * duration * w, np.empty(3)
    half = inertia * e
    for _ in range(200):
        momentum = inertia * e
        turned[0] = e[1] * momentum[2] - e[2] * momentum[1]
        turned[1] = e[2] * momentum[0] - e[0] * momentum[2]
        turned[2] = e[0] * momentum[1] - e[1] * momentum[0]
        square = 1.0 - (e * e).sum()
        if not square > 0.0:
            return False
        e = (half - turned) / inertia / np.sqrt(square)
    increment[:] = -4.0 / duration * turned / inertia
    return True


def rigid_body(moments: tuple[float, float, float], rates: tuple[float, float, float]) -> Given:
    """Euler's equations, without a closed form."""
    inertia = np.array(moments, dtype=float)
    return Given(
        _euler,
        np.array(rates, dtype=float),
        inertia,
        None,
        lambda w: {"energy": (w**2 @ inertia) / 2, "momentum": np.sqrt((w * inertia) ** 2 @ np.ones(3))},
        Structure(splitting=Splitting(3, _axis_rotations), discrete=_moser_veselov, degree=2),
    )


def rigid_body_with_solution() -> Given:
    """Moments (1, 2, 3), start (1, 0, 1): amplitudes and rate are 1, the motion is (cn, sn, dn) with m = 1/3."""

    def solution(times: Floats) -> Floats:
        sn, cn, dn, _ = ellipj(times, 1 / 3)
        return np.column_stack((cn, sn, dn))

    return replace(rigid_body((1, 2, 3), (1, 0, 1)), exact=Exact(solution, bound=5e-14))


@kernel(VECTOR_FIELD)
def _elliptic(time, y, parameters, slope):
    slope[0] = y[1] * y[2]
    slope[1] = -y[0] * y[2]
    slope[2] = -parameters[0] * y[0] * y[1]


@kernel(PART_FLOW)
def _elliptic_parts(part, duration, y, parameters):
    """In the first part y1 and y2 turn at the rate y3, which rests; in the second y3 moves evenly while they rest."""
    if part == 0:
        angle = y[2] * duration
        c, s = np.cos(angle), np.sin(angle)
        y[0], y[1] = c * y[0] + s * y[1], c * y[1] - s * y[0]
    else:
        y[2] -= parameters[0] * y[0] * y[1] * duration


_MOMENTS = np.array([2 / 3, 1.0, 0.4])
_MOMENTA = np.sqrt(np.array([0.51 / (1.0 * 0.5), 0.51 / (1.5 * 0.5), 1 / (1.5 * 1.0)]))
"""The same problem as a rigid body: with these moments, angular momenta are these times y."""


@kernel(DISCRETE_STEP)
def _elliptic_step(duration, y, parameters, increment):
    scale = _MOMENTA / _MOMENTS
    solved = _moser_veselov(duration, scale * y, _MOMENTS.copy(), increment)
    increment[:] = increment / scale
    return solved


def elliptic_functions(exact: bool = True) -> Given:
    """Problem B5 of DETEST: (sn, cn, dn) of parameter 0.51 is its solution.

    T. E. Hull, W. H. Enright, B. M. Fellen, A. E. Sedgwick, "Comparing numerical methods for ordinary differential
    equations", SIAM Journal on Numerical Analysis 9 (1972) 603.
    """

    def solution(times: Floats) -> Floats:
        return np.column_stack(ellipj(times, 0.51)[:3])

    return Given(
        _elliptic,
        np.array([0.0, 1.0, 1.0]),
        np.array([0.51]),
        Exact(solution, bound=4e-15) if exact else None,
        lambda y: {"circle": y[:, 0] ** 2 + y[:, 1] ** 2, "ellipse": 0.51 * y[:, 0] ** 2 + y[:, 2] ** 2},
        Structure(splitting=Splitting(2, _elliptic_parts), discrete=_elliptic_step, degree=2),
    )


@kernel(VECTOR_FIELD)
def _prey_and_predator(time, y, parameters, slope):
    slope[0] = y[0] * (1 - y[1])
    slope[1] = y[1] * (y[0] - 1)


def prey_and_predator() -> Given:
    """Lotka and Volterra's equations: nonlinear, periodic, no closed form."""
    return Given(
        _prey_and_predator,
        np.array([2.0, 0.5]),
        conserved=lambda y: {"V": y[:, 0] - np.log(y[:, 0]) + y[:, 1] - np.log(y[:, 1])},
    )


@kernel(VECTOR_FIELD)
def _bell(time, y, parameters, slope):
    slope[0] = -2 * time * y[0]


def bell() -> Given:
    """y' = -2 t y, y = exp(-t^2): the equation depends on time."""
    return Given(_bell, np.array([1.0]), exact=Exact(lambda t: np.exp(-(t[:, None] ** 2))))


@kernel(VECTOR_FIELD)
def _explosion(time, y, parameters, slope):
    slope[0] = y[0] * y[0]


def explosion() -> Given:
    """y' = y^2, y = 1/(1 - t): the solution ceases to exist at t = 1."""
    return Given(_explosion, np.array([1.0]))


@kernel(VECTOR_FIELD)
def _counting(time, y, parameters, slope):
    parameters[0] += 1
    slope[0] = y[1]
    slope[1] = -y[0]


@kernel(PART_FLOW)
def _counting_parts(part, duration, y, parameters):
    parameters[0] += 1
    if part == 0:
        y[0] += duration * y[1]
    else:
        y[1] -= duration * y[0]


@kernel(DISCRETE_STEP)
def _counting_step(duration, y, parameters, increment):
    parameters[0] += 1
    increment[0] = duration * y[1]
    increment[1] = -duration * y[0]
    return True


def counting() -> Given:
    """An oscillator that counts its own evaluations in ``parameters[0]``."""
    structure = Structure(splitting=Splitting(2, _counting_parts), discrete=_counting_step)
    return Given(_counting, np.array([1.0, 0.0]), np.zeros(1), structure=structure)


@kernel(VECTOR_FIELD)
def _lorenz(time, y, parameters, slope):
    slope[0] = 10 * (y[1] - y[0])
    slope[1] = y[0] * (28 - y[2]) - y[1]
    slope[2] = y[0] * y[1] - 8 / 3 * y[2]


def lorenz() -> Given:
    """Lorenz's equations: chaotic, errors grow by exp(0.9 t)."""
    return Given(_lorenz, np.array([1.0, 1.0, 20.0]))


@kernel(VECTOR_FIELD)
def _kepler(time, y, parameters, slope):
    cube = (y[0] * y[0] + y[1] * y[1]) ** 1.5
    slope[0] = y[2]
    slope[1] = y[3]
    slope[2] = -y[0] / cube
    slope[3] = -y[1] / cube


def kepler(eccentricity: float) -> Given:
    """One planet, period 2 pi, from its perihelion: the natural step varies along the orbit."""
    e = eccentricity
    ratio = np.sqrt(1 - e * e)

    def solution(times: Floats) -> Floats:
        anomaly = times + e * np.sin(times)
        for _ in range(50):
            anomaly = anomaly - (anomaly - e * np.sin(anomaly) - times) / (1 - e * np.cos(anomaly))
        c, s = np.cos(anomaly), np.sin(anomaly)
        rate = 1 / (1 - e * c)
        return np.column_stack((c - e, ratio * s, -s * rate, ratio * c * rate))

    start = np.array([1 - e, 0.0, 0.0, np.sqrt((1 + e) / (1 - e))])
    return Given(_kepler, start, exact=Exact(solution, bound=1e-13, period=2 * np.pi))


@kernel(VECTOR_FIELD)
def _stiff(time, y, parameters, slope):
    slope[0] = -parameters[0] * (y[0] - np.cos(time))


def stiff(rate: float = 1e4) -> Given:
    """Prothero and Robinson: y follows cos t, drawn to it at a high rate."""
    r = rate

    def solution(t: Floats) -> Floats:
        followed = (r * r * np.cos(t) + r * np.sin(t)) / (1 + r * r)
        return (followed + (1 - r * r / (1 + r * r)) * np.exp(-r * t))[:, None]

    return Given(_stiff, np.array([1.0]), np.array([rate]), Exact(solution, over=(0.0, 60.0)))
