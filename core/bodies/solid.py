"""What all solids share: a shape of uniform density, known by its mass or by its density, with exact mass properties."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Annotated

from core.bodies.mass_properties import MassProperties
from core.errors import InvalidParameter
from core.quantities import Quantity, SignedMass, check

SignedDensity = Annotated[float, Quantity("kg m^-3")]
SignedArealDensity = Annotated[float, Quantity("kg m^-2")]
SignedLinearDensity = Annotated[float, Quantity("kg m^-1")]
LengthOrNone = Annotated[float, Quantity("m", at_least=0)]

Triple = tuple[Fraction, Fraction, Fraction]
ZERO = Fraction(0)


def rational(number: float) -> Fraction:
    """Return the rational number that a double is."""
    return Fraction(float(number))


@dataclass(frozen=True)
class Solid(ABC):
    """A shape filled uniformly, whose own axes are principal axes and whose centre of mass lies on its z axis.

    Attributes
    ----------
    mass : float, optional
        kg. Exactly one of mass and density is given.
    density : float, optional
        kg m^-3 (rod: kg m^-1, disc: kg m^-2). A negative mass or density is a hole in a composite, and refused elsewhere.

    Raises
    ------
    InvalidParameter
        If both or neither of mass and density are given, if the one given is zero, or if a dimension is out of range.
    """

    mass: SignedMass | None = field(default=None, kw_only=True)
    density: SignedDensity | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        check(self)
        if self.mass is None and self.density is None:
            raise InvalidParameter("mass", "be given, or else density", remedy="give exactly one of mass and density")
        if self.mass is not None and self.density is not None:
            raise InvalidParameter("density", "not be given beside mass", remedy="give exactly one of mass and density")
        if self._given == 0.0:
            raise InvalidParameter(self._given_name, "not be zero")
        self._check_shape()

    def _check_shape(self) -> None:
        """Raise `InvalidParameter` if the dimensions do not go together."""
        return

    @property
    def _given_name(self) -> str:
        return "density" if self.mass is None else "mass"

    @property
    def _given(self) -> float:
        given = self.density if self.mass is None else self.mass
        assert given is not None
        return given

    @abstractmethod
    def content(self) -> Fraction:
        """Return what density is counted by: the volume (m^3), of a disc the area, of a rod the length."""

    @abstractmethod
    def gyration(self) -> Triple:
        """Return the moments of inertia about the centre of mass along x, y, z, divided by the mass (m^2)."""

    def height_of_center(self) -> Fraction:
        """Return the z coordinate of the centre of mass (m)."""
        return ZERO

    @property
    def negative(self) -> bool:
        """Whether the solid is a hole."""
        return self._given < 0.0

    def exact_properties(self) -> tuple[Fraction, Triple, tuple[Triple, Triple, Triple]]:
        """Return mass, centre of mass and inertia about it as rational numbers; a hole's mass and inertia are negative.

        Nothing is rounded, but that a mass from a density contains pi, which is taken to 200 bits.
        """
        given = rational(self._given)
        mass = given * self.content() if self.mass is None else given
        a, b, c = (mass * square for square in self.gyration())
        return mass, (ZERO, ZERO, self.height_of_center()), ((a, ZERO, ZERO), (ZERO, b, ZERO), (ZERO, ZERO, c))

    def mass_properties(self) -> MassProperties:
        """Return what the mechanics needs to know of the body.

        Raises
        ------
        InvalidParameter
            If the mass is negative, or if a figure lies outside the range of doubles.
        """
        if self.negative:
            raise InvalidParameter(
                self._given_name,
                "be greater than 0 except in a part of a composite, where a negative one is a hole",
                remedy='make it a part of a body of kind "composite", beside what it is cut from',
            )
        return MassProperties.from_exact(*self.exact_properties())
