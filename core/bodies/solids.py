"""Uniform solids and shells in standard position: symmetric about z, centred on the origin unless stated otherwise.

Formulas: derived in docs/physics/bodies.md; most are in F. P. Beer, E. R. Johnston, "Vector Mechanics for Engineers:
Dynamics", appendix B ("Mass moments of inertia of homogeneous bodies").
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from core.bodies.uniform import Shape, Uniform, principal, round_about_z
from core.errors import InvalidParameter
from core.quantities import Length, LengthOrZero

ORIGIN = (Fraction(0), Fraction(0), Fraction(0))


@dataclass(frozen=True)
class Ball(Uniform):
    """A solid ball centred on the origin.

    Attributes
    ----------
    radius : float
        Of the ball (m).
    """

    radius: Length
    kind: Literal["ball"] = "ball"

    may_be_round = True

    def shape(self) -> Shape:
        """Return 2/5 m r^2 about every axis."""
        r = Fraction(self.radius)
        i = Fraction(2, 5) * r**2
        return principal(Fraction(4, 3) * r**3, 1, ORIGIN, (i, i, i))


@dataclass(frozen=True)
class Cuboid(Uniform):
    """A rectangular block centred on the origin, edges along x, y and z.

    Attributes
    ----------
    edges : tuple of 3 floats
        Lengths along x, y and z (m).
    """

    edges: tuple[Length, Length, Length]
    kind: Literal["cuboid"] = "cuboid"

    def shape(self) -> Shape:
        """Return m (b^2 + c^2)/12 and cyclic."""
        a, b, c = (Fraction(edge) for edge in self.edges)
        x, y, z = a**2 / 12, b**2 / 12, c**2 / 12
        return principal(a * b * c, 0, ORIGIN, (y + z, z + x, x + y))


@dataclass(frozen=True)
class Cylinder(Uniform):
    """A solid circular cylinder centred on the origin, axis along z.

    Attributes
    ----------
    radius : float
        Of the cylinder (m).
    height : float
        Along the axis (m).
    """

    radius: Length
    height: Length
    kind: Literal["cylinder"] = "cylinder"

    def shape(self) -> Shape:
        """Return m r^2/2 about the axis, m (r^2/4 + h^2/12) across."""
        return _cylinder(self.radius, self.height)


@dataclass(frozen=True)
class Rod(Uniform):
    """A straight rod centred on the origin, along z.

    Attributes
    ----------
    length : float
        Along the axis (m).
    radius : float
        0, the default, is an infinitely thin rod: it has no moment about its own axis and needs a mass (m).
    """

    length: Length
    radius: LengthOrZero = 0.0
    kind: Literal["rod"] = "rod"

    def shape(self) -> Shape:
        """Return m l^2/12 across for a thin rod; otherwise as a cylinder."""
        return _cylinder(self.radius, self.length)


@dataclass(frozen=True)
class Disc(Uniform):
    """A flat circular disc centred on the origin, axis along z.

    Attributes
    ----------
    radius : float
        Of the disc (m).
    thickness : float
        0, the default, is an infinitely thin disc, which needs a mass (m).
    """

    radius: Length
    thickness: LengthOrZero = 0.0
    kind: Literal["disc"] = "disc"

    def shape(self) -> Shape:
        """Return m r^2/2 about the axis and m r^2/4 across for a thin disc; otherwise as a cylinder."""
        return _cylinder(self.radius, self.thickness)


@dataclass(frozen=True)
class Ellipsoid(Uniform):
    """A solid ellipsoid centred on the origin, semi-axes along x, y and z.

    Attributes
    ----------
    semi_axes : tuple of 3 floats
        Lengths along x, y and z (m).
    """

    semi_axes: tuple[Length, Length, Length]
    kind: Literal["ellipsoid"] = "ellipsoid"

    def shape(self) -> Shape:
        """Return m (b^2 + c^2)/5 and cyclic."""
        a, b, c = (Fraction(semi_axis) for semi_axis in self.semi_axes)
        x, y, z = a**2 / 5, b**2 / 5, c**2 / 5
        return principal(Fraction(4, 3) * a * b * c, 1, ORIGIN, (y + z, z + x, x + y))


@dataclass(frozen=True)
class Cone(Uniform):
    """A solid circular cone: base on the plane z = 0, apex at z = height; its centre of mass is at height/4.

    Attributes
    ----------
    radius : float
        Of the base (m).
    height : float
        From base to apex (m).
    """

    radius: Length
    height: Length
    kind: Literal["cone"] = "cone"

    def shape(self) -> Shape:
        """Return 3/10 m r^2 about the axis, m (3/20 r^2 + 3/80 h^2) across, through the centre of mass."""
        r, h = Fraction(self.radius), Fraction(self.height)
        across = Fraction(3, 20) * r**2 + Fraction(3, 80) * h**2
        return round_about_z(r**2 * h / 3, 1, h / 4, across, Fraction(3, 10) * r**2)


@dataclass(frozen=True)
class SphericalShell(Uniform):
    """The solid between two concentric spheres about the origin; equal radii are an infinitely thin shell.

    Attributes
    ----------
    outer_radius : float
        Of the outer surface (m).
    inner_radius : float
        Of the cavity (m).
    """

    outer_radius: Length
    inner_radius: LengthOrZero
    kind: Literal["spherical-shell"] = "spherical-shell"

    may_be_round = True

    def validate(self) -> None:
        """Raise for an inner radius larger than the outer one."""
        _nested(self.inner_radius, self.outer_radius)

    def shape(self) -> Shape:
        """Return 2/5 m (a^5 - b^5)/(a^3 - b^3), divided out so that the thin shell's 2/3 m a^2 is included."""
        a, b = Fraction(self.outer_radius), Fraction(self.inner_radius)
        quintic = a**4 + a**3 * b + a**2 * b**2 + a * b**3 + b**4
        i = Fraction(2, 5) * quintic / (a**2 + a * b + b**2)
        return principal(Fraction(4, 3) * (a**3 - b**3), 1, ORIGIN, (i, i, i))


