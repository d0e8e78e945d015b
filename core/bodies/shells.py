"""Hollow and thin solids: shells with a wall of any thickness, none included, a thin rod and a thin disc."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal

from core.bodies.exact import PI
from core.bodies.solid import LengthOrNone, SignedArealDensity, SignedLinearDensity, Solid, Triple, rational
from core.bodies.solids import round_about_z
from core.errors import InvalidParameter
from core.quantities import Length


@dataclass(frozen=True)
class _Shell(Solid):
    """A wall between two radii.

    Attributes
    ----------
    inner_radius : float
        At least 0, which leaves no hollow, and at most the outer radius, which leaves a surface without thickness;
        such a surface has a mass and no density (m).
    outer_radius : float
        m.
    """

    inner_radius: LengthOrNone
    outer_radius: Length

    def _check_shape(self) -> None:
        if self.inner_radius > self.outer_radius:
            raise InvalidParameter("inner_radius", "be at most outer_radius")
        if self.inner_radius == self.outer_radius and self.density is not None:
            raise InvalidParameter(
                "density",
                "not be given for a wall without thickness, which has no volume",
                remedy="give the mass, or an outer_radius greater than inner_radius",
            )


@dataclass(frozen=True)
class SphericalShell(_Shell):
    """A ball of the outer radius without the ball of the inner radius; a spherical surface where they are equal.

    Attributes
    ----------
    inner_radius, outer_radius : float
        0 <= inner <= outer; if they are equal, the body is given by its mass (m).
    """

    kind: Literal["spherical-shell"] = "spherical-shell"

    def content(self) -> Fraction:
        """Return the volume, 4/3 pi (R^3 - r^3)."""
        return Fraction(4, 3) * PI * (rational(self.outer_radius) ** 3 - rational(self.inner_radius) ** 3)

    def gyration(self) -> Triple:
        """Return 2/5 (R^5 - r^5)/(R^3 - r^3), with R - r cancelled: 2/3 R^2 for a surface."""
        a, b = rational(self.inner_radius), rational(self.outer_radius)
        square = Fraction(2, 5) * sum(a ** (4 - k) * b**k for k in range(5)) / (a * a + a * b + b * b)
        return round_about_z(square, square)


@dataclass(frozen=True)
class CylindricalShell(_Shell):
    """A tube about z, open at both ends, from -height/2 to height/2; a cylindrical surface where the radii are equal.

    Attributes
    ----------
    inner_radius, outer_radius : float
        0 <= inner <= outer; if they are equal, the body is given by its mass (m).
    height : float
        m.
    """

    height: Length
    kind: Literal["cylindrical-shell"] = "cylindrical-shell"

    def content(self) -> Fraction:
        """Return the volume, pi (R^2 - r^2) h."""
        return PI * (rational(self.outer_radius) ** 2 - rational(self.inner_radius) ** 2) * rational(self.height)

    def gyration(self) -> Triple:
        """Return (R^2 + r^2)/4 + h^2/12 across and (R^2 + r^2)/2 along z."""
        squares = rational(self.outer_radius) ** 2 + rational(self.inner_radius) ** 2
        return round_about_z(squares / 4 + rational(self.height) ** 2 / 12, squares / 2)


@dataclass(frozen=True)
class Rod(Solid):
    """A rod without thickness along z, from -length/2 to length/2; it has no inertia about z.

    Attributes
    ----------
    length : float
        m.
    density : float, optional
        Mass per length (kg m^-1).
    """

    length: Length
    density: SignedLinearDensity | None = field(default=None, kw_only=True)
    kind: Literal["rod"] = "rod"

    def content(self) -> Fraction:
        """Return the length."""
        return rational(self.length)

    def gyration(self) -> Triple:
        """Return l^2/12 across and nothing along z."""
        return round_about_z(rational(self.length) ** 2 / 12, Fraction(0))


@dataclass(frozen=True)
class Disc(Solid):
    """A circular disc without thickness in the plane z = 0.

    Attributes
    ----------
    radius : float
        m.
    density : float, optional
        Mass per area (kg m^-2).
    """

    radius: Length
    density: SignedArealDensity | None = field(default=None, kw_only=True)
    kind: Literal["disc"] = "disc"

    def content(self) -> Fraction:
        """Return the area, pi r^2."""
        return PI * rational(self.radius) ** 2

    def gyration(self) -> Triple:
        """Return r^2/4 across and r^2/2 along z."""
        r2 = rational(self.radius) ** 2
        return round_about_z(r2 / 4, r2 / 2)
