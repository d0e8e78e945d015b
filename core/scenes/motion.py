"""The motion of a named scene in closed form: events, and samples with bounds of their errors."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter
from core.notices import Notice
from core.scenes.enclosure import UNIT_ROUNDOFF, ZERO, Ball, exact, sign
from core.scenes.equation import SceneEquation
from core.systems.system import Model
from core.systems.trajectory import Column, MotionEvent
from core.work import spend

SMALLEST_SAMPLE = 1e-290
"""Columns of smaller numbers than this would lose digits below the normal range of doubles."""
WORK_OF_A_BALL_SAMPLE = 10
"""Units of work (`core.work`) of one sample in balls."""


@dataclass(frozen=True)
class Event:
    """Something that happens at an instant.

    Attributes
    ----------
    kind : str
        For example ``"string-1-unwound"``.
    time : ball
        From the given state (s).
    """

    kind: str
    time: Ball

    def in_doubles(self) -> MotionEvent:
        """Return the event at the double nearest to its time, and how far that may be from it."""
        time = float(self.time)
        error = float(abs(self.time - exact(time)).upper())
        return MotionEvent(self.kind, "", time, error and math.nextafter(error, math.inf))


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a motion, by name, each of shape (n,) or (n, 2), and a bound of their errors.

    Attributes
    ----------
    values : mapping of str to ndarray
        Without the times.
    errors : mapping of str to ndarray
        Bound of the absolute error of each sample, broadcastable to the values.
    scales : mapping of str to float
        Largest magnitude of each column in the motion, the given state included.
    notices : tuple of Notice
        Columns that could not be given, and why.
    """

    values: Mapping[str, Floats]
    errors: Mapping[str, Floats]
    scales: Mapping[str, float]
    notices: tuple[Notice, ...] = ()

    def columns(self, units: Mapping[str, str]) -> dict[str, Column]:
        """Return the columns, in the units that their scene declares."""
        return {
            name: Column(
                values,
                units[name],
                float(np.max(self.errors[name], initial=0.0)),
                "closed form",
                scale=self.scales[name],
            )
            for name, values in self.values.items()
        }

    def without_underflow(self, sizes: Mapping[str, Ball]) -> Samples:
        """Return the columns without those that a double is too small for, judged by the sizes given."""
        lost = {name for name, size in sizes.items() if sign(size) and abs(float(size)) < SMALLEST_SAMPLE}

        def remaining(table: Mapping[str, Any]) -> dict[str, Any]:
            return {name: entry for name, entry in table.items() if name not in lost}

        notices = tuple(
            Notice("outside-double-range", f"trajectory/{name} is too small for doubles") for name in sorted(lost)
        )
        return Samples(
            remaining(self.values), remaining(self.errors), remaining(self.scales), (*self.notices, *notices)
        )


class NamedSceneMotion(ABC):
    """A motion known in closed form, as long as its model holds."""

    @property
    @abstractmethod
    def model(self) -> Model:
        """The model and its regime."""

    @property
    @abstractmethod
    def valid_from(self) -> float:
        """Earliest time at which the model holds, minus infinity if it always did (s)."""

    @property
    @abstractmethod
    def end(self) -> Event | None:
        """The event that ends the motion, or None if nothing does."""

    @abstractmethod
    def events(self) -> tuple[Event, ...]:
        """Return what happens from t = 0 on, in order, the end included."""

    @abstractmethod
    def at(self, time: Ball) -> Mapping[str, Any]:
        """Return every column at one time, as balls, or tuples of balls, of the current precision.

        It is called only between the beginning and the end.
        """

    @abstractmethod
    def equation(self) -> SceneEquation:
        """Return the equation of the motion, which methods integrate.

        Raises
        ------
        NotApplicable
            If something happens to the motion that an equation does not describe.
        """

    @abstractmethod
    def observed(self, states: Floats) -> Mapping[str, Floats]:
        """Return the columns that follow from states of the equation, shape (n, k)."""

    @abstractmethod
    def states(self, columns: Mapping[str, Floats]) -> Floats:
        """Return the states of the equation, shape (n, k), to which columns belong."""

    def sample(self, times: Floats) -> Samples:
        """Return the motion at `times`, shape (n,), all between the beginning and the end.

        Balls are rounded to doubles here; a scene whose samples are to be faster evaluates them in doubles.
        """
        spend(WORK_OF_A_BALL_SAMPLE * times.size)
        given = {name: np.abs(_doubles(value)) for name, value in self.at(ZERO).items()}
        rows = [self.at(exact(time)) for time in times.tolist()]
        values, errors, scales = {}, {}, {}
        for name, start in given.items():
            found = np.array([_doubles(row[name]) for row in rows]).reshape((len(rows), *start.shape))
            widths = np.array([_widths(row[name]) for row in rows]).reshape(found.shape)
            values[name] = found
            errors[name] = widths + UNIT_ROUNDOFF * np.abs(found)
            scales[name] = max(float(np.max(np.abs(found), initial=0.0)), float(np.max(start)))
        return Samples(finite(values), errors, scales)


def _doubles(value: Any) -> Floats:
    return np.array([float(ball) for ball in value] if isinstance(value, tuple) else float(value))


def _widths(value: Any) -> Floats:
    return np.array([float(ball.rad()) for ball in value] if isinstance(value, tuple) else float(value.rad()))


class UnbrokenMotion(NamedSceneMotion):
    """A motion in one piece: nothing happens but its end.

    Parameters
    ----------
    end : Event or None
    end_of_reversed : callable
        Returns what would end the motion backwards in time, only called where `valid_from` is needed.
    """

    def __init__(self, end: Event | None, end_of_reversed: Callable[[], Event | None]) -> None:
        self._end, self._end_of_reversed = end, end_of_reversed

    @cached_property
    def valid_from(self) -> float:
        """When the reversed motion would end."""
        first = self._end_of_reversed()
        # The difference, unlike the negative, of zero has no sign.
        return -math.inf if first is None else 0.0 - float(first.time)

    @property
    def end(self) -> Event | None:
        """The only event."""
        return self._end

    def events(self) -> tuple[Event, ...]:
        """Return the end, if there is one."""
        return () if self._end is None else (self._end,)


def finite(values: Mapping[str, Floats]) -> Mapping[str, Floats]:
    """Return the columns, or refuse them if a sample has left the range of doubles."""
    for name, column in values.items():
        if not np.all(np.isfinite(column)):
            raise InvalidParameter(
                "times", f"keep {name} inside the range of double precision", remedy="ask for shorter times"
            )
    return values
