"""Steps of DOP853 with projection, and the first event on one of them by its dense output.

References
----------
E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (2nd ed., 1993), section II.5; E. Hairer,
C. Lubich, G. Wanner, Geometric Numerical Integration (2nd ed., 2006), section IV.4: projection.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq, minimize_scalar

from tests.oracles.plain_engine.coordinates import Floats, State
from tests.oracles.plain_engine.mechanism import NotSupported
from tests.oracles.plain_engine.phase import Inconsistent, Phase
from tests.oracles.plain_engine.start import projected

INSIDE = (0.0625, 0.25, 0.5, 0.75, 1.0)
"""Parts of a step at which figures are seen."""
FIRST = (1e-4, 1e-3, 1e-2, *INSIDE)
"""The same of the first step after an event, from which something may turn back soon."""
NOTHING = {"gap": 1e-13, "slip": 1e-11, "span": 1e-9}
"""Figure below which nothing has been crossed: gaps and lengths in m, slips relative to the rates. Forces and shares,
relative to those of the scene, are known to some 1e-12."""
NO_FORCE = 1e-10
GRAZES = 1e-9
"""Share of a gap's own size to which it is known whether it reaches zero where it turns back."""

Figures = Callable[[State], dict[tuple[str, int], float]]
"""What has to stay at or above zero, by kind and number."""


@dataclass(frozen=True)
class Crossing:
    """A figure that becomes negative.

    Attributes
    ----------
    grazes : bool
        Whether it turns back at zero, to what is known of it.
    """

    key: tuple[str, int]
    time: float
    state: State
    grazes: bool = False


@dataclass(frozen=True)
class Seen:
    """Figures at times of one step, after the last two of the step before, and how states between are found."""

    times: list[float]
    curves: list[dict[tuple[str, int], float]]
    dense: list[tuple[float, Callable[[float], Floats]]]

    def at(self, time: float) -> Floats:
        """Return the packed state at a time."""
        for begun, dense in reversed(self.dense):
            if time >= begun:
                return dense(time)
        return self.dense[0][1](time)


class Stuck(NotSupported):
    """The steps become too small: the motion comes to a singular place.

    Parameters
    ----------
    time, state
        Where that is, nearly.
    """

    def __init__(self, time: float, state: State, message: str) -> None:
        super().__init__(f"the steps become too small: {message}")
        self.time, self.state = time, state


