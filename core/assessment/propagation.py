"""Error of an answer that is propagated from the uncertainty of the question's numbers, for any question.

Each number is changed by its relative uncertainty, one after the other, and the changes of a figure are added: the
first order of the worst case. A number whose change alone leaves no such figure (two equal moments of a symmetric body,
entries of a symmetric tensor) is changed together with the numbers beside it that equal it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.assessment.compare import Reference, distance
from core.errors import InvalidParameter, Path

MOST_INPUTS = 40
"""Numbers that are changed one by one; more are changed together, each by a sign of its own, in `PATTERNS`."""
PATTERNS = 16

HALF_ULP = 2.0**-53
SEEN = 1e-7
"""Relative change in place of a smaller one, whose effect rounding would hide; the effect is scaled."""

SETTINGS = {"times", "accuracy", "method", "measure", "input_uncertainty", "outputs", "round", "resolution", "points"}
SETTINGS |= {"seed", "count"}
"""Fields of questions that are no data."""

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
    elif type(request) in (int, float) and (zeros or request):
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
    """

    request: Any
    uncertainties: Mapping[Path, float]
    evaluate: Evaluate

    def of(self, path: Path, reference: Reference) -> float | None:
        """Return by how much the figure at a path of the answer may change (in its unit), None if that is not found."""
        numbers = dict(numbers_of(self.request))
        uncertain = {p: u for p, u in self.uncertainties.items() if u > 0.0 and p in numbers}
        if len(uncertain) > MOST_INPUTS:
            return self._of_many(path, reference, numbers, uncertain)
        total = 0.0
        done: set[Path] = set()
        for place, share in uncertain.items():
            if place in done:
                continue
            alone = self._effect({place: share}, numbers, path, reference)
            if alone is None:
                together = {p: uncertain[p] for p in _equal_beside(place, numbers) if p in uncertain}
                done |= set(together)
                alone = self._effect(together, numbers, path, reference)
            if alone is None:
                return None
            total += alone
        return total

    def _of_many(
        self, path: Path, reference: Reference, numbers: Mapping[Path, float], uncertain: Mapping[Path, float]
    ) -> float | None:
        signs = np.random.default_rng(0).choice((-1.0, 1.0), (PATTERNS, len(uncertain))).tolist()
        effects = []
        for row in signs:
            pattern = {place: share * sign for (place, share), sign in zip(uncertain.items(), row, strict=True)}
            effects.append(self._effect(pattern, numbers, path, reference))
        found = [effect for effect in effects if effect is not None]
        return max(found) if len(found) == len(effects) else None

    def _effect(
        self, shares: Mapping[Path, float], numbers: Mapping[Path, float], path: Path, reference: Reference
    ) -> float | None:
        largest = max(map(abs, shares.values()))
        scaled = max(1.0, SEEN / largest)
        worst = None
        for sign in (1.0, -1.0) if scaled == 1.0 else (1.0,):
            moved = {place: numbers[place] * (1.0 + sign * scaled * share) for place, share in shares.items()}
            value = self._ask(tuple(sorted(moved.items(), key=str)), path)
            if value is None:
                continue
            try:
                worst = max(worst or 0.0, distance(reference, value) / scaled)
            except InvalidParameter:
                continue
        return worst

    def _ask(self, changes: tuple[tuple[Path, float], ...], path: Path) -> Any:
        return self.evaluate(changed(self.request, dict(changes)))(path)


def _equal_beside(place: Path, numbers: Mapping[Path, float]) -> list[Path]:
    """Return the places, in the same array or matrix, of numbers that equal the one at a place, that one too."""
    depth = len(place)
    while depth and isinstance(place[depth - 1], int):
        depth -= 1
    return [p for p, number in numbers.items() if p[:depth] == place[:depth] and number == numbers[place]]
