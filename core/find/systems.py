"""Several figures that are to have values at once, by as many inputs: Newton's method from samples of the range.

A solution is bounded by a box about it in which each combination of the figures that belongs to one input changes its
sign between the two faces of that input by more than the errors (Miranda's theorem, tested in the middle of each face).
Whether other solutions exist is not proven: they are looked for from the best of the samples.

References
----------
A. Neumaier, "Interval Methods for Systems of Equations", Cambridge University Press, 1990, section 5.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from core.arrays import Floats
from core.find.evaluations import Evaluations
from core.find.solutions import Family, Nearest, Solution

PER_INPUT = {2: 7, 3: 5}
"""Samples of each of two and of three inputs, in all combinations: 49 and 125."""

STARTS = 24
"""Cells from whose middles Newton's method begins, beside the best sample."""

MOST_STEPS = 40
"""Steps of it: a simple solution takes about ten, a double one gains a digit in three."""

LOOKED_AT = 1e-6
"""Size of figures, by their scales, below which they are compared with their errors."""

MOST_HALVINGS = 6
"""Halvings of a step that leads to larger figures."""

DIFFERENCE = 2.0**-17
"""Share of a range over which derivatives are taken: a third of the digits are lost to truncation, and no step more."""

SINGULAR = 1e-7
"""Ratio of singular values of the derivatives below which one combination of the inputs is not determined by them."""

SAME_LINE = 1e-6
"""Share of a range within which two solutions are one, and two families of solutions one line."""

MOST_FAMILIES = 4
"""Solutions of families after which no others are looked for: a curve of solutions has any number."""

ASIDE = 2.0**-7
"""Share of a range to one side at which another solution is looked for to tell a family from figures that touch."""

REACH = 0.5
"""By how much of its change over a cell a figure may miss its value in all corners for the cell to be looked into."""

MOST_WIDENINGS = 20
"""Factors of four by which a box is widened until the figures are decided on its faces."""


@dataclass
class System:
    """What is found of several conditions."""

    solutions: list[Solution] = field(default_factory=list)
    families: list[Family] = field(default_factory=list)
    nearest: Nearest | None = None
    unbounded: list[tuple[float, ...]] = field(default_factory=list)


def solved_system(evaluations: Evaluations, targets: Sequence[float]) -> System:
    """Return the inputs with which every figure has its value."""
    search = _Search(evaluations, np.array(targets))
    found = System()
    starts = search.starts()
    for start in starts:
        if len(found.families) == MOST_FAMILIES:
            break
        end = search.newton(start)
        if end is None or any(search.near(end, one.inputs) for one in found.solutions):
            continue
        direction = search.undetermined(end)
        if direction is not None and search.continues(end, direction):
            inputs = search.values(end)
            if not any(search.along(other, end) for other in found.families):
                found.families.append(Family(inputs, inputs, tuple(direction.tolist())))
            continue
        solution = search.certified(end) if direction is None else None
        if solution is None:
            found.unbounded.append(search.values(end))
        elif not any(
            _close(solution.inputs, other.inputs, np.array(solution.errors) + np.array(other.errors))
            for other in found.solutions
        ):
            found.solutions.append(solution)
    found.solutions.sort(key=lambda one: one.inputs)
    if not found.solutions and not found.families and starts:
        best = search.values(starts[0])
        sample = evaluations.at(best)
        errors = tuple(evaluations.error(best, k) for k in range(len(sample.values)))
        found.nearest = Nearest(best, tuple(value for value in sample.values if value is not None), errors)
    return found


def _close(one: Sequence[float], other: Sequence[float], within: Floats) -> bool:
    return bool((np.abs(np.array(one) - np.array(other)) <= within).all())


