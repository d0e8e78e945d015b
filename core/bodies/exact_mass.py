"""Mass, centre of mass and inertia of a body in rational numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import hypot

from flint import fmpq

from core.bodies.exact import parallel_axis, rotated, rotation
from core.bodies.exact_inertia import ExactInertia, Matrix, Vector, of_matter, semidefinite, triple
from core.bodies.mass_properties import About
from core.bodies.pinned import AT_THE_ORIGIN, not_free
from core.digits.exact_inputs import Number, exact, exact_numbers, nearest
from core.errors import InvalidParameter, UnphysicalInertia
from core.notices import Notice

LONGEST_LIST = 100_000


@dataclass(frozen=True)
class ExactMass:
    """A body in rational numbers.

    Attributes
    ----------
    inertia : tuple of 3 rows of 3 fractions
        Tensor about the centre of mass, in body axes (kg m^2).
    mass : Fraction, optional
        None where it is not known (kg).
    center_of_mass : tuple of 3 fractions, optional
        In the frame in which the body is described (m).
    about : {"center-of-mass", "origin"}
        The point about which the body turns.
    given_by : str
        Field to which notices about the inertia point; empty for the body as a whole.
    """

    inertia: Matrix
    mass: Fraction | None = None
    center_of_mass: Vector | None = None
    about: About = "center-of-mass"
    given_by: str = ""

    @cached_property
    def of_motion(self) -> ExactInertia:
        """The inertia about the point about which the body turns.

        Raises
        ------
        UnphysicalInertia
            If holes leave a negative principal moment about the centre of mass.
        InvalidParameter
            If a principal moment of the motion is not positive.
        """
        if not semidefinite(self.inertia) and self.given_by == "parts":
            raise UnphysicalInertia(
                "parts",
                "have no negative principal moment together: a hole is larger than what it is cut from",
                remedy="let each hole lie inside of what it is cut from",
            )
        if self.about == "center-of-mass" or self.mass is None or self.center_of_mass is None:
            return ExactInertia(self.inertia)
        return ExactInertia(_matrix(parallel_axis(self.mass, self.center_of_mass, self.inertia)))

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Warnings about the body; paths are relative to it."""
        found = []
        if not of_matter(self.inertia):
            detail = (
                "one principal moment is larger than the sum of the other two, which no distribution of positive mass "
                "has; the equations of motion hold all the same"
            )
            found.append(Notice("unphysical-inertia", detail, (self.given_by,) if self.given_by else ()))
        if self.about == "origin" and self.mass is not None and self.center_of_mass is not None:
            square, trace = sum((x * x for x in self.center_of_mass), Fraction(0)), self.of_motion.trace
            # The rounding of positions given as doubles is not an offset from the origin.
            if square * self.mass > Fraction(AT_THE_ORIGIN) ** 2 * trace:
                found.append(not_free(hypot(*map(nearest, self.center_of_mass))))
        return tuple(found)

    def placed(self, attitude: Sequence[Fraction], position: Sequence[Fraction]) -> ExactMass:
        """Return the body rotated about its origin by a quaternion, then displaced; the mass must be known."""
        assert self.center_of_mass is not None
        center, inertia = self.center_of_mass, self.inertia
        if any(attitude[1:]):
            turn = rotation(attitude)
            center = triple([sum((r * x for r, x in zip(row, center, strict=True)), Fraction(0)) for row in turn])
            inertia = _matrix(rotated(inertia, turn))
        moved = triple([x + y for x, y in zip(center, position, strict=True)])
        return ExactMass(inertia, self.mass, moved)

    def taken_away(self) -> ExactMass:
        """Return the hole in the shape of this body."""
        assert self.mass is not None
        return ExactMass(_matrix([[-x for x in row] for row in self.inertia]), -self.mass, self.center_of_mass)

    @classmethod
    def of_point_masses(
        cls,
        masses: Number | Sequence[Number],
        positions: Sequence[Sequence[Number]],
        about: About = "center-of-mass",
    ) -> ExactMass:
        """Return rigidly connected point masses.

        Parameters
        ----------
        masses : number or sequence of n numbers
            One number for n equal masses (kg).
        positions : sequence of n sequences of 3 numbers
            (m).
        """
        if len(positions) > LONGEST_LIST:
            raise InvalidParameter("positions", f"have at most {LONGEST_LIST} entries")
        points = [triple(exact_numbers(point, ("positions", i), 3)) for i, point in enumerate(positions)]
        if isinstance(masses, Sequence) and not isinstance(masses, str):
            weights = exact_numbers(masses, ("masses",), len(points))
        else:
            weights = (exact(masses, "masses"),) * len(points)
        for i, weight in enumerate(weights):
            if weight <= 0:
                raise InvalidParameter(("masses", i), "be greater than 0 kg")
        if not points:
            raise InvalidParameter("positions", "have at least one entry")
        nothing = _matrix([[Fraction(0)] * 3] * 3)
        whole = cls.together([cls(nothing, m, p) for m, p in zip(weights, points, strict=True)], about)
        return replace(whole, given_by="")

    @classmethod
    def together(cls, parts: Sequence[ExactMass], about: About) -> ExactMass:
        """Return the composite of bodies of known mass; holes have negative masses.

        Raises
        ------
        InvalidParameter
            If the total mass is not positive.
        """
        # Sums in fmpq: the denominators of many attitudes multiply, and the gcd of Python's Fraction is quadratic in
        # them.
        known = []
        for part in parts:
            assert part.mass is not None
            assert part.center_of_mass is not None
            known.append((fmpq_of(part.mass), [fmpq_of(x) for x in part.center_of_mass], part.inertia))
        total = sum((m for m, _, _ in known), fmpq(0))
        if not total > 0:
            raise InvalidParameter(
                "parts",
                "weigh more than the holes among them",
                remedy="add what the holes are cut from; a composite that is a hole as a whole is a part with hole: "
                "true",
            )
        first = [sum((m * c[k] for m, c, _ in known), fmpq(0)) for k in range(3)]
        center = [x / total for x in first]
        second = {
            (i, j): sum((m * c[i] * c[j] for m, c, _ in known), fmpq(0)) - first[i] * center[j]
            for i in range(3)
            for j in range(i, 3)
        }
        trace = second[0, 0] + second[1, 1] + second[2, 2]

        def component(i: int, j: int) -> Fraction:
            own = sum((fmpq_of(inertia[i][j]) for _, _, inertia in known), fmpq(0))
            return fraction_of(own + (trace if i == j else 0) - second[min(i, j), max(i, j)])

        tensor = _matrix([[component(i, j) for j in range(3)] for i in range(3)])
        return cls(tensor, fraction_of(total), triple([fraction_of(x) for x in center]), about, "parts")


def fmpq_of(number: Fraction) -> fmpq:
    """Return a fraction as the library's rational number."""
    return fmpq(number.numerator, number.denominator)


def fraction_of(number: fmpq) -> Fraction:
    """Return the library's rational number as a fraction."""
    return Fraction(int(number.p), int(number.q))


def _matrix(rows: Sequence[Sequence[Fraction]]) -> Matrix:
    x, y, z = (triple(row) for row in rows)
    return x, y, z
