"""Recognised mistakes: what a figure comes out as if it is computed wrongly in a known way.

An entry computes the wrong values from the question itself: from the right value alone, from another figure of the same
answer, or by asking a changed question. A submitted value that is not accepted is compared with each of them by the
same comparison. Where several agree with it, all are named.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.assessment.compare import Reference, compare, tolerance_of
from core.assessment.comparisons import Comparison, Interval
from core.assessment.propagation import Evaluate
from core.errors import InvalidParameter, Path


@dataclass(frozen=True, eq=False)
class Figure:
    """A figure of an answer, and the question that it answers.

    Attributes
    ----------
    subject : str
        Last steps of the endpoint's path: ``"rotation/precession"``, ``"scenes/rod-in-hole"``.
    request : Any
        As it was sent.
    path : tuple of str and int
        Of the figure in the answer.
    reference : Reference
    evaluate : callable
        Asks a changed question.
    """

    subject: str
    request: Any
    path: Path
    reference: Reference
    evaluate: Evaluate

    @property
    def name(self) -> str:
        """Last step of the path that is no index."""
        return next((step for step in reversed(self.path) if isinstance(step, str)), "")

    @property
    def right(self) -> Any:
        """The right value."""
        return self.reference.value

    def beside(self, *path: str | int) -> Any:
        """Return another figure of the same answer, None where there is none."""
        return self.evaluate(self.request)(path)

    def answered(self, request: Any) -> Any:
        """Return this figure of the answer to a changed question, None where there is none."""
        return self.evaluate(request)(self.path)


@dataclass(frozen=True)
class Mistake:
    """One entry of the catalogue.

    Attributes
    ----------
    tag : str
        Stable; also the key of the feedback (`core.assessment.feedback`), a sentence that gives no number.
    summary : str
        What was done.
    credit : float
        Share of the score, from 0 to 1.
    wrong : callable
        From a figure to the values that the mistake gives.
    """

    tag: str
    summary: str
    wrong: Callable[[Figure], Iterable[Any]] = field(repr=False)
    credit: float = 0.0


SOME = 16
"""Samples that are compared with those of every mistake before all samples are compared with the few left."""


SHARE = 0.2
"""Of the error of samples, that a mistake which explains them may leave."""


class Band(NamedTuple):
    """Wrong values of every mistake, and how near to each a value has to be.

    Attributes
    ----------
    mistakes : tuple of Mistake
    values : ndarray, shape (k,) or (k, n, m)
        Numbers, or samples.
    tolerances : ndarray, shape (k,)
    some : ndarray of int
        Samples that tell most of them apart.
    """

    mistakes: tuple[Mistake, ...]
    values: Floats
    tolerances: Floats
    some: NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class WrongValues:
    """What every entry makes of one figure: computed once, for all submissions.

    Attributes
    ----------
    figure : Figure
    catalogue : tuple of Mistake
    """

    figure: Figure
    catalogue: tuple[Mistake, ...]
    bands: dict[Comparison | None, Band] = field(default_factory=dict, init=False, repr=False)

    @cached_property
    def entries(self) -> tuple[tuple[Mistake, Reference], ...]:
        """The mistakes that give another value than the right one, with those values."""
        return tuple(self._entries())

    def _entries(self) -> Iterator[tuple[Mistake, Reference]]:
        right = self.figure.reference
        # Modulo turns, multiples of an angle would agree by chance.
        right = replace(right, form="number") if right.form == "angle" else right
        for mistake in self.catalogue:
            for value in mistake.wrong(self.figure):
                if value is None or (not isinstance(value, bool | str) and not np.isfinite(value).all()):
                    continue
                # Of samples the scale is what the tolerance is a share of: nothing is near those that are far smaller.
                least = min(right.scale, float(np.abs(value).max())) if right.form == "samples" else right.scale
                wrong = replace(right, value=value, scale=least, error=0.0, inherited=0.0)
                yield mistake, wrong

    def matching(self, value: Any, comparison: Comparison | None) -> tuple[Mistake, ...]:
        """Return the mistakes by which a value comes out that is not accepted, in the unit of the reference."""
        # Limits say nothing of how near two values are.
        near = None if isinstance(comparison, Interval) else comparison
        if self.figure.reference.form in ("number", "angle", "samples"):
            agreeing = self._within(value, self.figure.right, self._band(near))
        else:
            agreeing = [mistake for mistake, wrong in self.entries if _agree(wrong, value, near)]
        return tuple({mistake.tag: mistake for mistake in agreeing}.values())

    @staticmethod
    def _within(value: Any, right: Any, band: Band) -> list[Mistake]:
        if not band.mistakes:
            return []
        # Differences that overflow are not near, and those of infinite ones no number.
        with np.errstate(over="ignore", invalid="ignore"):
            if band.values.ndim == 1:
                near = np.flatnonzero(np.abs(band.values - value) <= band.tolerances)
            else:
                near = np.flatnonzero(_largest(band.values[:, band.some] - value[band.some]) <= band.tolerances)
                near = near[_largest(band.values[near] - value) <= band.tolerances[near]]
                if near.size:
                    # Samples that are hardly wrong are within the tolerance of much that is hardly wrong.
                    error = _largest((value - right)[None])[0]
                    near = near[_largest(band.values[near] - value) <= SHARE * error]
        return [band.mistakes[k] for k in near]

    def _band(self, comparison: Comparison | None) -> Band:
        if comparison not in self.bands:
            mistakes = tuple(mistake for mistake, _ in self.entries)
            values = np.array([wrong.value for _, wrong in self.entries], dtype=np.float64)
            tolerances = np.array([tolerance_of(wrong, comparison) for _, wrong in self.entries])
            count = values.shape[1] if values.ndim > 1 else 0
            some = np.unique(np.linspace(0, max(0, count - 1), min(count, SOME)).astype(np.intp))
            self.bands[comparison] = Band(mistakes, values, tolerances, some)
        return self.bands[comparison]


def _largest(apart: Floats) -> Floats:
    """Return the largest norm of any sample's difference, shape (k,), of differences (k, n, m) or (k, n)."""
    sizes: Floats = np.abs(apart).max(axis=tuple(range(1, apart.ndim)), initial=0.0)
    if apart.ndim < 3:
        return sizes
    # Squares of what is far from one would overflow, or vanish.
    units = apart / np.where(sizes > 0.0, sizes, 1.0)[:, None, None]
    largest: Floats = sizes * np.sqrt(np.einsum("knm,knm->kn", units, units).max(axis=1, initial=0.0))
    return largest


def _agree(wrong: Reference, value: Any, comparison: Comparison | None) -> bool:
    try:
        return compare(wrong, value, comparison).verdict == "correct"
    except InvalidParameter:
        return False
