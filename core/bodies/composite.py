"""Composite bodies: parts with a position and an attitude, which are added or, as holes, subtracted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Annotated, Any, Literal, NamedTuple

from core import bodies
from core.bodies.mass_moments import MassMoments
from core.bodies.mass_properties import About, MassProperties
from core.bodies.mesh import Mesh
from core.bodies.principal_inertia import DERIVED, ROUNDED_ONCE, Rounding
from core.bodies.uniform import Uniform
from core.bodies.validity import Condition
from core.errors import InvalidParameter, Path, UnphysicalInertia
from core.notices import Notice
from core.quantities import Position, Quaternion, check, members_of
from core.work import spend

MOST_PARTS = 1000
"""Largest number of bodies in a composite, those of nested composites included."""

DEEPEST = 8
"""Largest number of nested levels of composites, the outermost included."""

WORK_OF_A_PART = 100
"""Units of work (`core.work`): a part is turned, moved and added in rational numbers."""


@dataclass(frozen=True)
class Count:
    """Admissible lengths of a tuple."""

    at_least: int
    at_most: int

    def check(self, path: Path, value: object) -> None:
        """Raise `InvalidParameter` unless `value` is a tuple or list of such a length."""
        if not isinstance(value, (tuple, list)):
            raise InvalidParameter(path, "be a list")
        if not self.at_least <= len(value) <= self.at_most:
            raise InvalidParameter(path, f"have from {self.at_least} to {self.at_most} entries, not {len(value)}")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        # The upper limit is given to the validator as well, so that it never builds more entries.
        return {**handler(source), "max_length": self.at_most}

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return {**handler(schema), "minItems": self.at_least, "maxItems": self.at_most}


@dataclass(frozen=True)
class Part:
    """A body with its position and attitude in a composite.

    A point r of the body is at position + R r in the composite, with R the rotation of the attitude: the body is
    rotated about its own origin and then displaced.

    Attributes
    ----------
    body : Body
        With known mass and centre of mass. A solid or mesh of negative mass or density is a hole.
    position : tuple of 3 floats
        Origin of the part's frame, in the composite's frame (m).
    attitude : tuple of 4 floats
        Quaternion [w, x, y, z] from the part's axes to the composite's; any length but zero.
    hole : bool
        Whether the body is subtracted instead of added; for kinds of body that cannot have a negative mass.
    """

    body: bodies.Body
    position: Position = (0.0, 0.0, 0.0)
    attitude: Quaternion = (1.0, 0.0, 0.0, 0.0)
    hole: bool = False

    def __post_init__(self) -> None:
        check(self)
        if not isinstance(self.body, members_of(bodies.Body)):
            raise InvalidParameter("body", "be a body")
        if not isinstance(self.hole, bool):
            raise InvalidParameter("hole", "be true or false")
        if self.hole and isinstance(self.body, Uniform) and self.body.is_hole:
            raise InvalidParameter(
                "hole",
                "be false for a body of negative mass or density, which is a hole already",
                remedy="leave hole out, or give the mass or density of what is taken away as positive",
            )
        if not any(self.attitude):
            raise InvalidParameter(
                "attitude", "not be zero", remedy="give a unit quaternion [w, x, y, z]; [1, 0, 0, 0] is no turn"
            )
        if getattr(self.body, "about", "center-of-mass") != "center-of-mass":
            raise InvalidParameter(
                ("body", "about"),
                'be "center-of-mass" for a part of a composite',
                remedy="pin the outermost composite instead",
            )


@dataclass(frozen=True)
class Composite:
    """Bodies that are rigidly connected.

    Attributes
    ----------
    parts : sequence of Part
        At most 1000 bodies in all, nested at most 8 deep.
    about : {"center-of-mass", "origin"}
        The point about which the body turns. A free body turns about its centre of mass; "origin" is one pinned there.
    """

    parts: Annotated[tuple[Part, ...], Count(1, MOST_PARTS)]
    about: About = "center-of-mass"
    kind: Literal["composite"] = "composite"

    may_be_round = True

    def __post_init__(self) -> None:
        check(self)
        object.__setattr__(self, "parts", tuple(self.parts))
        for i, part in enumerate(self.parts):
            if not isinstance(part, Part):
                raise InvalidParameter(("parts", i), "be a part: a body, its position and its attitude")
            if isinstance(part.body, Composite) and part.body.depth >= DEEPEST:
                raise InvalidParameter(
                    ("parts", i, "body"),
                    f"be nested at most {DEEPEST} composites deep, the outermost included",
                    remedy="list its parts one level higher",
                )
        if self.count > MOST_PARTS:
            raise InvalidParameter(
                "parts",
                f"hold at most {MOST_PARTS} bodies in all, not {self.count}",
                remedy="give many small bodies as point-masses or as a mesh",
            )
        if self.about not in ("center-of-mass", "origin"):
            raise InvalidParameter("about", 'be "center-of-mass" or "origin"')

    @property
    def count(self) -> int:
        """Total number of bodies, those of nested composites included."""
        return sum(part.body.count if isinstance(part.body, Composite) else 1 for part in self.parts)

    @property
    def depth(self) -> int:
        """Levels of composites, this one included."""
        return 1 + max(part.body.depth if isinstance(part.body, Composite) else 0 for part in self.parts)

    def mass_properties(self) -> MassProperties:
        """Return the mass properties.

        A hole that extends beyond the other parts can leave a tensor that no mass distribution has. This is a warning,
        and an error if a principal moment is negative, because no motion is then defined.

        Raises
        ------
        InvalidParameter
            If the mass or centre of mass of a part is not known, the holes have at least the mass of the parts, or a
            result leaves the range of doubles.
        UnphysicalInertia
            If a principal moment is negative.
        """
        moments, wrong, warnings, conditions = _moments_of_parts(self)
        mass, center, inertia = moments.properties()
        trace = sum(inertia[k][k] for k in range(3))
        rounding = ROUNDED_ONCE
        if wrong.second > 0 and trace > 0:
            rounding = Rounding(max(DERIVED.share, float(wrong.second / trace)), False)
        found = MassProperties.from_exact(
            mass, center, inertia, warnings=warnings, conditions=conditions, rounding=rounding
        )
        if any(condition.name == "positive-moments" for condition in found.validity.violations):
            raise UnphysicalInertia(
                "parts",
                "have no negative principal moment together, and have "
                f"{float(found.principal.moments[0]):.6g} kg m^2: a hole is larger than what it is cut from",
                remedy="let each hole lie inside of what it is cut from",
            )
        far = max(map(abs, center))
        found = replace(
            found,
            about=self.about,
            described_by=self,
            mass_error=float(wrong.mass),
            center_of_mass_error=float((wrong.first + wrong.mass * far) / mass),
        )
        return found.with_validity_warning("parts")


class Wrong(NamedTuple):
    """What moments of mass may be wrong by: nothing where every part is exact (kg, kg m, kg m^2)."""

    mass: Fraction
    first: Fraction
    second: Fraction


EXACT = Wrong(Fraction(0), Fraction(0), Fraction(0))

_Moments = tuple[MassMoments, Wrong, tuple[Notice, ...], tuple[Condition, ...]]


def _moments_of_parts(composite: Composite) -> _Moments:
    """Return the moments of mass about the composite's origin, what was noticed, and what the report says.

    Second is what the moments may be wrong by.
    """
    total, wrong = MassMoments(), EXACT
    warnings: list[Notice] = []
    conditions: list[Condition] = []
    for i, part in enumerate(composite.parts):
        spend(WORK_OF_A_PART)
        try:
            moments, own, noticed, reported = _moments(part.body)
        except InvalidParameter as fault:
            raise fault.inside("parts", i, "body") from None
        placed = moments.turned(part.attitude).moved(part.position)
        total += -placed if part.hole else placed
        if own != EXACT:
            moved = _moved(own, moments, placed, Fraction(max(map(abs, part.position))))
            wrong = Wrong(*(a + b for a, b in zip(wrong, moved, strict=True)))
        warnings += [notice.inside("parts", i, "body") for notice in noticed]
        conditions += reported
    if not total.massive:
        raise InvalidParameter(
            "parts",
            "weigh more than the holes among them",
            remedy="add what the holes are cut from; a composite that is a hole as a whole is a part with hole: true",
        )
    return total, wrong, tuple(warnings), tuple(conditions)


def _moved(wrong: Wrong, moments: MassMoments, placed: MassMoments, shift: Fraction) -> Wrong:
    """Return what the moments of a part may be wrong by after it is turned and moved."""
    share = wrong.second / abs(moments.spread) if moments.spread else Fraction(0)
    # A turn mixes three coordinates by a unit vector, whose entries add up to less than 2.
    return Wrong(wrong.mass, 2 * wrong.first + wrong.mass * shift, share * abs(placed.spread))


def moments_of(body: Any) -> MassMoments:
    """Return the moments of mass of a body about its own origin; those of a hole are negative."""
    return _moments(body)[0]


def _moments(body: Any) -> _Moments:
    """Return the moments of mass of a body about its own origin; those of a hole are negative."""
    if isinstance(body, Composite):
        return _moments_of_parts(body)
    if isinstance(body, Uniform):
        shape = body.shape()
        mass = body.weigh(shape)
        exact = MassMoments.of(mass, shape.center_of_mass, [[mass * x for x in row] for row in shape.inertia])
        if not isinstance(body, Mesh):
            return exact, EXACT, (), ()
        solid = body.filled() if body.is_hole else body
        own = solid.mass_properties()
        return exact, _wrong(own, exact), own.warnings, own.conditions
    own = body.mass_properties()
    for name, known in (("mass", own.mass), ("center_of_mass", own.center_of_mass)):
        if known is None:
            raise InvalidParameter(
                (),
                f"have a known {name} to be a part of a composite",
                remedy="give an inertia-tensor with mass and center_of_mass, or another kind of body",
            )
    exact = MassMoments.of(own.exact_mass, own.exact_center_of_mass, own.exact_inertia)
    return exact, EXACT if own.rounding.exact_zeros else _wrong(own, exact), own.warnings, own.conditions


def _wrong(own: MassProperties, moments: MassMoments) -> Wrong:
    mass, far = Fraction(own.mass_error), max(map(abs, own.exact_center_of_mass))
    first = own.exact_mass * Fraction(own.center_of_mass_error) + mass * far
    return Wrong(mass, first, Fraction(own.rounding.share) * abs(moments.spread))