@dataclass(frozen=True)
class CylindricalShell(Uniform):
    """A tube, open at both ends, centred on the origin, axis along z; equal radii are an infinitely thin wall.

    Attributes
    ----------
    outer_radius : float
        Of the outer surface (m).
    inner_radius : float
        Of the bore (m).
    height : float
        Along the axis (m).
    """

    outer_radius: Length
    inner_radius: LengthOrZero
    height: Length
    kind: Literal["cylindrical-shell"] = "cylindrical-shell"

    def validate(self) -> None:
        """Raise for an inner radius larger than the outer one."""
        _nested(self.inner_radius, self.outer_radius)

    def shape(self) -> Shape:
        """Return m (a^2 + b^2)/2 about the axis, m ((a^2 + b^2)/4 + h^2/12) across."""
        a, b, h = Fraction(self.outer_radius), Fraction(self.inner_radius), Fraction(self.height)
        squares = a**2 + b**2
        return round_about_z((a**2 - b**2) * h, 1, Fraction(0), squares / 4 + h**2 / 12, squares / 2)


@dataclass(frozen=True)
class Torus(Uniform):
    """A solid ring centred on the origin, axis along z.

    Attributes
    ----------
    ring_radius : float
        From the centre to the middle of the tube (m).
    tube_radius : float
        At most `ring_radius` (m).
    """

    ring_radius: Length
    tube_radius: Length
    kind: Literal["torus"] = "torus"

    def validate(self) -> None:
        """Raise for a ring that overlaps itself."""
        if self.tube_radius > self.ring_radius:
            raise InvalidParameter("tube_radius", "not exceed ring_radius: the ring would overlap itself")

    def shape(self) -> Shape:
        """Return m (R^2 + 3/4 r^2) about the axis, m (R^2/2 + 5/8 r^2) across."""
        ring, tube = Fraction(self.ring_radius) ** 2, Fraction(self.tube_radius) ** 2
        volume = 2 * Fraction(self.ring_radius) * tube
        return round_about_z(volume, 2, Fraction(0), ring / 2 + Fraction(5, 8) * tube, ring + Fraction(3, 4) * tube)


@dataclass(frozen=True)
class Capsule(Uniform):
    """A cylinder with a half-ball on each end, centred on the origin, axis along z.

    Attributes
    ----------
    radius : float
        Of the cylinder and of the half-balls (m).
    length : float
        Of the cylinder alone; the total length is length + 2 radius (m).
    """

    radius: Length
    length: LengthOrZero
    kind: Literal["capsule"] = "capsule"

    def shape(self) -> Shape:
        """Return the sum of a cylinder's and two displaced half-balls' moments."""
        r, h = Fraction(self.radius), Fraction(self.length)
        caps = Fraction(4, 3) * r
        wall, ends = h / (h + caps), caps / (h + caps)
        axial = wall * r**2 / 2 + ends * Fraction(2, 5) * r**2
        across = wall * (r**2 / 4 + h**2 / 12) + ends * (Fraction(2, 5) * r**2 + h**2 / 4 + Fraction(3, 8) * r * h)
        return round_about_z(r**2 * (h + caps), 1, Fraction(0), across, axial)


@dataclass(frozen=True)
class Hemisphere(Uniform):
    """A solid half-ball: flat face on the plane z = 0, dome towards z; its centre of mass is at 3/8 radius.

    Attributes
    ----------
    radius : float
        Of the hemisphere (m).
    """

    radius: Length
    kind: Literal["hemisphere"] = "hemisphere"

    def shape(self) -> Shape:
        """Return 2/5 m r^2 about the axis, 83/320 m r^2 across, through the centre of mass."""
        r = Fraction(self.radius)
        return round_about_z(
            Fraction(2, 3) * r**3, 1, Fraction(3, 8) * r, Fraction(83, 320) * r**2, Fraction(2, 5) * r**2
        )


def _cylinder(radius: float, height: float) -> Shape:
    r, h = Fraction(radius), Fraction(height)
    return round_about_z(r**2 * h, 1, Fraction(0), r**2 / 4 + h**2 / 12, r**2 / 2)


def _nested(inner: float, outer: float) -> None:
    if inner > outer:
        raise InvalidParameter("inner_radius", "not exceed outer_radius")
