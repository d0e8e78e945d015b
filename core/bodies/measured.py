"""Bodies known by what was measured of them: principal moments, a tensor of inertia, or where their points are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Annotated, Any, Literal

import numpy as np

from core.arrays import Floats
from core.bodies.exact import SMALLEST, exact_matrix, exact_vector, tensor_pairs
from core.bodies.mass_properties import About, MassProperties, diagonal
from core.bodies.principal_inertia import EPSILON, summed
from core.bodies.recentred import Recentred
from core.bodies.validity import TOLERANCE
from core.errors import InvalidParameter, UnphysicalInertia
from core.notices import Notice
from core.quantities import InertiaComponent, Mass, MomentOfInertia, Position, Quantity, check
from core.rows import Rows

POSITIONS = Rows(3, Quantity("m"))
MASSES = Rows(0, Quantity("kg", above=0))

MASS_RANGE = 900
"""Most binary orders of magnitude between the heaviest and the lightest point: no product of theirs is lost to zero."""

SUMMED_EXACTLY = 400
"""Points of which the moments are formed in whole numbers."""

THIN_ROD = "a thin rod has [0, m l^2/12, m l^2/12]; a body without extent does not turn"

CACHED_BODIES = 32
"""How many bodies given by principal moments have their mass properties cached, the latest ones."""

InertiaRow = tuple[InertiaComponent, InertiaComponent, InertiaComponent]

SYMMETRIC = 8.0 * EPSILON
"""How much two components of a symmetric tensor may differ, as a share of its largest: what rounding explains."""


@dataclass(frozen=True)
class PrincipalMoments:
    """A body known by its principal moments of inertia; its body axes are the principal axes, in the order given.

    Attributes
    ----------
    moments : tuple of 3 floats
        At least 0, at most one of them 0, which is that of a thin rod about itself (kg m^2). Physically impossible
        moments are answered with a warning.
    """

    moments: tuple[MomentOfInertia, MomentOfInertia, MomentOfInertia]
    kind: Literal["principal-moments"] = "principal-moments"

    may_be_round = True

    def __post_init__(self) -> None:
        check(self)
        if sum(moment == 0.0 for moment in self.moments) > 1:
            raise InvalidParameter("moments", "have at most one moment of 0 kg m^2", remedy=THIN_ROD)

    def mass_properties(self) -> MassProperties:
        """Return what the mechanics needs to know of the body; mass and centre of mass stay unknown."""
        a, b, c = self.moments
        # A negative zero is none.
        return _of_moments(float(a) + 0.0, float(b) + 0.0, float(c) + 0.0)


@lru_cache(CACHED_BODIES)
def _of_moments(a: float, b: float, c: float) -> MassProperties:
    """Return the mass properties for principal moments; cached, as questions about one body follow each other."""
    # Doubles without a negative zero, so that those which compare equal are the same.
    return diagonal((a, b, c)).with_validity_warning("moments")


@dataclass(frozen=True)
class InertiaTensor:
    """A body known by its tensor of inertia about its centre of mass, in body axes.

    Attributes
    ----------
    tensor : tuple of 3 rows
        Symmetric; off-diagonal components are I_xy = -(integral of x y dm) (kg m^2).
    mass : float, optional
        Of the body (kg).
    center_of_mass : tuple of 3 floats, optional
        In the frame in which the body is described (m).
    """

    tensor: tuple[InertiaRow, InertiaRow, InertiaRow]
    mass: Mass | None = None
    center_of_mass: Position | None = None
    kind: Literal["inertia-tensor"] = "inertia-tensor"

    may_be_round = True

    def __post_init__(self) -> None:
        check(self)
        size = max(abs(x) for row in self.tensor for x in row)
        if size < SMALLEST:
            raise InvalidParameter("tensor", f"have a component of at least {SMALLEST:.3g} kg m^2")
        for i, j in ((0, 1), (0, 2), (1, 2)):
            # Halved, as the difference of two doubles may exceed their range.
            if abs(self.tensor[i][j] / 2 - self.tensor[j][i] / 2) > SYMMETRIC * size / 2:
                raise InvalidParameter(
                    ("tensor", j, i),
                    f"equal tensor/{i}/{j}: a tensor of inertia is symmetric",
                    remedy="give I_xy = -(integral of x y dm) in both places",
                )

    def mass_properties(self) -> MassProperties:
        """Return what the mechanics needs to know of the body.

        Components on opposite sides of the diagonal that differ by rounding are replaced by their exact mean, with a
        warning.

        Raises
        ------
        UnphysicalInertia
            If a principal moment is negative beyond rounding.
        InvalidParameter
            If a principal moment is too large for a double.
        """
        given = [[Fraction(x) for x in row] for row in self.tensor]
        inertia, tail = tensor_pairs([[(given[i][j] + given[j][i]) / 2 for j in range(3)] for i in range(3)])
        center = None if self.center_of_mass is None else np.array(self.center_of_mass)
        properties = MassProperties(inertia, tail, self.mass, center)
        try:
            lowest, _, highest = (float(x) for x in properties.principal.moments)
        except InvalidParameter as fault:
            raise fault.inside("tensor") from None
        if lowest < -TOLERANCE * abs(highest):
            raise UnphysicalInertia(
                "tensor",
                f"have no negative principal moment, and has {lowest:.6g} kg m^2",
                remedy="check the signs of the off-diagonal components: I_xy = -(integral of x y dm)",
            )
        if lowest < 0.0:
            # A difference of components of a needle's tensor: its sign is that of their rounding.
            notice = Notice(
                "moment-below-rounding",
                f"the smallest principal moment, {lowest:.6g} kg m^2, is zero to within the rounding of the components",
                ("tensor",),
            )
            properties = properties.with_warnings((notice,))
        differing = max(abs(given[i][j] - given[j][i]) for i, j in ((0, 1), (0, 2), (1, 2)))
        if differing:
            notice = Notice(
                "asymmetric-tensor",
                f"components on opposite sides of the diagonal differ by up to {float(differing):.3g} kg m^2; "
                "the mean of both was taken",
                ("tensor",),
            )
            properties = properties.with_warnings((notice,))
        return properties.with_validity_warning("tensor")


@dataclass(frozen=True, eq=False)
class PointMasses:
    """Point masses held rigidly together.

    Attributes
    ----------
    masses : float or sequence of n floats
        One mass for all, or one for each (kg).
    positions : array_like, shape (n, 3)
        In body axes (m).
    about : {"center-of-mass", "origin"}
        The point about which the body turns. A free body turns about its centre of mass; "origin" is a body
        pinned there.
    """

    masses: Mass | Annotated[Any, MASSES]
    positions: Annotated[Any, POSITIONS]
    about: About = "center-of-mass"
    kind: Literal["point-masses"] = "point-masses"

    may_be_round = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", POSITIONS.read(("positions",), self.positions))
        if isinstance(self.masses, (list, tuple, np.ndarray)):
            object.__setattr__(self, "masses", MASSES.read(("masses",), self.masses))
            if len(self.masses) != len(self.positions):
                raise InvalidParameter(
                    "masses",
                    f"have one entry for each of the {len(self.positions)} positions, not {len(self.masses)}",
                    remedy="give one number if all masses are equal",
                )
        else:
            MASSES.quantity.check(("masses",), self.masses)
        if self.about not in ("center-of-mass", "origin"):
            raise InvalidParameter("about", 'be "center-of-mass" or "origin"')

    def mass_properties(self) -> MassProperties:
        """Return what the mechanics needs to know of the body; few points exactly, more in double-double.

        Exact products of inertia that cancel are zero, and the axes of a symmetric set of points exact.
        """
        masses = np.broadcast_to(np.asarray(self.masses, dtype=np.float64), len(self.positions))
        # Powers of two keep products within range and round nothing.
        heavy = int(np.frexp(masses.max())[1])
        m = np.ldexp(masses, -heavy)
        if float(m.min()) < 2.0**-MASS_RANGE:
            raise InvalidParameter("masses", f"not differ by more than a factor of 2^{MASS_RANGE}")
        if len(m) <= SUMMED_EXACTLY:
            properties = MassProperties.from_exact(*_exact_properties(masses, self.positions))
            return replace(properties, about=self.about, described_by=self)
        # Compiled code is fetched only for the bodies that need it.
        from core.bodies.point_sums import first_moments, second_moments

        local = Recentred.on(self.positions)
        first, second = np.zeros((2, 4)), np.zeros((2, 3, 3))
        first_moments(m, local.high, local.low, first)
        second_moments(m, local.high, local.low, first, second)
        kilograms = Fraction(2) ** heavy
        mass, *shift = exact_vector(*first)
        center = [o + u * c for o, u, c in zip(local.reference, local.unit, shift, strict=True)]
        products = [
            [kilograms * local.unit[i] * local.unit[j] * x for j, x in enumerate(row)]
            for i, row in enumerate(exact_matrix(*second))
        ]
        trace = products[0][0] + products[1][1] + products[2][2]
        inertia = [[(trace if i == j else 0) - products[i][j] for j in range(3)] for i in range(3)]
        rounding = summed(len(m))
        return replace(
            MassProperties.from_exact(kilograms * mass, center, inertia, rounding=rounding),
            about=self.about,
            described_by=self,
            mass_error=rounding.share * float(kilograms * mass),
            # A sum of masses times coordinates of at most one unit, over the mass.
            center_of_mass_error=2.0 * rounding.share * float(max(local.unit)),
        )


def _exact_properties(masses: Floats, positions: Floats) -> tuple[Fraction, list[Fraction], list[list[Fraction]]]:
    """Return mass, centre of mass and tensor of inertia about it, of few points, shapes (n,) and (n, 3)."""
    m, kilogram = _whole(masses)
    columns, units = zip(*(_whole(column) for column in positions.T), strict=True)
    mass = sum(m)
    first = [sum(a * x for a, x in zip(m, column, strict=True)) for column in columns]
    # Times the mass, all is whole: M sum m x y - (sum m x)(sum m y).
    products = [[Fraction(0)] * 3 for _ in range(3)]
    for i in range(3):
        weighted = [a * x for a, x in zip(m, columns[i], strict=True)]
        for j in range(i, 3):
            second = sum(a * x for a, x in zip(weighted, columns[j], strict=True))
            central = Fraction(mass * second - first[i] * first[j], mass) * kilogram * units[i] * units[j]
            products[i][j] = products[j][i] = central
    trace = products[0][0] + products[1][1] + products[2][2]
    inertia = [[(trace if i == j else 0) - products[i][j] for j in range(3)] for i in range(3)]
    return mass * kilogram, [Fraction(x, mass) * unit for x, unit in zip(first, units, strict=True)], inertia


def _whole(values: Floats) -> tuple[list[int], Fraction]:
    """Return doubles as whole multiples of a power of two, and that power."""
    mantissas, exponents = np.frexp(values)
    whole, places = np.ldexp(mantissas, 53).astype(np.int64).tolist(), exponents.tolist()
    least = min((place for x, place in zip(whole, places, strict=True) if x), default=0)
    # A zero has no place of its own.
    return [x << max(0, place - least) for x, place in zip(whole, places, strict=True)], Fraction(2) ** (least - 53)
