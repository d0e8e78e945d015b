"""Error of an answer that is propagated from the uncertainty of the question's numbers, for any question.

Each number is changed by its relative uncertainty, one after the other, and the changes of a figure are added: the
first order of the worst case. A number whose change alone leaves no such figure (two equal moments of a symmetric body,
entries of a symmetric tensor) is changed together with the numbers beside it that equal it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from core.assessment.compare import Reference, distance
from core.errors import InvalidParameter, Path

MOST_CHANGED_NUMBERS = 40
"""Numbers that are changed one by one; more are changed together, each by a sign of its own, in `PATTERNS`."""
PATTERNS = 16

HALF_ULP = 2.0**-53
SEEN = 1e-7
"""Relative change in place of a smaller one, whose effect rounding would hide; the effect is scaled."""

WITHIN_ROUNDING = 2.0**-34
"""The same for described scenes: so little that what touches or fits together still does (1e-9)."""

SETTINGS = {"times", "accuracy", "method", "measure", "input_uncertainty", "outputs", "round", "resolution", "points"}
SETTINGS |= {"seed", "count", "turns"}
"""Fields of questions that are no data."""

Shares = tuple[tuple[Path, float], ...]
"""By how much of itself each of some numbers is changed."""

Evaluate = Callable[[Any], Callable[[Path], Any]]
"""From a request to what finds the value at a path of its answer, None where there is none."""


def numbers_of(request: Any, path: Path = (), *, zeros: bool = False) -> Iterator[tuple[Path, float]]:
    """Yield the numbers of a request that are data, with their paths; zeros, which have no relative size, if wanted."""
    if isinstance(request, Mapping):
        for name, entry in request.items():
            if name not in SETTINGS:
                yield from numbers_of(entry, (*path, name), zeros=zeros)
    elif isinstance(request, list):
        for i, entry in enumerate(request):
            yield from numbers_of(entry, (*path, i), zeros=zeros)
    elif type(request) in (int, float) and (zeros or request) and abs(request) <= sys.float_info.max:
        # Whole numbers beyond are refused where the question is answered.
        yield path, float(request)


def changed(request: Any, changes: Mapping[Path, float]) -> Any:
    """Return a copy of a request with other numbers at some paths."""
    copy = json.loads(json.dumps(request))
    for path, number in changes.items():
        inner = copy
        for step in path[:-1]:
            inner = inner[step]
        inner[path[-1]] = number
    return copy


def unrounded(request: Any) -> Any:
    """Return a request whose figures have all their digits, so that small changes are seen in them."""
    return {name: entry for name, entry in request.items() if name != "round"}


def at(document: Any, path: Path) -> Any:
    """Return what stands at a path of a document, None if nothing does."""
    for step in path:
        if isinstance(document, Mapping):
            document = document.get(step)
        elif isinstance(document, Sequence) and not isinstance(document, str) and isinstance(step, int):
            document = document[step] if step < len(document) else None
        else:
            return None
    return document


def relative_uncertainties(request: Any, given: float | Mapping[Path, float] | None) -> dict[Path, float]:
    """Return the relative uncertainty of every number of a request that has one.

    Parameters
    ----------
    given : float, mapping of path to float, or None
        Of every number; of those at some paths, the others being exact; by default half a unit in the last place.

    Raises
    ------
    InvalidParameter
        If there is no number at one of the paths; its path is that one.
    """
    if not isinstance(given, Mapping):
        share = HALF_ULP if given is None else given
        return {path: share for path, _ in numbers_of(request)}
    known = dict(numbers_of(request))
    found: dict[Path, float] = {}
    for path, share in given.items():
        within = [other for other in known if other[: len(path)] == path]
        if not within:
            raise InvalidParameter(path, "lead to a number of the request that is not 0")
        found |= dict.fromkeys(within, share)
    return found


@dataclass(frozen=True, eq=False)
class Propagation:
    """Answers to changed questions, each made once, for all figures of one question.

    Attributes
    ----------
    request : Any
        As it was sent.
    uncertainties : mapping of path to float
        Relative.
    evaluate : callable
        Asks a changed question; raises or finds None where there is no answer.
    connected : bool
        Whether numbers follow from others, as places do that connections hold. Then each is changed by
        `WITHIN_ROUNDING`, and one that cannot change, alone or with those that equal it, counts as exact.
    """

    request: Any
    uncertainties: Mapping[Path, float]
    evaluate: Evaluate
    connected: bool = False
    _moved: dict[tuple[Shares, float], Callable[[Path], Any]] = field(default_factory=dict, init=False)

    def of(self, path: Path, reference: Reference) -> float | None:
        """Return by how much the figure at a path of the answer may change (in its unit), None if that is not found."""
        if len(self._uncertain) > MOST_CHANGED_NUMBERS:
            effects = [self._effect(pattern, path, reference) for pattern in self._patterns]
            found = [effect for effect in effects if effect is not None]
            return max(found, default=0.0) if self.connected or len(found) == len(effects) else None
        total = 0.0
        done: set[Path] = set()
        for place, share in self._uncertain.items():
            if place in done:
                continue
            alone = self._effect(((place, share),), path, reference)
            if alone is None:
                together = [p for p in self._tied_to(place, path, reference) if p in self._uncertain]
                done.update(together)
                alone = self._effect(tuple((p, self._uncertain[p]) for p in together), path, reference)
            if alone is None and not self.connected:
                return None
            total += alone or 0.0
        return total

    @cached_property
    def _numbers(self) -> Mapping[Path, float]:
        return dict(numbers_of(self.request))

    @cached_property
    def _uncertain(self) -> Mapping[Path, float]:
        return {p: u for p, u in self.uncertainties.items() if u > 0.0 and p in self._numbers}

    @cached_property
    def _patterns(self) -> Sequence[Shares]:
        signs = np.random.default_rng(0).choice((-1.0, 1.0), (PATTERNS, len(self._uncertain))).tolist()
        return [
            tuple((place, share * sign) for (place, share), sign in zip(self._uncertain.items(), row, strict=True))
            for row in signs
        ]

    def _tied_to(self, place: Path, path: Path, reference: Reference) -> list[Path]:
        """Return the places of numbers that have to equal the one at a place, that one too."""
        if not self.connected:
            return _equal_beside(place, self._numbers)
        alike = [p for p in self._uncertain if abs(self._numbers[p]) == abs(self._numbers[place])]
        # A number that can change alone is equal by chance, and has an effect of its own.
        return [p for p in alike if self._effect(((p, self._uncertain[p]),), path, reference) is None]

    def _effect(self, shares: Shares, path: Path, reference: Reference) -> float | None:
        largest = max(abs(share) for _, share in shares)
        scaled = WITHIN_ROUNDING / largest if self.connected else max(1.0, SEEN / largest)
        worst = None
        for sign in (1.0, -1.0):
            value = self._answer(shares, sign * scaled)(path)
            if value is None:
                continue
            try:
                worst = max(worst or 0.0, distance(reference, value) / scaled)
            except InvalidParameter:
                continue
            if scaled != 1.0:
                # To first order the other direction has the same effect.
                break
        return worst

    def _answer(self, shares: Shares, scaled: float) -> Callable[[Path], Any]:
        """Return what finds figures of the answer with changes added, scaled."""
        if (shares, scaled) not in self._moved:
            moved = {p: self._numbers[p] * (1.0 + scaled * share) for p, share in shares}
            self._moved[shares, scaled] = self.evaluate(changed(self.request, moved))
        return self._moved[shares, scaled]


def _equal_beside(place: Path, numbers: Mapping[Path, float]) -> list[Path]:
    """Return the places, in the same array or matrix, of numbers that equal the one at a place, that one too."""
    depth = len(place)
    while depth and isinstance(place[depth - 1], int):
        depth -= 1
    return [p for p, number in numbers.items() if p[:depth] == place[:depth] and number == numbers[place]]
