"""Steps of DOP853 with projection, and the first event on one of them by its dense output.

References
----------
E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (2nd ed., 1993), section II.5; E. Hairer,
C. Lubich, G. Wanner, Geometric Numerical Integration (2nd ed., 2006), section IV.4: projection.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq, minimize_scalar

from tests.oracles.plain_engine.coordinates import Coordinates, Floats, State
from tests.oracles.plain_engine.mechanism import NotSupported
from tests.oracles.plain_engine.phase import Inconsistent, Key, Phase
from tests.oracles.plain_engine.start import projected

INSIDE = (0.125, 0.5, 1.0)
"""Parts of a step at which figures are seen."""
FIRST = (1e-4, 1e-3, 1e-2, *INSIDE)
"""The same of the first step after an event, from which something may turn back soon."""
NOTHING = {"gap": 1e-13, "slip": 1e-11, "span": 1e-9}
"""Figure below which nothing has been crossed: gaps and lengths in m, slips relative to the rates. Forces and shares,
relative to those of the scene, are known to some 1e-12."""
NO_FORCE = 1e-10
ENOUGH = 60
"""Steps of a short motion after which it is at a singular place."""
HALF = 0.5
"""Share of the least value seen above which the vertex of a parabola has to be for a figure to stay clear of zero."""
GRAZES = 1e-9
"""Share of a gap's own size to which it is known whether it reaches zero where it turns back."""
LOSES_RANK = 1e-4
"""Share of its value at the start of a phase to which the product of squares has fallen where steps end because the
rank is lost."""
TOUCHES = {"gap": GRAZES, "rank": 1e-12}
"""The same of what ends a motion there; a product of squares is zero to the square of what places are known to."""

Figures = Callable[..., dict[Key, float]]
"""What has to stay at or above zero in a state, by kind and number: all, or that of one kind, or a number of it."""


