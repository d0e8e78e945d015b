"""Columns of an answer about a described scene, compared with those of another formulation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from mpmath import asin, ellipfun, mp, mpf, sin, sqrt

from tests.oracles.minimal_coordinates import with_rates

Answer = dict[str, Any]
Columns = dict[str, Any]

ROUNDING = 2.0**-52
RATES = {"position": "velocity", "angle": "angular_velocity"}


def columns(answer: Answer) -> Columns:
    return {name: np.array(column["values"]) for name, column in answer["trajectory"]["columns"].items()}


def times(answer: Answer) -> list[float]:
    return list(answer["trajectory"]["time"])


def stated(answer: Answer, name: str) -> float:
    """Return the error that an answer states of a column, with the rounding of its reference to doubles."""
    column = answer["trajectory"]["columns"][name]
    return float(column["error"] + ROUNDING * np.abs(column["values"]).max())


def agree(answer: Answer, expected: Mapping[str, Any], own: float = 0.0) -> None:
    """Assert that columns are as expected, to the errors that are stated and the reference's own."""
    found = columns(answer)
    for name, values in expected.items():
        away = found[name] - np.array(values, dtype=float)
        error = np.abs(away) if away.ndim == 1 else np.linalg.norm(away, axis=1)
        assert error.max() <= stated(answer, name) + own, f"{name}: {error.max()}, {stated(answer, name)}"


def observed(
    states: Iterable[tuple[Sequence[Any], Sequence[Any]]], places: Callable[..., Mapping[str, Any]]
) -> Columns:
    """Return columns from coordinates and their rates: places gives a number or components for each."""
    found: dict[str, list[Any]] = {}
    for q, v in states:
        for name, (value, rate) in with_rates(places, q, v).items():
            body, _, what = name.rpartition(".")
            found.setdefault(name, []).append(value if len(value) > 1 else value[0])
            if what in RATES:
                found.setdefault(f"{body}.{RATES[what]}", []).append(rate if len(rate) > 1 else rate[0])
    return {name: np.array(values) for name, values in found.items()}


def in_time(answer: Answer, places: Callable[[Any], Mapping[str, Any]]) -> Columns:
    """Return columns that are functions of time."""
    return observed([([mpf(t)], [mpf(1)]) for t in times(answer)], places)


def swing(amplitude: Any, square: Any, time: Any) -> tuple[Any, Any]:
    """Return angle and rate of theta'' = -square sin(theta), released at rest.

    sin(theta/2) = k cd(omega t, k), k = sin(amplitude/2): L. D. Landau, E. M. Lifshitz, Mechanics, section 11.
    Amplitude and square are decimals, or functions that find them at the precision here.
    """
    with mp.workdps(40):
        a, squared = (x() if callable(x) else mpf(x) for x in (amplitude, square))
        k, rate = sin(a / 2), sqrt(squared)
        m, u = k * k, rate * mpf(time)
        half = k * ellipfun("cd", u, m=m)
        slope = -(1 - m) * ellipfun("sn", u, m=m) / ellipfun("dn", u, m=m) ** 2
        return 2 * asin(half), 2 * k * rate * slope / sqrt(1 - half * half)


def swinging(answer: Answer, amplitude: Any, square: Any, places: Callable[[Any], Mapping[str, Any]]) -> Columns:
    """Return columns that are functions of the angle of a pendulum released at rest."""
    states = [swing(amplitude, square, t) for t in times(answer)]
    return observed([([angle], [rate]) for angle, rate in states], places)
