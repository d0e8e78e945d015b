"""Mistakes about free rotation: rates, periods, cones, the wobble, Euler's equations and their integration."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import pi, sqrt, tan
from typing import Any

import numpy as np

from core.arrays import Floats
from core.assessment.mistakes import Figure, Mistake

PRECESSION, TRAJECTORY, WOBBLE, STABILITY = (
    f"rotation/{name}" for name in ("precession", "trajectory", "wobble", "stability")
)
TIME_SCALES = (60.0, 1.0 / 60.0, 1e3, 1e-3, 2.0 * pi, 0.5 / pi, 2.0, 0.5)
"""Factors of times that are in another unit, or by which a rate is wrong."""

MOVED = 0.2
"""Share of the largest rate by which samples at other times than stated have to change."""

MOST_STEPS = 10_000
"""Of an integration that is done wrongly."""


def instead(name: str, other: str) -> Callable[[Figure], Iterator[Any]]:
    """Return what gives another figure of the answer for the figure of a name."""

    def wrong(figure: Figure) -> Iterator[Any]:
        if figure.subject in (PRECESSION, TRAJECTORY, WOBBLE) and figure.path == (name,):
            yield figure.beside(other)

    return wrong


def _either(name: str, other: str) -> Callable[[Figure], Iterator[Any]]:
    def wrong(figure: Figure) -> Iterator[Any]:
        yield from instead(name, other)(figure)
        yield from instead(other, name)(figure)

    return wrong


def _over_own_moment(figure: Figure) -> Iterator[Any]:
    """Yield (I3 - I)/I3 w3, and the period that follows; I/I3 is the quotient of the tangents of two cones."""
    if figure.subject != PRECESSION or figure.path not in (("body_rate",), ("period",)):
        return
    momentum, velocity = figure.beside("axis_to_angular_momentum"), figure.beside("axis_to_angular_velocity")
    if momentum and velocity and tan(velocity) and figure.beside("body_rate") is not None:
        ratio = tan(momentum) / tan(velocity)
        if ratio:
            yield figure.right * ratio if figure.path == ("body_rate",) else figure.right / ratio


def _moments_exchanged(figure: Figure) -> Iterator[Any]:
    """Yield (I - I3)/I3 w3: the moments exchanged in the body rate."""
    for value in _over_own_moment(figure):
        if figure.path == ("body_rate",):
            yield -value


def _as_symmetric(figure: Figure) -> Iterator[Any]:
    """Yield the period of a symmetric body whose transverse moment is the mean of the two."""
    body = figure.request.get("body", {})
    moments = body.get("moments") if isinstance(body, dict) else None
    if figure.subject not in (PRECESSION, TRAJECTORY) or figure.path != ("period",) or not isinstance(moments, list):
        return
    if len(set(moments)) < 3:
        return
    rates = figure.request["angular_velocity"]
    k = max(range(3), key=lambda i: abs(rates[i]))
    # The sum of all less the one is zero where that one is much larger than the others.
    mean = sum(moment / 2.0 for i, moment in enumerate(moments) if i != k)
    rate = abs((moments[k] - mean) / mean * rates[k])
    if rate:
        yield 2.0 * pi / rate


def _root_of_moments(figure: Figure) -> Iterator[Any]:
    if figure.subject == WOBBLE and figure.path == ("ellipticity",):
        yield sqrt(1.0 + figure.beside("asymmetry"))


def _quotient_of_moments(figure: Figure) -> Iterator[Any]:
    if figure.subject == WOBBLE and figure.path == ("ellipticity",):
        yield 1.0 / (1.0 - figure.beside("asymmetry"))


def _other_day(figure: Figure) -> Iterator[Any]:
    if figure.subject == WOBBLE:
        other = "sidereal" if figure.request.get("day", "sidereal") == "solar" else "solar"
        yield figure.answered({**figure.request, "day": other})


def _unstable_extreme(figure: Figure) -> Iterator[Any]:
    if figure.subject == STABILITY and figure.name == "stable" and figure.right is True:
        yield False


def _stable_middle(figure: Figure) -> Iterator[Any]:
    if figure.subject == STABILITY and figure.name == "stable" and figure.right is False:
        yield True


def _real_for_imaginary(figure: Figure) -> Iterator[Any]:
    if figure.reference.form == "set" and figure.reference.value.ndim == 2:
        yield figure.right[:, ::-1].copy()


def _gyration(moments: Any, w: Floats, second: float = 1.0) -> Floats:
    a, b, c = moments
    x, y, z = w
    return np.array([(b - c) / a * y * z, second * (c - a) / b * z * x, (a - b) / c * x * y])


def _marched(figure: Figure, advance: Callable[[Any, Floats, float], Floats]) -> Iterator[Any]:
    """Yield the samples of a named forward Euler whose step is done wrongly, of bodies given by their moments."""
    request = figure.request
    method, body = request.get("method"), request.get("body")
    if figure.subject != TRAJECTORY or figure.path[0] != "angular_velocity" or not isinstance(method, dict):
        return
    if method.get("kind") != "explicit-euler" or not isinstance(body, dict) or "moments" not in body:
        return
    step, times = float(method["step"]), figure.beside("time")
    if times is None or times.min() < 0.0 or times.max() > MOST_STEPS * step:
        return
    counts = np.rint(times / step).astype(int)
    w, states = np.array(request["angular_velocity"], dtype=np.float64), []
    with np.errstate(all="ignore"):
        for _ in range(counts.max(initial=0) + 1):
            states.append(w)
            w = advance(body["moments"], w, step)
    rows: Any = np.array(states)[counts]
    for index in figure.path[1:]:
        rows = rows[index]
    yield rows


def _second_equation(figure: Figure) -> Iterator[Any]:
    yield from _marched(figure, lambda moments, w, h: w + h * _gyration(moments, w, -1.0))


def _derivative_for_state(figure: Figure) -> Iterator[Any]:
    yield from _marched(figure, lambda moments, w, h: _gyration(moments, w))


def _step_left_out(figure: Figure) -> Iterator[Any]:
    yield from _marched(figure, lambda moments, w, h: w + _gyration(moments, w))


def _of_samples(figure: Figure) -> Floats | None:
    """Return the times of samples of the angular velocity, None for any other figure."""
    if figure.subject != TRAJECTORY or figure.path != ("angular_velocity",) or figure.reference.form != "samples":
        return None
    times: Any = figure.request["times"]
    return np.array(times, dtype=np.float64) if isinstance(times, list) else None


def _in_space(figure: Figure) -> Iterator[Any]:
    """Yield the angular velocity in space axes that are the body axes at t = 0."""
    if _of_samples(figure) is None:
        return
    q = figure.evaluate({**figure.request, "attitude": [1.0, 0.0, 0.0, 0.0]})(("attitude",))
    if q is not None:
        v, w = figure.right, q[:, 1:]
        turned = 2.0 * np.cross(w, v)
        yield v + q[:, :1] * turned + np.cross(w, turned)


def _shifted(figure: Figure) -> Iterator[Any]:
    times = _of_samples(figure)
    if times is not None and len(times) > 1:
        for moved in (np.append(times[1:], 2.0 * times[-1] - times[-2]), np.append(times[0], times[:-1])):
            yield figure.answered({**figure.request, "times": moved.tolist()})


def _time_scaled(figure: Figure) -> Iterator[Any]:
    times = _of_samples(figure)
    if times is not None:
        for scale in TIME_SCALES:
            rows = figure.answered({**figure.request, "times": (scale * times).tolist()})
            # A motion of which hardly anything is seen is that of who submits a constant.
            if rows is not None and np.ptp(rows, axis=0).max() > MOVED * np.abs(rows).max():
                yield rows


def _slow_precession(figure: Figure) -> Iterator[Any]:
    """Yield the samples of a symmetric body at the rate (I3 - I)/I3 w3, and those one sample late."""
    times, body = _of_samples(figure), figure.request.get("body", {})
    moments = body.get("moments") if isinstance(body, dict) else None
    if times is None or not isinstance(moments, list) or len(set(moments)) != 2:
        return
    k = next(i for i in range(3) if moments.count(moments[i]) == 1)
    i, j = (k + 1) % 3, (k + 2) % 3
    w = np.array(figure.request["angular_velocity"], dtype=np.float64)
    rate = (moments[k] - moments[i]) / moments[k] * w[k]
    for instants in (times, np.append(times[0], times[:-1])):
        rows = np.tile(w, (len(times), 1))
        turned = (w[i] + 1j * w[j]) * np.exp(1j * rate * instants)
        rows[:, i], rows[:, j] = turned.real, turned.imag
        yield rows


OF_ROTATION = (
    Mistake("space-axes", "The angular velocity in space axes for that in body axes.", _in_space, credit=0.5),
    Mistake("samples-off-by-one", "Every sample at the time of its neighbour.", _shifted, credit=0.5),
    Mistake(
        "samples-rate-over-axial-moment",
        "Samples of a symmetric body that precess at (I3 - I)/I3 w3.",
        _slow_precession,
        credit=0.25,
    ),
    Mistake(
        "time-scaled",
        "Samples at other times than stated: minutes, milliseconds, turns, twice or half of them.",
        _time_scaled,
        credit=0.25,
    ),
    Mistake(
        "period-for-flip-interval",
        "The period for the interval between flips, or the reverse.",
        _either("flip_interval", "period"),
        credit=0.5,
    ),
    Mistake(
        "body-for-space-rate",
        "The rate of precession in the body for that in space, or the reverse.",
        _either("body_rate", "space_rate"),
    ),
    Mistake(
        "cones-exchanged",
        "The angle of the axis with the angular velocity for that with the angular momentum, or the reverse.",
        _either("axis_to_angular_momentum", "axis_to_angular_velocity"),
    ),
    Mistake("rate-over-axial-moment", "(I3 - I)/I3 w3 for the body rate.", _over_own_moment, credit=0.25),
    Mistake("moments-exchanged", "The axial and the transverse moment exchanged in the body rate.", _moments_exchanged),
    Mistake("symmetric-formula", "The period of a symmetric body for one with three different moments.", _as_symmetric),
    Mistake("ellipticity-root-of-moments", "sqrt(I1/I) for the axis ratio.", _root_of_moments),
    Mistake("ellipticity-quotient-of-moments", "1/(1 - e) for the axis ratio.", _quotient_of_moments),
    Mistake(
        "flattening-for-asymmetry",
        "The flattening for the asymmetry of the moments, or the reverse.",
        _either("flattening", "asymmetry"),
    ),
    Mistake("solar-for-sidereal-day", "Solar days for sidereal ones, or the reverse.", _other_day, credit=0.5),
    Mistake("extreme-axis-unstable", "The axis of largest or smallest moment called unstable.", _unstable_extreme),
    Mistake("middle-axis-stable", "The axis of the middle moment called stable.", _stable_middle),
    Mistake("real-for-imaginary", "Real and imaginary parts exchanged.", _real_for_imaginary),
    Mistake(
        "euler-second-equation", "(I1 - I3) w1 w3 in the second of Euler's equations.", _second_equation, credit=0.5
    ),
    Mistake(
        "derivative-for-state", "w[i+1] = f(w[i]): neither the step nor the previous value.", _derivative_for_state
    ),
    Mistake("step-left-out", "w[i+1] = w[i] + f(w[i]): without the step.", _step_left_out, credit=0.5),
)