class Stepper:
    """Follows one phase.

    Parameters
    ----------
    tolerance : float
        Relative error of a step.
    """

    def __init__(self, phase: Phase, tolerance: float) -> None:
        self.phase, self.tolerance = phase, tolerance
        self.mechanism = phase.mechanism
        self.coordinates = self.mechanism.coordinates

    def rate(self, _: float, vector: Floats) -> Floats:
        """Return the rate of a packed state."""
        if not np.isfinite(vector).all():
            return np.full(len(vector), np.nan)
        state = self.coordinates.unpack(vector)
        try:
            accelerations = self.phase.solve(state).accelerations
        except Inconsistent:
            # A step that leaves what is possible is rejected, and tried again with half its length.
            return np.full(len(vector), np.nan)
        return self.coordinates.flow(state, accelerations)

    def project(self, state: State) -> State:
        """Return the state on what holds in this phase."""
        return projected(self.mechanism, state, self.phase.closed, sticking=self.phase.sticking)

    def to(self, state: State, start: float, end: float) -> State:
        """Return the state at a later time, without any watch."""
        if end <= start:
            return state
        solver = self._solver(state, start, end, end - start)
        while solver.status == "running":
            self._step(solver)
        return self.coordinates.unpack(solver.y)

    def _solver(self, state: State, start: float, end: float, first: float | None) -> DOP853:
        vector = self.coordinates.pack(state)
        size = max(1e-3, float(np.abs(state.position).max(initial=0.0)))
        first = None if first is None else min(first, end - start)
        return DOP853(self.rate, start, vector, end, rtol=self.tolerance, atol=self.tolerance * size, first_step=first)

    def _step(self, solver: DOP853) -> None:
        message = solver.step()
        if solver.status == "failed":
            raise NotSupported(f"the steps become too small: {message}")
        state = self.project(self.coordinates.unpack(solver.y))
        self._follow(state)
        solver.y = self.coordinates.pack(state)
        solver.f = self.rate(solver.t, solver.y)

    def _follow(self, state: State) -> None:
        """Let what slides in space go on from its present direction."""
        if any(len(along) == 3 for along in self.phase.along.values()):
            rows, _, slips, _ = self.phase.rows(state)
            for i in self.phase.sliding:
                self.phase.along[i] = self.phase.direction(i, rows.rates[slips[i]])

    def until(
        self, state: State, start: float, end: float, figures: Figures, samples: list[float], first: float | None
    ) -> Iterator[tuple[float, State] | Crossing]:
        """Yield the states at the samples, and last the first crossing; or the state at the end."""
        now, tail = start, Seen([start], [figures(state)], [])
        for stop in [*[t for t in samples if start < t < end], end]:
            if stop <= now:
                continue
            solver = self._solver(state, now, stop, first)
            while solver.status == "running":
                origin, begun = self.coordinates.unpack(solver.y), solver.t
                message = solver.step()
                if solver.status == "failed":
                    raise Stuck(begun, origin, str(message))
                if tail.curves[0]:
                    seen = self._seen(solver, begun, tail, figures)
                    crossing = self._crossing(seen, origin, begun, figures, solver.t - begun)
                    if crossing is not None:
                        yield crossing
                        return
                    tail = Seen(seen.times[-2:], seen.curves[-2:], seen.dense[-1:])
                after = self.project(self.coordinates.unpack(solver.y))
                self._follow(after)
                solver.y = self.coordinates.pack(after)
                solver.f = self.rate(solver.t, solver.y)
                first = solver.h_abs
            state, now = self.coordinates.unpack(solver.y), stop
            yield now, state

    def _seen(self, solver: DOP853, begun: float, tail: Seen, figures: Figures) -> Seen:
        dense = solver.dense_output()
        parts = INSIDE if tail.dense else FIRST
        times = [begun + part * (solver.t - begun) for part in parts]
        curves = [figures(self.coordinates.unpack(dense(t))) for t in times]
        return Seen([*tail.times, *times], [*tail.curves, *curves], [*tail.dense, (begun, dense)])

    def _crossing(self, seen: Seen, origin: State, begun: float, figures: Figures, length: float) -> Crossing | None:
        first: tuple[float, tuple[str, int], bool, Callable[[float], float]] | None = None
        for key in seen.curves[0]:

            def here(t: float, key: tuple[str, int] = key) -> float:
                return figures(self.coordinates.unpack(seen.at(t)))[key]

            found = _first_loss(here, seen.times, [curve[key] for curve in seen.curves], key[0])
            if found is not None and (first is None or found[0] < first[0]):
                first = (found[0], key, found[1], here)
        if first is None:
            return None
        time, key, grazes, figure = first
        if not grazes and time > begun:
            time = self._refined(origin, begun, time, figure, figures, key, length)
        time = max(time, begun)
        return Crossing(key, time, self.project(self.to(origin, begun, time)), grazes)

    def _refined(
        self, origin: State, begun: float, time: float, figure: Callable[[float], float], figures: Figures,
        key: tuple[str, int], length: float,
    ) -> float:  # fmt: skip
        """Return the time of a zero, by states that are reached in steps and not by interpolation."""
        delta = 1e-4 * length
        earlier = max(time - delta, begun + 0.5 * (time - begun))
        slope = (figure(time) - figure(earlier)) / (time - earlier) if time > earlier else 0.0
        if slope >= 0.0:
            return time
        for _ in range(2):
            change = figures(self.to(origin, begun, time))[key] / slope
            if abs(change) > 0.05 * length:
                return time
            time -= change
            if abs(change) < 1e-11 * length:
                break
        return time


def _first_loss(
    figure: Callable[[float], float], times: list[float], values: list[float], kind: str
) -> tuple[float, bool] | None:
    """Return the first time at which a figure becomes negative, and whether it turns back there."""
    nothing = NOTHING.get(kind, NO_FORCE)
    for k in range(1, len(times)):
        if values[k] < -nothing:
            if values[k - 1] > nothing:
                return float(brentq(figure, times[k - 1], times[k], xtol=1e-15)), False
            return _from_zero(figure, times[k - 1], times[k]), False
        if k + 1 < len(times) and nothing < values[k] < values[k - 1] and values[k] <= values[k + 1]:
            if _parabola(times[k - 1 : k + 2], values[k - 1 : k + 2]) > 0.3 * values[k]:
                continue
            a, c = times[k - 1], times[k + 1]
            found = minimize_scalar(figure, bounds=(a, c), method="bounded", options={"xatol": 1e-9 * (c - a)})
            size = max(values[k - 1], values[k + 1])
            if found.fun < -max(nothing, GRAZES * size):
                return float(brentq(figure, a, found.x, xtol=1e-15)), False
            if kind == "gap" and found.fun < GRAZES * size:
                return float(found.x), True
    return None


def _from_zero(figure: Callable[[float], float], start: float, end: float) -> float:
    """Return where a figure becomes negative that is about zero at the start: there, or after it has been positive."""
    span = end - start
    for part in np.geomspace(1e-6, 1.0, 25)[:-1]:
        t = start + part * span
        if figure(t) > 0.0:
            return float(brentq(figure, t, end, xtol=1e-15))
    return start


def _parabola(t: list[float], x: list[float]) -> float:
    a, b, c = np.polyfit(np.array(t) - t[1], np.array(x), 2)
    return float(c - b * b / (4 * a)) if a > 0.0 else min(x)
