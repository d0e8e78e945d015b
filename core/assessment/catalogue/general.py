"""Mistakes that any figure may suffer: factors, signs, units, the order of components."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import permutations
from math import pi, sqrt
from typing import Any

import numpy as np

from core.assessment.mistakes import Figure, Mistake

SIGNED = ("number", "angle", "vector", "matrix", "samples", "set", "curve")
"""Forms in which a multiple of the right value is another value."""


def times(factor: float, *units: str) -> Callable[[Figure], Iterator[Any]]:
    """Return what multiplies the right value, of figures in some units or, without units, of all."""

    def wrong(figure: Figure) -> Iterator[Any]:
        if figure.reference.form in SIGNED and (not units or figure.reference.unit in units):
            yield figure.right * factor

    return wrong


def _thousand(figure: Figure) -> Iterator[Any]:
    for factor in (1e3, 1e-3):
        yield from times(factor)(figure)


def _square(figure: Figure) -> Iterator[Any]:
    if figure.reference.form == "number":
        yield figure.right * figure.right


def _root(figure: Figure) -> Iterator[Any]:
    if figure.reference.form == "number" and figure.right > 0.0:
        yield sqrt(figure.right)


def _reciprocal(figure: Figure) -> Iterator[Any]:
    if figure.reference.form == "number" and figure.right != 0.0:
        yield 1.0 / figure.right


def _permuted(figure: Figure) -> Iterator[Any]:
    right = figure.right
    if figure.reference.form in ("vector", "direction") and 1 < len(right) <= 3:
        for order in permutations(range(len(right))):
            if list(order) != sorted(order):
                yield right[list(order)]
    elif figure.reference.form in ("samples", "axes", "curve") and right.ndim == 2 and right.shape[1] in (2, 3):
        for order in permutations(range(right.shape[1])):
            if list(order) != sorted(order):
                yield right[:, list(order)]


def _transposed(figure: Figure) -> Iterator[Any]:
    if figure.reference.form == "axes":
        yield figure.right.T
    if figure.reference.form == "attitude":
        yield figure.right * np.array([1.0, -1.0, -1.0, -1.0])


def _scalar_last(figure: Figure) -> Iterator[Any]:
    if figure.reference.form == "attitude":
        yield np.roll(figure.right, -1)


GENERAL = (
    Mistake("sign", "The opposite sign.", times(-1.0), credit=0.5),
    Mistake("factor-2", "Twice the value.", times(2.0)),
    Mistake("factor-half", "Half the value.", times(0.5)),
    Mistake("factor-2-pi", "2 pi times the value.", times(2.0 * pi)),
    Mistake("factor-1-over-2-pi", "The value over 2 pi.", times(0.5 / pi)),
    Mistake("degrees", "An angle or a rate in degrees.", times(180.0 / pi, "rad", "rad s^-1", "rad s^-2"), credit=0.5),
    Mistake("rpm", "A rate in revolutions per minute.", times(30.0 / pi, "rad s^-1"), credit=0.5),
    Mistake("factor-1000", "A power of ten of a prefix: grams, millimetres, milliseconds.", _thousand, credit=0.5),
    Mistake("squared", "The square.", _square),
    Mistake("root", "The root of the value.", _root),
    Mistake("reciprocal", "One over the value.", _reciprocal),
    Mistake("permuted-axes", "The components in another order.", _permuted, credit=0.5),
    Mistake(
        "transposed-rotation", "The rotation from space to body, or the transposed matrix.", _transposed, credit=0.5
    ),
    Mistake("scalar-last", "A quaternion with the scalar part at the end.", _scalar_last, credit=0.5),
)
