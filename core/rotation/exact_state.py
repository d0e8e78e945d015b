"""The state of a free rotation as rational numbers.

Moments and angular velocities are doubles or sums of two, hence rational; so are energy, squared momentum and every
difference of moments, and none of them cancels or leaves a range.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from core.bodies.exact import exact_vector
from core.rotation.closed_form import FreeRotation

Triple = tuple[Fraction, Fraction, Fraction]


@dataclass(frozen=True)
class ExactState:
    """A state along principal axes, in ascending order of moments.

    Attributes
    ----------
    moments : tuple of 3 fractions
        (kg m^2).
    rates : tuple of 3 fractions
        Angular velocity (rad/s).
    """

    moments: Triple
    rates: Triple

    @classmethod
    def of(cls, rotation: FreeRotation) -> ExactState:
        """Return the state at t = 0."""
        a, b, c = exact_vector(rotation.inertia.moments, rotation.inertia.moments_tail)
        x, y, z = exact_vector(*rotation.start)
        return cls((a, b, c), (x, y, z))

    @cached_property
    def twice_energy(self) -> Fraction:
        """2E = sum I w^2 (J)."""
        return sum((i * w * w for i, w in zip(self.moments, self.rates, strict=True)), Fraction(0))

    @cached_property
    def squared_momentum(self) -> Fraction:
        """L^2 = sum (I w)^2."""
        return sum(((i * w) ** 2 for i, w in zip(self.moments, self.rates, strict=True)), Fraction(0))

    def excess(self, axis: int) -> Fraction:
        """Return L^2 - 2 E I_axis: of the middle axis positive if the largest is circled, and 0 on the separatrix."""
        own = self.moments[axis]
        return sum((i * (i - own) * w * w for i, w in zip(self.moments, self.rates, strict=True)), Fraction(0))

    @property
    def symmetry_axis(self) -> int | None:
        """Number of the axis whose moment is the single one of a body with exactly two equal moments."""
        low, middle, high = self.moments
        if low == middle:
            return None if middle == high else 2
        return 0 if middle == high else None
