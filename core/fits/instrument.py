"""What an instrument makes of the figures: turned axes, a scale, an offset; each linear in the figures.

Figures pass through all of them in this order: first the frame, then scales, then offsets, however they were listed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.arrays import Floats
from core.fits.unknowns import Kind

SHORT = 2.0**-20
"""Angle (rad) over which the turn of the axes is differenced: twelve digits of its slope are right."""


class Stage(Protocol):
    """One thing that is not known of the instrument."""

    @property
    def names(self) -> tuple[str, ...]:
        """Ends of the names of its numbers: empty where it has one."""

    @property
    def start(self) -> Floats:
        """Its numbers where the instrument is perfect."""

    def applied(self, figures: Floats, numbers: Floats) -> Floats:
        """Return what becomes of figures, shape (n, m)."""

    def pushed(self, change: Floats, numbers: Floats) -> Floats:
        """Return what becomes of a change of the figures."""

    def slopes(self, figures: Floats, numbers: Floats) -> list[Floats]:
        """Return the derivatives of what becomes of the figures by each of its numbers."""


@dataclass(frozen=True)
class Offset:
    """A number that is added to columns."""

    columns: Sequence[int]
    names: tuple[str, ...] = ("",)

    @property
    def start(self) -> Floats:
        """Nothing is added."""
        return np.zeros(1)

    def applied(self, figures: Floats, numbers: Floats) -> Floats:
        """Return the sum."""
        found: Floats = figures + numbers[0] * self._mask(figures)
        return found

    def pushed(self, change: Floats, numbers: Floats) -> Floats:
        """Return the change as it is."""
        return change

    def slopes(self, figures: Floats, numbers: Floats) -> list[Floats]:
        """Return ones in these columns."""
        return [self._mask(figures)]

    def _mask(self, figures: Floats) -> Floats:
        mask = np.zeros_like(figures)
        mask[:, list(self.columns)] = 1.0
        return mask


@dataclass(frozen=True)
class Scale:
    """A number that columns are multiplied by."""

    columns: Sequence[int]
    names: tuple[str, ...] = ("",)

    @property
    def start(self) -> Floats:
        """Nothing is changed."""
        return np.ones(1)

    def applied(self, figures: Floats, numbers: Floats) -> Floats:
        """Return the product."""
        found = figures.copy()
        found[:, list(self.columns)] *= numbers[0]
        return found

    def pushed(self, change: Floats, numbers: Floats) -> Floats:
        """Return the product."""
        return self.applied(change, numbers)

    def slopes(self, figures: Floats, numbers: Floats) -> list[Floats]:
        """Return the figures of these columns."""
        found = np.zeros_like(figures)
        found[:, list(self.columns)] = figures[:, list(self.columns)]
        return [found]


@dataclass(frozen=True)
class Frame:
    """Two or three columns are components along axes that are turned, by an angle or a rotation vector (rad)."""

    columns: Sequence[int]

    @property
    def names(self) -> tuple[str, ...]:
        """One angle in the plane, three components in space."""
        return ("",) if len(self.columns) == 2 else ("/x", "/y", "/z")

    @property
    def start(self) -> Floats:
        """Nothing is turned."""
        return np.zeros(len(self.names))

    def applied(self, figures: Floats, numbers: Floats) -> Floats:
        """Return the components along the turned axes."""
        found = figures.copy()
        found[:, list(self.columns)] = figures[:, list(self.columns)] @ self._axes(numbers).T
        return found

    def pushed(self, change: Floats, numbers: Floats) -> Floats:
        """Return the components of a change."""
        return self.applied(change, numbers)

    def slopes(self, figures: Floats, numbers: Floats) -> list[Floats]:
        """Return the derivatives by the angles."""
        found = []
        for k in range(len(numbers)):
            step = np.zeros_like(numbers)
            step[k] = SHORT
            slope = np.zeros_like(figures)
            turn = (self._axes(numbers + step) - self._axes(numbers - step)) / (2.0 * SHORT)
            slope[:, list(self.columns)] = figures[:, list(self.columns)] @ turn.T
            found.append(slope)
        return found

    def _axes(self, numbers: Floats) -> Floats:
        """Return the matrix from components along the axes of the question to those along the turned ones."""
        if len(self.columns) == 2:
            cosine, sine = np.cos(numbers[0]), np.sin(numbers[0])
            return np.array([[cosine, sine], [-sine, cosine]])
        x, y, z = numbers
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        angle = float(np.linalg.norm(numbers))
        # Rodrigues' formula, transposed; sinc holds at 0.
        turned = np.eye(3) + np.sinc(angle / np.pi) * cross + 0.5 * np.sinc(0.5 * angle / np.pi) ** 2 * cross @ cross
        return np.asarray(turned.T)


STAGES: dict[Kind, type[Offset] | type[Scale] | type[Frame]] = {"frame": Frame, "scale": Scale, "offset": Offset}
"""In the order in which figures pass through them."""


def observed(
    stages: Sequence[tuple[Stage, slice]], figures: Floats, changes: Sequence[Floats], numbers: Floats
) -> tuple[Floats, list[Floats], dict[int, Floats]]:
    """Return what the instrument shows of figures, and of changes of them, and its slopes by its own numbers.

    Parameters
    ----------
    stages : sequence
        Each with the places of its numbers in `numbers`.

    Returns
    -------
    shown : ndarray, shape (n, m)
    changes : list of ndarray
    slopes : dict of int to ndarray
        By place in `numbers`.
    """
    pushed = list(changes)
    slopes: dict[int, Floats] = {}
    for stage, places in stages:
        own = numbers[places]
        pushed = [stage.pushed(change, own) for change in pushed]
        slopes = {place: stage.pushed(slope, own) for place, slope in slopes.items()}
        slopes |= dict(zip(range(places.start, places.stop), stage.slopes(figures, own), strict=True))
        figures = stage.applied(figures, own)
    return figures, pushed, slopes
