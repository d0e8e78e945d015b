"""A law: a formula whose value pushes coordinates of a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from core.errors import Path
from core.formulas import Node
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, evaluated, substituted


@dataclass(frozen=True)
class Input:
    """What a name of a formula stands for: an affine polynomial of the coordinates, or its rate.

    Attributes
    ----------
    form : polynomial
    rate : bool
    """

    form: Poly
    rate: bool = False

    def coordinates(self) -> set[int]:
        """Return the coordinates that occur."""
        return {key[0] for key in self.form if key}

    def value(self, q: Sequence[Ball], v: Sequence[Ball]) -> Ball:
        """Return the value at a state."""
        if not self.rate:
            return evaluated(self.form, q)
        return sum((x * v[key[0]] for key, x in self.form.items() if key), ZERO)


@dataclass(frozen=True)
class Law:
    """A formula, and the direction of the generalised force that its value is.

    Attributes
    ----------
    name : str
        Of the connection.
    path : path
        Of the formula in the description.
    root : Node
    inputs : mapping of str to Input
        What its names stand for, but those that are numbers.
    numbers : mapping of str to ball
    push : mapping of int to ball
        Force on each coordinate where the value is one.
    in_table : bool
        Whether its forces are entries of b and D, so that only its value is of interest.
    scale : ball
        Constant factor of what was written, which stands in the push: with it the formula is a force again.
    """

    name: str
    path: Path
    root: Node
    inputs: Mapping[str, Input]
    numbers: Mapping[str, Ball] = field(default_factory=dict)
    push: Mapping[int, Ball] = field(default_factory=dict)
    in_table: bool = False
    scale: Ball = ONE

    def coordinates(self) -> set[int]:
        """Return the coordinates that it depends on or pushes."""
        return set(self.push).union(*(one.coordinates() for one in self.inputs.values()))

    def along(self, expressions: Sequence[Poly]) -> Law:
        """Return the law in other coordinates, of which the present ones are affine functions."""
        inputs = {name: Input(substituted(one.form, expressions), one.rate) for name, one in self.inputs.items()}
        push: dict[int, Ball] = {}
        for j, factor in self.push.items():
            for key, slope in expressions[j].items():
                if key:
                    push[key[0]] = push.get(key[0], ZERO) + factor * slope
        return replace(self, inputs=inputs, push={i: x for i, x in push.items() if 0 not in x})

    def renumbered(self, number: Mapping[int, int]) -> Law:
        """Return the law with coordinates under other numbers."""
        inputs = {
            name: Input({tuple(number[i] for i in key): x for key, x in one.form.items()}, one.rate)
            for name, one in self.inputs.items()
        }
        return replace(self, inputs=inputs, push={number[i]: x for i, x in self.push.items()})