class _Search:
    """Figures less their targets, over the shares of the ranges of the inputs."""

    def __init__(self, evaluations: Evaluations, targets: Floats) -> None:
        self._evaluations, self._targets = evaluations, targets
        self._varied = evaluations.varied
        self._scales = np.ones(len(targets))

    def values(self, shares: Floats) -> tuple[float, ...]:
        """Return the inputs at shares of their ranges."""
        return tuple(one.at_share(float(share)) for one, share in zip(self._varied, shares, strict=True))

    def residual(self, shares: Floats) -> Floats | None:
        """Return the figures less their targets, None where one of them does not exist."""
        numbers = self._evaluations.at(self.values(shares)).numbers
        return None if numbers is None else np.array(numbers) - self._targets

    def errors(self, shares: Floats) -> Floats:
        """Return the errors of the figures."""
        inputs = self.values(shares)
        return np.array([self._evaluations.error(inputs, k) for k in range(len(self._targets))])

    def size(self, residual: Floats) -> float:
        """Return the size of what is left over, each figure by its scale."""
        return float(np.abs(residual / self._scales).max())

    def starts(self) -> list[Floats]:
        """Return where to begin: the middles of cells in which every figure may have its value, best first."""
        count = PER_INPUT[len(self._varied)]
        places = list(product(range(count), repeat=len(self._varied)))
        step = 1.0 / (count - 1)
        known = {place: self.residual(np.array(place) * step) for place in places}
        residuals = [residual for residual in known.values() if residual is not None]
        if not residuals:
            return []
        spread = np.median(np.abs(residuals), axis=0)
        self._scales = np.where(spread > 0.0, spread, np.maximum(np.abs(self._targets), 1e-300))
        corners = list(product((0, 1), repeat=len(self._varied)))
        cells: list[tuple[float, Floats]] = []
        for place in places:
            around = [known.get(tuple(p + c for p, c in zip(place, corner, strict=True))) for corner in corners]
            inside = np.array([residual for residual in around if residual is not None])
            if len(inside) < len(corners):
                continue
            margin = REACH * (inside.max(axis=0) - inside.min(axis=0))
            if (inside.min(axis=0) <= margin).all() and (inside.max(axis=0) >= -margin).all():
                cells.append((self.size(inside.mean(axis=0)), (np.array(place) + 0.5) * step))
        cells.sort(key=lambda cell: cell[0])
        best = min((place for place in places if known[place] is not None), key=lambda p: self.size(known[p]))  # type: ignore[arg-type]
        return [np.array(best) * step, *(middle for _, middle in cells[:STARTS])]

    def jacobian(self, shares: Floats) -> Floats | None:
        """Return the derivatives of the figures by the shares, from differences inside of the ranges."""
        columns = []
        for i in range(len(shares)):
            low, high = shares.copy(), shares.copy()
            low[i], high[i] = max(0.0, shares[i] - DIFFERENCE), min(1.0, shares[i] + DIFFERENCE)
            before, after = self.residual(low), self.residual(high)
            if before is None or after is None:
                return None
            columns.append((after - before) / (high[i] - low[i]))
        return np.array(columns).T

    def newton(self, shares: Floats) -> Floats | None:
        """Return where the figures have their values within their errors, None where the steps lead nowhere.

        The derivatives are corrected by each step (Broyden), and taken anew where a step does not lead on.
        """
        here, slopes = self.residual(shares), self.jacobian(shares)
        fresh = True
        for _ in range(MOST_STEPS):
            if here is None or slopes is None:
                return None
            if self._small(shares, here, slopes):
                return shares
            step = -np.linalg.lstsq(slopes / self._scales[:, None], here / self._scales, rcond=SINGULAR)[0]
            halvings = range(MOST_HALVINGS + 1) if fresh else range(1)
            for halving in halvings:
                trial = np.clip(shares + 0.5**halving * step, 0.0, 1.0)
                there = self.residual(trial)
                if there is not None and self.size(there) < self.size(here):
                    break
            else:
                if fresh:
                    return None
                slopes, fresh = self.jacobian(shares), True
                continue
            moved = trial - shares
            length = float(moved @ moved)
            if length == 0.0 or there is None:
                return None
            slopes = slopes + np.outer(there - here - slopes @ moved, moved) / length
            fresh = False
            shares, here = trial, there
        return None

    def _small(self, shares: Floats, residual: Floats, slopes: Floats) -> bool:
        """Return whether the figures have their values within their errors and what a rounded input changes."""
        if self.size(residual) > LOOKED_AT:
            return False
        rounded = np.abs(slopes) @ (4.0 * self._rounding(shares))
        return bool((np.abs(residual) <= self.errors(shares) + rounded).all())

    def _rounding(self, shares: Floats) -> Floats:
        """Return the spacing of doubles of the inputs, as shares of their ranges."""
        inputs = self.values(shares)
        return np.array(
            [np.spacing(abs(x)) / (one.most - one.least) if one.scale == "linear" else 2.0**-52 for x, one in
             zip(inputs, self._varied, strict=True)]
        )  # fmt: skip

    def undetermined(self, shares: Floats) -> Floats | None:
        """Return the direction in which the figures do not change to first order, None if there is none."""
        jacobian = self.jacobian(shares)
        if jacobian is None:
            return None
        _, sizes, rows = np.linalg.svd(jacobian / self._scales[:, None])
        if sizes[-1] > SINGULAR * sizes[0]:
            return None
        largest = rows[-1][np.abs(rows[-1]).argmax()]
        return np.asarray(rows[-1] / largest, dtype=np.float64)

    def continues(self, shares: Floats, direction: Floats) -> bool:
        """Return whether other solutions follow in a direction: it is a family, and not figures that touch."""
        for side in (-1.0, 1.0):
            aside = shares + side * ASIDE * direction
            if (aside >= 0.0).all() and (aside <= 1.0).all():
                other = self.newton(aside)
                if other is not None and float(np.abs(other - shares).max()) > 0.5 * ASIDE:
                    return True
        return False

    def near(self, shares: Floats, inputs: Sequence[float]) -> bool:
        """Return whether a place is that of a solution."""
        other = np.array([one.width(one.least, x) for one, x in zip(self._varied, inputs, strict=True)])
        return bool((np.abs(shares - other) <= SAME_LINE).all())

    def along(self, family: Family, shares: Floats) -> bool:
        """Return whether a place is on the line of a family."""
        here = np.array([one.width(one.least, x) for one, x in zip(self._varied, family.least, strict=True)])
        line, off = np.array(family.direction), shares - here
        across = off - line * float(off @ line) / float(line @ line)
        return bool((np.abs(across) <= SAME_LINE).all())

    def certified(self, shares: Floats) -> Solution | None:
        """Return the solution with a box on whose faces the figures are decided; None if there is no such box."""
        jacobian, residual = self.jacobian(shares), self.residual(shares)
        if jacobian is None or residual is None:
            return None
        inverse: Floats = np.linalg.inv(jacobian).astype(np.float64)
        needed = 2.0 * np.abs(inverse) @ (np.abs(residual) + self.errors(shares))
        needed = needed + 4.0 * self._rounding(shares)
        for _ in range(MOST_WIDENINGS):
            if all(self._changes(shares, needed, inverse, i) for i in range(len(shares))):
                break
            needed = 4.0 * needed
        else:
            return None
        inputs = self.values(shares)
        errors = tuple(
            max(abs(self.values(np.clip(shares + side * needed, 0.0, 1.0))[i] - x) for side in (-1.0, 1.0))
            for i, x in enumerate(inputs)
        )
        values = tuple(value for value in self._evaluations.at(inputs).values if value is not None)
        return Solution(inputs, errors, "root", 1, values, tuple(self.errors(shares).tolist()))

    def _changes(self, shares: Floats, box: Floats, inverse: Floats, i: int) -> bool:
        """Return whether the combination of the figures that belongs to an input is decided on both of its faces."""
        for side in (-1.0, 1.0):
            face = shares.copy()
            face[i] += side * box[i]
            if not 0.0 <= face[i] <= 1.0:
                # Beyond an end of the range nothing can be asked.
                continue
            residual = self.residual(face)
            if residual is None:
                return False
            combined = inverse @ residual
            if not side * combined[i] > (np.abs(inverse) @ self.errors(face))[i]:
                return False
        return True
