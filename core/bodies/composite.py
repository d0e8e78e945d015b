"""Bodies welded together: parts placed, turned and, as holes, taken away."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from core import bodies
from core.bodies.exact import exact_vector, parallel_axis, rotated, rotation
from core.bodies.mass_properties import MassProperties
from core.bodies.measured import PointMasses
from core.bodies.uniform import Uniform
from core.errors import InvalidParameter
from core.quantities import Position, Quaternion, check

MOST_PARTS = 1000
DEEPEST = 8


@dataclass(frozen=True)
class Part:
    """A body in its place within a composite.

    Attributes
    ----------
    body : Body
        A solid or mesh of negative mass or density is a hole.
    position : tuple of 3 floats
        Of the origin of the part's frame, in the composite's frame (m).
    attitude : tuple of 4 floats
        Quaternion [w, x, y, z] from the part's axes to the composite's; any length but zero.
    """

    body: bodies.Body
    position: Position = (0.0, 0.0, 0.0)
    attitude: Quaternion = (1.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        check(self)
        if not any(self.attitude):
            raise InvalidParameter(
                "attitude", "not be zero", remedy="give a unit quaternion [w, x, y, z]; [1, 0, 0, 0] is no turn"
            )
        if isinstance(self.body, PointMasses) and self.body.about == "origin":
            raise InvalidParameter(("body", "about"), 'be "center-of-mass" for a part of a composite')


@dataclass(frozen=True)
class Composite:
    """Bodies welded together.

    Attributes
    ----------
    parts : sequence of Part
        At most 1000 bodies in all, nested at most 8 deep.
    """

    parts: tuple[Part, ...]
    kind: Literal["composite"] = "composite"

    def __post_init__(self) -> None:
        check(self)
        if not self.parts:
            raise InvalidParameter("parts", "have at least 1 entry")
        if self.count > MOST_PARTS:
            raise InvalidParameter("parts", f"hold at most {MOST_PARTS} bodies in all, not {self.count}")
        if self.depth > DEEPEST:
            raise InvalidParameter("parts", f"be nested at most {DEEPEST} deep")

    @property
    def count(self) -> int:
        """Number of bodies in all, composites among the parts opened."""
        return sum(part.body.count if isinstance(part.body, Composite) else 1 for part in self.parts)

    @property
    def depth(self) -> int:
        """Levels of composites, this one included."""
        return 1 + max(part.body.depth if isinstance(part.body, Composite) else 0 for part in self.parts)

    def mass_properties(self) -> MassProperties:
        """Return what the mechanics needs to know of the body, by the parallel-axis theorem in rational arithmetic.

        Raises
        ------
        InvalidParameter
            If a part's mass or centre of mass is not known, or the holes weigh as much as the parts.
        """
        placed = [_place(part, i) for i, part in enumerate(self.parts)]
        mass = sum((part.mass for part in placed), Fraction(0))
        if mass <= 0:
            raise InvalidParameter(
                "parts", f"weigh more than the holes: the mass is {float(mass):.6g} kg", remedy="take away less"
            )
        center = [sum((part.mass * part.center[k] for part in placed), Fraction(0)) / mass for k in range(3)]
        inertia = [[Fraction(0)] * 3 for _ in range(3)]
        for part in placed:
            offset = [x - c for x, c in zip(part.center, center, strict=True)]
            moved = parallel_axis(part.mass, offset, part.inertia)
            inertia = [
                [x + y for x, y in zip(row, more, strict=True)] for row, more in zip(inertia, moved, strict=True)
            ]
        found = MassProperties.from_exact(
            mass,
            center,
            inertia,
            warnings=tuple(
                notice.inside("parts", i, "body") for i, part in enumerate(placed) for notice in part.own.warnings
            ),
            conditions=tuple(condition for part in placed for condition in part.own.conditions),
        )
        return found.judged("parts")


@dataclass(frozen=True)
class _Placed:
    own: MassProperties
    mass: Fraction
    center: list[Fraction]
    inertia: list[list[Fraction]]


def _place(part: Part, i: int) -> _Placed:
    """Return a part's mass properties in the composite's frame; those of a hole are negative."""
    body, sign = part.body, 1
    if isinstance(body, Uniform) and body.is_hole:
        body, sign = body.filled(), -1
    try:
        own = body.mass_properties()
    except InvalidParameter as fault:
        raise fault.inside("parts", i, "body") from None
    if own.mass is None or own.center_of_mass is None:
        raise InvalidParameter(
            ("parts", i, "body"),
            "have a known mass and centre of mass",
            remedy="give an inertia-tensor with mass and center_of_mass",
        )
    turn = rotation(part.attitude)
    at = exact_vector(own.center_of_mass, own.center_of_mass_tail)
    center = [
        Fraction(p) + sum((r * x for r, x in zip(row, at, strict=True)), Fraction(0))
        for p, row in zip(part.position, turn, strict=True)
    ]
    inertia = [[sign * x for x in row] for row in rotated(own.exact_inertia, turn)]
    return _Placed(own, sign * own.exact_mass, center, inertia)