@dataclass(frozen=True)
class Crossing:
    """A figure that becomes negative.

    Attributes
    ----------
    grazes : bool
        Whether it turns back at zero, to what is known of it.
    """

    key: Key
    time: float
    state: State
    grazes: bool = False


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
        """Return the rate of a packed state: none where a step leaves what is possible, which makes it shorter."""
        try:
            if np.isfinite(vector).all():
                state = self.coordinates.unpack(vector)
                return self.coordinates.flow(state, self.phase.solve(state).accelerations)
        except Inconsistent:
            pass
        return np.full(len(vector), np.nan)

    def project(self, state: State) -> State:
        """Return the state on what holds in this phase."""
        return projected(self.mechanism, state, self.phase.closed, sticking=self.phase.sticking)

    def to(self, state: State, start: float, end: float) -> State:
        """Return the state at a later time, or where steps become too small on the way, without any watch."""
        steps = self._steps(state, start, end, end - start) if end > start else ()
        last = deque(islice(steps, ENOUGH), maxlen=1)
        return last[0][1] if last else state

    def _steps(self, state: State, start: float, end: float, first: float | None) -> Iterator[tuple[DOP853, State]]:
        """Yield the method after each of its steps, and the projected state from which the next begins."""
        size = max(1e-3, float(np.abs(state.position).max(initial=0.0)))
        first = None if first is None else min(first, end - start)
        absolute = self.tolerance * size
        vector = self.coordinates.pack(state)
        solver = DOP853(self.rate, start, vector, end, rtol=self.tolerance, atol=absolute, first_step=first)
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise NotSupported(f"the steps become too small: {message}")
            after = self.project(self.coordinates.unpack(solver.y))
            yield solver, after
            self.phase.turn(after)
            solver.y = self.coordinates.pack(after)
            solver.f = self.rate(solver.t, solver.y)

    def until(
        self, state: State, start: float, end: float, figures: Figures, samples: list[float], first: float | None
    ) -> Iterator[tuple[float, State] | Crossing]:
        """Yield the states at the samples, and last the first crossing; or the state at the end."""
        last = deque([(start, state)], maxlen=8)
        try:
            yield from self._until(state, start, end, figures, samples, first, last)
        except (NotSupported, np.linalg.LinAlgError):
            # Beside a place where connections lose their rank forces grow beyond bounds.
            (before, then), (time, now) = last[0], last[-1]
            size, earlier, lost = (figures(x, "rank").get(("rank", -1), 0.0) ** 0.5 for x in (state, then, now))
            if not 0.0 < lost < min(earlier, LOSES_RANK**0.5 * size):
                raise
            yield Crossing(("rank", -1), time + lost * (time - before) / (earlier - lost), now)

    def _until(
        self,
        state: State,
        start: float,
        end: float,
        figures: Figures,
        samples: list[float],
        first: float | None,
        last: deque[tuple[float, State]],
    ) -> Iterator[tuple[float, State] | Crossing]:
        times, curves, now = [start], [figures(state)], start
        dense: list[Callable[[float], Floats]] = []
        for stop in [*[t for t in samples if start < t < end], end]:
            for solver, after in self._steps(state, now, stop, first):
                parts = INSIDE if dense else FIRST
                dense = [*dense[-1:], solver.dense_output()]
                times = [*times[-2:], *(solver.t_old + part * solver.step_size for part in parts)]
                seen = partial(_between, dense, solver.t_old, self.coordinates)
                curves = [*curves[-2:], *(figures(seen(t)) for t in times[-len(parts) :])]
                crossing = self._crossing(seen, times, curves, figures, solver)
                if crossing is not None:
                    yield crossing
                    return
                first, state = solver.h_abs, after
                last.append((solver.t, after))
            now = stop
            yield now, state

    def _crossing(
        self,
        seen: Callable[[float], State],
        times: list[float],
        curves: list[dict[Key, float]],
        figures: Figures,
        solver: DOP853,
    ) -> Crossing | None:
        losses = []
        for key in curves[0]:
            loss = _first_loss(lambda t, key=key: figures(seen(t), *key)[key], times, [x[key] for x in curves], key[0])  # type: ignore[misc]
            losses += [] if loss is None else [(*loss, key)]
        if not losses:
            return None
        time, grazes, key = min(losses)
        if grazes:
            return Crossing(key, time, seen(time), grazes)
        begun, origin = solver.t_old, self.coordinates.unpack(solver.y_old)
        earlier = max(time - 1e-4 * solver.step_size, begun + 0.5 * (time - begun))
        if time > earlier:
            # The zero of states that are reached in steps, and not by interpolation.
            then, before = (figures(seen(t), *key)[key] for t in (time, earlier))
            slope = (then - before) / (time - earlier)
            for _ in range(2 if slope < 0.0 else 0):
                change = figures(self.to(origin, begun, time), *key)[key] / slope
                time -= change if abs(change) <= 0.05 * solver.step_size else 0.0
        return Crossing(key, max(time, begun), self.to(origin, begun, max(time, begun)))


def _between(dense: list[Callable[[float], Floats]], begun: float, coordinates: Coordinates, time: float) -> State:
    """Return the state within the present step, or the one before."""
    return coordinates.unpack(dense[-1 if time >= begun else 0](time))


def _first_loss(
    figure: Callable[[float], float], times: list[float], values: list[float], kind: str
) -> tuple[float, bool] | None:
    """Return the first time at which a figure becomes negative, and whether it turns back there."""
    nothing = NOTHING.get(kind, NO_FORCE)
    for k in range(1, len(times)):
        if values[k] < -nothing:
            if values[k - 1] > nothing and figure(times[k - 1]) > 0.0:
                return float(brentq(figure, times[k - 1], times[k], xtol=1e-15)), False
            return _from_zero(figure, times[k - 1], times[k]), False
        if k + 1 < len(times) and nothing < values[k] < values[k - 1] and values[k] <= values[k + 1]:
            if _parabola(times[k - 1 : k + 2], values[k - 1 : k + 2]) > HALF * values[k]:
                continue
            a, c = times[k - 1], times[k + 1]
            found = minimize_scalar(figure, bounds=(a, c), method="bounded", options={"xatol": 1e-9 * (c - a)})
            size = max(values[k - 1], values[k + 1])
            if found.fun < -max(nothing, GRAZES * size):
                return float(brentq(figure, a, found.x, xtol=1e-15)), False
            if found.fun < TOUCHES.get(kind, 0.0) * size:
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
