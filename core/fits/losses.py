"""Losses that grow less than squares: what is far off then counts little.

Each is a function of z = (r/scale)^2 of residuals r in standard deviations: rho(z) = z for small z.

References
----------
P. J. Huber, E. M. Ronchetti, "Robust Statistics" (2009), chapters 3 and 7.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from core.arrays import Floats
from core.quantities import Quantity, check

Scale = Annotated[float, Quantity("1", above=0)]

EFFICIENT = {"soft_l1": 1.0, "huber": 1.345, "cauchy": 2.385}
"""Default scales: with Huber's and Cauchy's loss 95 % of the information of normal data is used."""


def _soft_l1(z: Floats) -> Floats:
    root = np.sqrt(1.0 + z)
    return np.stack([2.0 * (root - 1.0), 1.0 / root, -0.5 / root**3])


def _huber(z: Floats) -> Floats:
    outside = np.sqrt(np.maximum(z, 1.0))
    inside = z <= 1.0
    return np.stack([np.where(inside, z, 2.0 * outside - 1.0), 1.0 / outside, np.where(inside, 0.0, -0.5 / outside**3)])


def _cauchy(z: Floats) -> Floats:
    return np.stack([np.log1p(z), 1.0 / (1.0 + z), -1.0 / (1.0 + z) ** 2])


LOSSES: dict[str, Callable[[Floats], Floats]] = {"soft_l1": _soft_l1, "huber": _huber, "cauchy": _cauchy}
"""From z to rho and its first two derivatives, shape (3, n)."""


@dataclass(frozen=True)
class Robust:
    """A loss in place of squares.

    Attributes
    ----------
    loss : {"soft_l1", "huber", "cauchy"}
    scale : float, optional
        Residual, in standard deviations, from which on it grows less.
    """

    loss: Literal["soft_l1", "huber", "cauchy"]
    scale: Scale | None = None

    def __post_init__(self) -> None:
        check(self)

    @property
    def width(self) -> float:
        """The scale, or its default."""
        return EFFICIENT[self.loss] if self.scale is None else self.scale

    def rho(self, z: Floats) -> Floats:
        """Return rho and its derivatives, shape (3, n)."""
        return LOSSES[self.loss](z)

    def variance_factor(self, residuals: Floats, unknowns: int) -> float:
        """Return by how much the covariance exceeds that of least squares: mean psi^2 over the square of mean psi'."""
        z = (residuals / self.width) ** 2
        _, first, second = self.rho(z)
        psi, slope = residuals * first, first + 2.0 * z * second
        count = len(residuals)
        return float(np.sum(psi**2) / max(1, count - unknowns) / np.mean(slope) ** 2)
