"""Formulas of the motion by plain arithmetic of doubles: what their names mean in a placement and its motion."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from core.formulas import Arithmetic, Node, value_of
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, spin_of
from core.multibody.language.motion_formulas import LENGTH, TIME, TURNS, motion_formula
from core.multibody.language.numerals import Numerals

Read = Callable[[Placement, Motion], Numbers]
"""From a placement and its motion to what a name stands for, shape ()."""

SHARE = 2.0**-20
"""Share of an input by which it is moved to see its effect: the effect is then known to some 1e-6 of itself."""


def _chosen(condition: Numbers, one: Numbers, other: Numbers) -> Numbers:
    """Return one value where a condition is positive, and else another."""
    found: Numbers = np.where(condition > 0.0, one, other)
    return found


_DOUBLES = Arithmetic[Numbers](
    lambda text: np.array(float(text)),
    lambda: np.array(np.pi),
    np.divide,
    np.power,
    {
        "sqrt": np.sqrt,
        "sin": np.sin,
        "cos": np.cos,
        "tan": np.tan,
        "asin": np.arcsin,
        "acos": np.arccos,
        "atan": np.arctan,
        "sinh": np.sinh,
        "cosh": np.cosh,
        "tanh": np.tanh,
        "exp": np.exp,
        "log": np.log,
        "atan2": np.arctan2,
        "abs": np.abs,
        "sign": np.sign,
        "min": np.minimum,
        "max": np.maximum,
        "if": _chosen,
        LENGTH: lambda *vector: np.sqrt(sum(x * x for x in vector)),
    },
)

_BOUNDED = ("sin", "cos", "exp", "sinh", "cosh", "tanh", "tan", "atan")
"""Functions by whose arguments a formula may swing or grow."""


def by_time(value: object, numerals: Numerals, start: Placement, path: tuple[str | int, ...]) -> FormulaValue | None:
    """Return a formula of time alone; None for a number."""
    found = motion_formula(value, numerals, (), (), path)
    if found is None:
        return None
    numbers = {name: float(number) for name, number in numerals.let.items()}
    return FormulaValue(found.root, numbers, {TIME: time_of}, frozenset(), start)


@dataclass(frozen=True)
class MovingPlace(Place):
    """A point of the ground that moves as formulas of time say; its offset is its place at the start.

    Attributes
    ----------
    components : tuple of FormulaValue
    """

    components: tuple[FormulaValue, ...]

    @property
    def quickness(self) -> float | None:
        """See `Place.quickness`."""
        return max(one.quickness(0.0) for one in self.components)

    def at(self, placement: Placement) -> Numbers:
        """See `Place.at`."""
        return np.stack(np.broadcast_arrays(*(one.value(placement, {}) for one in self.components)), axis=-1)


@dataclass(frozen=True)
class FormulaValue:
    """A formula, and what its names stand for.

    Attributes
    ----------
    root : Node
    numbers : mapping of str to float
    inputs : mapping of str to callable
    rates : frozenset of str
        Names of inputs that are rates.
    start : mapping of str to Pose
        Where all bodies are at the start.
    """

    root: Node
    numbers: Mapping[str, float]
    inputs: Mapping[str, Read]
    rates: frozenset[str]
    start: Placement

    @classmethod
    def constant(cls, number: float, start: Placement) -> FormulaValue:
        """Return a number."""
        return cls(Node("number", repr(number)), {}, {}, frozenset(), start)

    def value(self, placement: Placement, motion: Motion) -> Numbers:
        """Return the value, shape ()."""
        return self._of({name: np.asarray(read(placement, motion)) for name, read in self.inputs.items()})

    def size(self, placement: Placement, size: float, speed: float) -> Numbers:
        """Return how large the terms are in which the inputs enter, at states of some size and speed."""
        still: Motion = {}
        base = {name: np.asarray(read(placement, still)) for name, read in self.inputs.items()}
        total: Numbers = np.zeros(())
        for name, value in base.items():
            scale = speed if name in self.rates else np.abs(value) + size
            moved = self._of({**base, name: value + SHARE * scale})
            total = total + np.abs(moved - self._of(base)) / SHARE
        return total

    def quickness(self, mass: float) -> float:
        """Return the largest rate (rad/s) that it has at the start by itself, or gives to a mass or inertia."""
        still: Motion = {}
        base = {name: np.asarray(read(self.start, still)) for name, read in self.inputs.items()}
        found = 0.0
        for name, value in base.items():
            step = SHARE * (1.0 + float(np.max(np.abs(value), initial=0.0)))
            moved = {**base, name: value + step}
            slope = float(np.max(np.abs(self._of(moved) - self._of(base)), initial=0.0)) / step
            if name == "t":
                arguments = [inner for node in _nodes(self.root) if node.kind in _BOUNDED for inner in node.inner]
                changes = [np.abs(self._of(moved, one) - self._of(base, one)) / step for one in arguments]
                found = max([found, *(float(np.max(change, initial=0.0)) for change in changes)])
            elif mass > 0.0:
                found = max(found, slope / mass if name in self.rates else float(np.sqrt(slope / mass)))
        return found if np.isfinite(found) else 0.0

    def _of(self, inputs: Mapping[str, Numbers], root: Node | None = None) -> Numbers:
        names = {name: np.array(number) for name, number in self.numbers.items()}
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            return value_of(self.root if root is None else root, {**names, **inputs}, _DOUBLES)


def _nodes(node: Node) -> Iterator[Node]:
    yield node
    for inner in node.inner:
        yield from _nodes(inner)


def time_of(placement: Placement, motion: Motion) -> Numbers:
    """Return the seconds from the start, shape ()."""
    time = next(iter(placement.values())).time
    assert time is not None, "samples know their time"
    return time


def names_of_place(place: Place) -> dict[str, Read]:
    """Return what the names of a place stand for."""
    found: dict[str, Read] = {}
    for i, axis in zip(range(len(place.offset)), "xyz", strict=False):
        found[axis] = lambda placement, _, i=i: place.at(placement)[..., i]  # type: ignore[misc]
        found[f"v{axis}"] = lambda placement, motion, i=i: place.velocity(placement, motion)[..., i]  # type: ignore[misc]
    return found


def names_of_turn(body: str) -> dict[str, Read]:
    """Return what the names of the turn of a body of the plane stand for."""

    def angle(placement: Placement, _: Motion) -> Numbers:
        turn = placement[body].turn
        assert turn is not None, "a formula names the turn of a body that has one"
        return turn

    return {name: (lambda _, motion: np.asarray(spin_of(motion, body))) if name == "rate" else angle for name in TURNS}
