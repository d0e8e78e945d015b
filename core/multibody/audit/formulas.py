"""Formulas of the motion by plain arithmetic of doubles: what their names mean in a placement and its motion.

A function of several pieces has the piece that follows. Where its argument is zero, that is decided by the rate of the
argument, which a placement and a motion that are moved by an imaginary step carry with them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from core.formulas import Arithmetic, Node, names_of, value_of
from core.multibody.audit.placement import STEP, Motion, Numbers, Place, Placement, angle, spin_of
from core.multibody.language.motion_formulas import LENGTH, TIME, TURNS, motion_formula
from core.multibody.language.numerals import Numerals
from core.multibody.language.switches import SWITCHING, argument_of, switches_of

Read = Callable[[Placement, Motion], Numbers]
"""From a placement and its motion to what a name stands for, shape ()."""

SHARE = 2.0**-20
"""Share of an input by which it is moved to see its effect: the effect is then known to some 1e-6 of itself."""


ZERO_SHARE = 2.0**-48
"""Share of its terms up to which an argument is zero: a dozen roundings of doubles."""

OF_SECOND_ORDER = 2.0**-800
"""Size below which a real part is one that squares of imaginary steps of 2^-450 leave."""


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
        "atan2": lambda y, x: angle(x, y),
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

    def value_with(self, given: Mapping[str, Numbers], placement: Placement) -> Numbers:
        """Return the value with some inputs in place of those that a placement has, shape ()."""
        others = {name: np.asarray(read(placement, {})) for name, read in self.inputs.items() if name not in given}
        return self._of({**others, **{name: value for name, value in given.items() if name in self.inputs}})

    def slope(self, name: str, placement: Placement) -> Numbers:
        """Return the change of the value by that of an input alone, shape ()."""
        if name not in self.inputs:
            return np.zeros(())
        value = np.asarray(self.inputs[name](placement, {}))
        found: Numbers = self.value_with({name: value.real + 1j * STEP}, placement).imag / STEP
        return found

    def size(self, placement: Placement, size: float, speed: float) -> Numbers:
        """Return how large the terms are in which the inputs enter, at states of some size and speed."""
        still: Motion = {}
        base = {name: np.asarray(read(placement, still)) for name, read in self.inputs.items()}
        total: Numbers = np.zeros(())
        for name, value in base.items():
            scale = speed if name in self.rates else np.abs(value) + size
            moved = self._of({**base, name: value + SHARE * scale})
            if np.isnan(moved).any():
                # At an end of its domain it has values on one side.
                moved = np.where(np.isnan(moved), self._of({**base, name: value - SHARE * scale}), moved)
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

    @cached_property
    def switches(self) -> bool:
        """Whether it has functions of several pieces."""
        return next(switches_of(self.root), None) is not None

    def undecided(self, placement: Placement, motion: Motion) -> Numbers:
        """Return whether neither an argument of a function of several pieces nor its rate tells the piece, shape ()."""
        inputs = {name: np.asarray(read(placement, motion)) for name, read in self.inputs.items()}
        pieces = _Pieces({**self._numbers(), **inputs})
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            pieces.value(self.root)
        return pieces.undecided

    def _numbers(self) -> dict[str, Numbers]:
        return {name: np.array(number) for name, number in self.numbers.items()}

    def _of(self, inputs: Mapping[str, Numbers], root: Node | None = None) -> Numbers:
        names, own = {**self._numbers(), **inputs}, self.root if root is None else root
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            return _Pieces(names).value(own) if self.switches else value_of(own, names, _DOUBLES)


class _Pieces:
    """Evaluates a formula, each function of several pieces on the piece that follows.

    Attributes
    ----------
    undecided : ndarray of bool
        Whether an argument is zero, and so is its rate as far as that is known, and pieces differ there.
    """

    def __init__(self, names: Mapping[str, Numbers]) -> None:
        self.names = dict(names)
        self.undecided: Numbers = np.zeros((), dtype=bool)

    def value(self, root: Node) -> Numbers:
        """Return the value of a formula."""
        return value_of(self._settled(root), self.names, _DOUBLES)

    def _settled(self, node: Node) -> Node:
        """Return a formula in which functions of several pieces are names of their values."""
        node = replace(node, inner=tuple(self._settled(inner) for inner in node.inner))
        if node.kind not in SWITCHING:
            return node
        side = self._side(argument_of(node))
        values = [value_of(inner, self.names, _DOUBLES) for inner in node.inner]
        found: Numbers = side
        match node.kind:
            case "abs":
                found = side * values[0]
            case "sign":
                self.undecided = self.undecided | (side == 0.0)
            case "if":
                found = np.where(side > 0.0, values[1], values[2])
                self.undecided = self.undecided | ((side == 0.0) & (values[1] != values[2]))
            case _:
                first = side > 0.0 if node.kind == "max" else side <= 0.0
                found = np.where(first, *values)
        # No name of a formula has such a character.
        name = f"#{len(self.names)}"
        self.names[name] = found
        return Node("name", name)

    def _side(self, argument: Node) -> Numbers:
        """Return the sign that an argument has just after: where it is zero, that of its rate; zero if that is, too."""
        value = value_of(argument, self.names, _DOUBLES)
        sizes = [abs(value)] if argument.kind in ("name", "number") else []
        for name in names_of(argument):
            own = self.names[name]
            moved = {**self.names, name: own * (1.0 + SHARE)}
            sizes.append(abs(value_of(argument, moved, _DOUBLES) - value) / SHARE)
        size = sum(sizes, np.zeros(()))
        known = abs(value.real) > np.maximum(ZERO_SHARE * size, OF_SECOND_ORDER)
        side = np.where(known, np.sign(value.real), np.sign(value.imag))
        return np.asarray(side)


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
