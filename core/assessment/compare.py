"""One submitted quantity compared with the reference: the error, and whether it is within the tolerance.

How the error is measured depends on the form of the quantity:

number, vector, matrix    largest difference of any entry
angle                     difference modulo whole turns (rad)
attitude                  angle of the turn between the two; q and -q are one attitude (rad)
direction                 largest difference of any entry, of unit vectors up to sign
axes                      largest difference of any entry of the projections on the principal axes: columns up to sign,
                          and up to rotation among axes whose moments are equal
set                       largest difference of any entry, in the best pairing of the members
choice                    none: equal or not
samples                   largest norm of the difference of any sample
curve                     largest distance of any point of either closed curve from the other
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import permutations
from math import inf, isfinite, pi
from typing import Any, Literal

import numpy as np

from core.arrays import Floats
from core.assessment.comparisons import Comparison, Interval, RelAbs
from core.assessment.curves import separation
from core.assessment.feedback.languages import Sentence
from core.errors import InvalidParameter

Form = Literal[
    "number", "vector", "matrix", "angle", "attitude", "direction", "axes", "set", "choice", "samples", "curve", "none"
]
Verdict = Literal["correct", "incorrect", "carried", "missing-unit", "wrong-unit", "not-gradable", "unreadable"]

LEAST_OF_A_CURVE, MOST_OF_A_CURVE = 8, 2000
"""Points of a submitted curve."""

MOST_OF_A_SET = 6
"""Members of a set: all their orders are tried."""

LARGEST = np.finfo(np.float64).max.item()


@dataclass(frozen=True, eq=False)
class Reference:
    """What is right, and how well it is known.

    Attributes
    ----------
    value : float, bool, str, None or ndarray
        None where the motion has no such figure.
    unit : str
        SI unit, "1" for a pure number.
    form : Form
        How submitted values are compared with it.
    scale : float
        Characteristic magnitude of such quantities in the question.
    error : float
        Bound, or estimate, of the numerical error, in the unit.
    how : str
        What the error rests on.
    inherited : float or None
        What the uncertainty of the question's data may change, in the unit; None where it is not known.
    groups : tuple of tuple of int
        Of axes: columns whose moments are equal.
    offset : float
        What is to be subtracted to have the figure in which errors show: 1 for an axis ratio near 1.
    sensitive : str or None
        Name of that figure.
    body_axis : int or None
        1, 2 or 3: the body axis that the figure belongs to.
    """

    value: Any
    unit: str = "1"
    form: Form = "number"
    scale: float = 0.0
    error: float = 0.0
    how: str = "exact"
    inherited: float | None = 0.0
    groups: tuple[tuple[int, ...], ...] = ()
    offset: float = 0.0
    sensitive: str | None = None
    body_axis: int | None = None
    magnitude: float = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "magnitude", _magnitude(self.value, self.form, self.scale))

    @property
    def known(self) -> float:
        """How far the stated value may be from the true one; infinite where nothing is known (in the unit)."""
        return inf if self.inherited is None else self.error + self.inherited


@dataclass(frozen=True)
class Judgement:
    """What becomes of one submitted quantity.

    Attributes
    ----------
    verdict : Verdict
    absolute : float or None
        Error in the unit of the reference; None where it has no size.
    relative : float or None
        Error over the largest magnitude of the reference; None where that is 0.
    in_tolerances : float or None
        Error over the tolerance.
    tolerance : float or None
        Largest error that is accepted; None for choices and intervals.
    sensitive_error : float or None
        Relative error of the sensitive figure, where the reference has one.
    """

    verdict: Verdict
    absolute: float | None = None
    relative: float | None = None
    in_tolerances: float | None = None
    tolerance: float | None = None
    sensitive_error: float | None = None

    @property
    def correct(self) -> bool | None:
        """Whether the quantity is right; None if that cannot be said."""
        return None if self.verdict == "not-gradable" else self.verdict == "correct"


DEFAULT = RelAbs()


def compare(reference: Reference, value: Any, comparison: Comparison | None = None) -> Judgement:
    """Compare a submitted value, in the unit of the reference, with the reference.

    Parameters
    ----------
    reference : Reference
    value : float, bool, str, None or ndarray
        Finite.
    comparison : Comparison, optional
        By default 1 % of the reference; of its sensitive figure, where it has one.

    Raises
    ------
    InvalidParameter
        If the value has not the form of the reference; its path leads from the value.
    """
    if reference.form in ("choice", "none") or value is None:
        if value is not None and reference.form == "choice" and type(value) is not type(reference.value):
            raise InvalidParameter((), f"be {_KINDS[type(reference.value)]}")
        same = type(value) is type(reference.value) and value == reference.value
        return Judgement("correct" if same else "incorrect")
    error = distance(reference, value)
    sensitive = None
    if reference.sensitive is not None and reference.value != reference.offset:
        sensitive = _finite(error / abs(reference.value - reference.offset))
    relative = _finite(error / reference.magnitude) if reference.magnitude > 0.0 else None
    if isinstance(comparison, Interval):
        return _within(comparison, reference, value, error, relative, sensitive)
    tolerance = tolerance_of(reference, comparison)
    if not isfinite(tolerance) or not tolerance > 0.0 or tolerance < reference.known:
        verdict: Verdict = "correct" if error == 0.0 and reference.known == 0.0 else "not-gradable"
        if error > 0.0 and reference.known == 0.0:
            verdict = "incorrect"
        return Judgement(verdict, error, relative, None, _finite(tolerance), sensitive)
    verdict = "correct" if error <= tolerance else "incorrect"
    return Judgement(verdict, error, relative, _finite(error / tolerance), tolerance, sensitive)


def tolerance_of(reference: Reference, comparison: Comparison | None) -> float:
    """Return the largest error that a comparison accepts, in the unit of the reference.

    Without a comparison it is 1 % of the sensitive figure, where the reference has one, otherwise of the reference.
    """
    if comparison is not None:
        return comparison.tolerance(reference.magnitude, reference.scale, reference.known)
    sensitive = reference.sensitive is not None
    size = abs(reference.value - reference.offset) if sensitive else reference.magnitude
    return DEFAULT.tolerance(size, size if sensitive else reference.scale, reference.known)


def distance(reference: Reference, value: Any) -> float:
    """Return the error of a value, as its form measures it, in the unit of the reference.

    Raises
    ------
    InvalidParameter
        If the value has not the form of the reference; its path leads from the value.
    """
    if reference.form in ("number", "angle"):
        if type(value) not in (float, int):
            raise InvalidParameter((), "be a number")
        apart = abs(float(value) - reference.value)
        if reference.form == "angle":
            apart %= 2.0 * pi
            apart = min(apart, 2.0 * pi - apart)
        return _bounded(apart)
    right: Floats = reference.value
    curve = reference.form == "curve"
    fits = isinstance(value, np.ndarray) and value.shape[curve:] == right.shape[curve:] and value.ndim == right.ndim
    if not fits or (curve and not LEAST_OF_A_CURVE <= len(value) <= MOST_OF_A_CURVE):
        rows = f"{LEAST_OF_A_CURVE} to {MOST_OF_A_CURVE} rows of {right.shape[-1]} numbers"
        raise InvalidParameter((), f"be an array of {rows}" if curve else _shape(right))
    with np.errstate(over="ignore", invalid="ignore"):
        return _bounded(_DISTANCES[reference.form](value, right, reference))


def exchanged(rows: Floats, right: Floats) -> Sentence:
    """Return how axes are exchanged in samples that are right but for their order."""
    order = min(permutations(range(3)), key=lambda order: float(np.abs(rows - right[:, list(order)]).max()))
    moved = [k + 1 for k in range(3) if order[k] != k]
    if len(moved) == 2:
        return Sentence("axes-exchanged", {"one": str(moved[0]), "other": str(moved[1])})
    return Sentence("axes-order", {"order": ", ".join(str(k + 1) for k in order)})


def _entries(value: Floats, right: Floats, reference: Reference) -> float:
    return float(np.abs(value - right).max(initial=0.0))


def _samples(value: Floats, right: Floats, reference: Reference) -> float:
    return float(norms(value - right if value.ndim > 1 else (value - right)[:, None]).max(initial=0.0))


def norms(rows: Floats) -> Floats:
    """Return the lengths of rows, at most the largest double: runs with far too long steps grow beyond all bounds."""
    with np.errstate(over="ignore", invalid="ignore"):
        size = float(np.abs(rows).max(initial=0.0))
        if 1e-100 < size < 1e100:
            plain: Floats = np.sqrt(np.einsum("ij,ij->i", rows, rows))
            return plain
        sizes = np.abs(rows).max(axis=1)
        units = np.where(sizes > 0.0, sizes, 1.0)
        lengths: Floats = np.nan_to_num(units * np.sqrt(((rows / units[:, None]) ** 2).sum(axis=1)), nan=LARGEST)
    return lengths


def _curve(value: Floats, right: Floats, reference: Reference) -> float:
    return separation(value, right)


def _direction(value: Floats, right: Floats, reference: Reference) -> float:
    unit = _unit(value)
    return float(min(np.abs(unit - right).max(), np.abs(unit + right).max()))


def _attitude(value: Floats, right: Floats, reference: Reference) -> float:
    one, other = _unit(value), _unit(right)
    chord = min(float(np.linalg.norm(one - other)), float(np.linalg.norm(one + other)))
    return 4.0 * float(np.arcsin(min(1.0, chord / 2.0)))


def _axes(value: Floats, right: Floats, reference: Reference) -> float:
    columns = [_unit(value[:, k], k) for k in range(3)]
    worst = 0.0
    for group in reference.groups or ((0,), (1,), (2,)):
        spanned = [np.outer(columns[k], columns[k]) for k in group]
        wanted = [np.outer(right[:, k], right[:, k]) for k in group]
        worst = max(worst, float(np.abs(sum(spanned) - sum(wanted)).max()))
    return worst


def _set(value: Floats, right: Floats, reference: Reference) -> float:
    if len(right) > MOST_OF_A_SET:
        raise InvalidParameter((), f"be a set of at most {MOST_OF_A_SET} members")
    apart = np.abs(value[:, None] - right[None, :]).reshape(len(right), len(right), -1).max(axis=2)
    return float(min(apart[range(len(right)), order].max() for order in _orders(len(right))))


@lru_cache(16)
def _orders(count: int) -> tuple[list[int], ...]:
    return tuple(list(order) for order in permutations(range(count)))


_DISTANCES = {
    "vector": _entries,
    "matrix": _entries,
    "samples": _samples,
    "curve": _curve,
    "direction": _direction,
    "attitude": _attitude,
    "axes": _axes,
    "set": _set,
}


def _unit(vector: Floats, *place: int) -> Floats:
    length = float(np.linalg.norm(vector))
    if not (length > 0.0 and isfinite(length)):
        raise InvalidParameter(place, "have a direction: not every entry may be 0")
    return vector / length


def _within(
    limits: Interval, reference: Reference, value: Any, error: float, relative: float | None, sensitive: float | None
) -> Judgement:
    if reference.form not in ("number", "angle"):
        raise InvalidParameter((), "be a single number where an interval is given")
    # Limits that exclude what is right, or may exclude it, decide nothing.
    low, high = reference.value - reference.known, reference.value + reference.known
    if not limits.lower <= low <= high <= limits.upper:
        return Judgement("not-gradable", error, relative, None, None, sensitive)
    inside = limits.lower <= value <= limits.upper
    return Judgement("correct" if inside else "incorrect", error, relative, None, None, sensitive)


def _magnitude(value: Any, form: Form, scale: float) -> float:
    if form in ("attitude", "direction", "axes"):
        return 1.0
    if form == "samples":
        return scale
    if isinstance(value, np.ndarray):
        return float(np.abs(value).max(initial=0.0))
    return abs(float(value)) if isinstance(value, (int, float)) else 0.0


def _bounded(number: float) -> float:
    # A difference that overflows is as wrong as any number can be.
    return number if isfinite(number) else LARGEST


def _finite(number: float) -> float | None:
    return number if isfinite(number) else None


_KINDS: dict[type, str] = {bool: "true or false", str: "a string"}


def _shape(right: Floats) -> str:
    counts: Sequence[int] = right.shape
    if len(counts) == 1:
        return f"be an array of {counts[0]} numbers"
    return f"be an array of {counts[0]} rows of {counts[1]} numbers"
