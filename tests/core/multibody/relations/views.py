"""What two answers about one motion have in common, in a form that a transformation can be applied to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from core.arrays import Floats
from core.errors import MechanicsError
from core.multibody.answer import SceneSolution

START = 2.0**-40
"""Relative error taken for figures of the start, which are doubles of numbers that are known to many more digits."""


@dataclass(frozen=True)
class Figure:
    """Values of one quantity, shape (n,) or (n, k), and their stated error; `what` is the last part of its name.

    Least and largest values are those until a time.
    """

    values: Floats
    unit: str
    error: float
    what: str
    owner: str
    until: float = np.inf


@dataclass(frozen=True)
class Event:
    kind: str
    name: str
    time: float
    error: float
    impulse: float
    loss: float


@dataclass(frozen=True)
class View:
    """An answer.

    Attributes
    ----------
    figures : dict of str to Figure
        Columns, and the accelerations, forces and energy of the start.
    times : ndarray
        Those that the motion reaches.
    models : list of (str, int, float or None)
        Name, degrees of freedom and period of every part.
    found : dict of str to (time, error)
        Occurrences.
    """

    figures: dict[str, Figure]
    times: Floats
    events: list[Event]
    ended: tuple[str, float] | None
    problem: str | None
    models: list[tuple[str, int, float | None]]
    states: list[tuple[float, dict[str, str]]]
    found: dict[str, tuple[float, float]] = field(default_factory=dict)

    def renamed(self, names: dict[str, str]) -> View:
        """Return the view with other names of bodies and connections."""

        def new(name: str) -> str:
            head, dot, rest = name.partition(".")
            return names.get(head, head) + dot + rest

        return replace(
            self,
            figures={
                ":".join([*key.split(":")[:-1], new(key.split(":")[-1])]): replace(one, owner=new(one.owner))
                for key, one in self.figures.items()
            },
            events=[replace(event, name=new(event.name)) for event in self.events],
            states=[(t, {new(name): state for name, state in states.items()}) for t, states in self.states],
            found={new(key): value for key, value in self.found.items()},
        )

    def mapped(self, change: Callable[[Figure], Figure | None]) -> View:
        """Return the view with every figure changed; what has no image is left out."""
        images = {key: change(figure) for key, figure in self.figures.items()}
        return replace(self, figures={key: image for key, image in images.items() if image is not None})


@dataclass(frozen=True)
class Refusal:
    """Why there is no answer."""

    kind: str
    detail: str


def view_of(answer: SceneSolution) -> View:
    """Return the view of an answer."""
    figures: dict[str, Figure] = {}
    motion = answer.trajectory
    if motion is not None:
        for name, column in motion.columns.items():
            owner, _, what = name.rpartition(".")
            figures[f"column:{name}"] = Figure(column.values, column.unit, column.error, what, owner)
    for found in answer.extremes or ():
        owner = found.quantity.partition(".")[0]
        values = np.array([[found.least, found.largest]])
        figures[f"extremes:{found.quantity}"] = Figure(values, found.unit, found.error, "extremes", owner, found.until)
    for body, one in (answer.accelerations or {}).items():
        _start(figures, f"{body}.acceleration", one.linear, "m/s^2")
        if one.angular is not None:
            _start(figures, f"{body}.angular_acceleration", one.angular, "rad/s^2")
    for force, reading in (answer.forces or {}).items():
        if reading.value is not None:
            _start(figures, force, reading.value, reading.unit)
    if answer.energy is not None:
        for part in ("kinetic", "total"):
            _start(figures, f"energy.{part}", getattr(answer.energy, part), "J")
    _vectors(figures)
    return View(
        _scaled_starts(figures),
        np.zeros(0) if motion is None else motion.time,
        [
            Event(event.kind, event.name, event.time, event.error, event.impulses.get("normal", 0.0), event.energy_loss)
            for event in answer.events
        ],
        None if answer.ended is None else (answer.ended.kind, answer.ended.time),
        None if answer.problem is None else answer.problem.code,
        sorted(
            (
                # Up to a turn about the vertical it may repeat after half of the time in other axes.
                (part.name, part.degrees_of_freedom, None if part.precession else part.period)
                for part in answer.model.apart
                if part.name != "rest"
            ),
            key=lambda part: (part[0], part[1], part[2] or 0.0),
        ),
        [] if answer.phases is None else [(phase.start, dict(phase.states)) for phase in answer.phases],
        {f"{one.quantity}#{one.nth}": (one.time, one.error) for one in answer.occurrences or ()},
    )


def without_freedoms(view: View) -> View:
    """Return the view without degrees of freedom and periods, which depend on the axes."""
    return replace(view, models=[(name, 0, None) for name, _, _ in view.models])


def viewed(ask: Callable[[], SceneSolution]) -> View | Refusal:
    """Return the view of an answer, or why there is none."""
    try:
        return view_of(ask())
    except MechanicsError as fault:
        return Refusal(type(fault).__name__, fault.detail)
    except Exception as fault:
        return Refusal("crash", repr(fault))


def _start(figures: dict[str, Figure], name: str, value: Any, unit: str) -> None:
    owner, _, what = name.rpartition(".")
    figures[f"start:{name}"] = Figure(np.atleast_1d(np.array(value, dtype=float))[None], unit, 0.0, what, owner)


def _scaled_starts(figures: dict[str, Figure]) -> dict[str, Figure]:
    """Give the figures of the start errors: relative to the largest of their units."""
    largest: dict[str, float] = {}
    for key, figure in figures.items():
        if key.startswith("start:"):
            largest[figure.unit] = max(largest.get(figure.unit, 0.0), float(np.abs(figure.values).max(initial=0.0)))
    # Zero in one unit is a balance of what is large in another.
    floor = max(largest.values(), default=0.0)
    return {
        key: replace(figure, error=START * max(largest[figure.unit], 1e-3 * floor))
        if key.startswith("start:")
        else figure
        for key, figure in figures.items()
    }


def _vectors(figures: dict[str, Figure]) -> None:
    """Join forces that are given by components to vectors; what is not known along all axes is none in others."""
    dimension = max((one.values.shape[-1] for one in figures.values() if one.what == "position"), default=0)
    dimension = dimension or max(
        (one.values.shape[-1] for one in figures.values() if one.what == "acceleration"), default=0
    )
    for key in [key for key in figures if key.endswith(".x") and key.split(":")[0] in ("column", "start")]:
        stem = key[:-1]
        parts = [figures.pop(stem + axis) for axis in "xyz" if stem + axis in figures]
        if len(parts) < dimension:
            continue
        values = np.stack([part.values.reshape(len(part.values)) for part in parts], axis=1)
        error = float(np.hypot.reduce([part.error for part in parts]))
        figures[stem + "vector"] = Figure(values, parts[0].unit, error, "vector", parts[0].owner)
