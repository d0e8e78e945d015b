"""The base class of bodies of uniform density, given by mass or density.

The dimensions are doubles, so volume (up to a power of pi), centre of mass and moments per mass are rational numbers.
They are computed exactly and rounded once, to a pair of doubles.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple, Self

from core.bodies.exact import PI, Matrix, Vector
from core.bodies.mass_properties import MassProperties
from core.bodies.principal_inertia import ROUNDED_ONCE, Rounding
from core.errors import InvalidParameter
from core.quantities import SignedDensity, SignedMass, check


class Shape(NamedTuple):
    """A body of mass one.

    Attributes
    ----------
    volume : Fraction
        Divided by pi to the power `pi_power` (m^3); zero for an infinitely thin body.
    center_of_mass : sequence of 3 Fraction
        (m).
    inertia : sequence of 3 rows of 3 Fraction
        Tensor about the centre of mass divided by the mass (m^2).
    """

    volume: Fraction
    pi_power: int
    center_of_mass: Vector
    inertia: Matrix


@dataclass(frozen=True, kw_only=True)
class Uniform:
    """A body of uniform density, given by exactly one of mass and density.

    A negative mass or density is a hole. It can only be a part of a composite, from which it is subtracted.

    Attributes
    ----------
    mass : float, optional
        Given by this or by the density; not 0 (kg).
    density : float, optional
        Given by this or by the mass; not 0 (kg m^-3).
    """

    mass: SignedMass | None = None
    density: SignedDensity | None = None

    may_be_round = False
    """Whether it is a ball, or of a kind that says nothing of its surface."""

    def __post_init__(self) -> None:
        check(self)
        if (self.mass is None) == (self.density is None):
            raise InvalidParameter(
                "mass", "be given, or the density: exactly one of both", remedy="give one of mass and density"
            )
        if not self.mass and not self.density:
            raise InvalidParameter(self._stated, "not be 0")
        self.validate()

    def validate(self) -> None:
        """Raise `InvalidParameter` if dimensions contradict each other."""

    def shape(self) -> Shape:
        """Return the body's geometry."""
        raise NotImplementedError

    @property
    def rounding(self) -> Rounding:
        """Rounding of the inertia tensor: rational numbers, rounded once."""
        return ROUNDED_ONCE

    @property
    def _stated(self) -> str:
        return "density" if self.mass is None else "mass"

    @property
    def is_hole(self) -> bool:
        """Whether the body is subtracted from the composite of which it is a part."""
        return (self.density if self.mass is None else self.mass) < 0.0  # type: ignore[operator]

    def filled(self) -> Self:
        """Return the body that fills this hole."""
        if self.mass is None:
            return replace(self, density=-self.density)  # type: ignore[operator]
        return replace(self, mass=-self.mass)

    def refuse_hole(self) -> None:
        """Raise `InvalidParameter` if the body is a hole, which has no mass properties of its own."""
        if self.is_hole:
            raise InvalidParameter(
                self._stated,
                "be greater than 0",
                remedy="a negative mass or density is a hole, which only a part of a composite can be",
            )

    def weigh(self, shape: Shape) -> Fraction:
        """Return the mass."""
        if self.mass is not None:
            return Fraction(self.mass)
        if shape.volume == 0:
            raise InvalidParameter(
                "density", "not be given: an infinitely thin body has no volume", remedy="give its mass"
            )
        return Fraction(self.density or 0.0) * shape.volume * PI**shape.pi_power

    def mass_properties(self) -> MassProperties:
        """Return the mass properties, from rational arithmetic.

        Raises
        ------
        InvalidParameter
            If the body is a hole, is infinitely thin and given by a density, or its moments leave the range of doubles.
        """
        self.refuse_hole()
        shape = self.shape()
        mass = self.weigh(shape)
        inertia = [[mass * x for x in row] for row in shape.inertia]
        found = MassProperties.from_exact(mass, shape.center_of_mass, inertia, rounding=self.rounding)
        return replace(found, described_by=self)


def principal(volume: Fraction, pi_power: int, center: Vector, moments: Vector) -> Shape:
    """Return the shape whose principal axes are the body axes."""
    zero = Fraction(0)
    return Shape(volume, pi_power, center, [[moments[i] if i == j else zero for j in range(3)] for i in range(3)])


def round_about_z(volume: Fraction, pi_power: int, height: Fraction, transverse: Fraction, axial: Fraction) -> Shape:
    """Return a body of revolution about z, its centre of mass at `height` on the axis."""
    zero = Fraction(0)
    return principal(volume, pi_power, (zero, zero, height), (transverse, transverse, axial))
