"""Where a ball, an ellipsoid or the rim of a disc touches a plane, from its orientation.

With n the normal, towards the free side, and nu_i its components along the body axes, an ellipsoid of semi-axes a_i
reaches h = sqrt(sum (a_i nu_i)^2) below its centre, with the point whose body coordinates are p_i = -a_i^2 nu_i/h. A
rim has one semi-axis that is zero; a ball has equal ones, so that both are affine in the axes of the body. Otherwise h
and p are coordinates without mass, held by h p_i = -a_i^2 nu_i and h = -sum p_i nu_i.

References
----------
R. T. Rockafellar, "Convex Analysis" (1970), section 13 (support functions).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.balls import raised
from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import cross
from core.multibody.algebra.polynomials import (
    ONE,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    coordinate,
    dot,
    entry,
    evaluated,
    is_zero,
    product,
)
from core.multibody.table.connection_effects import Limit
from core.multibody.table.contact_places import Side
from core.multibody.table.formulas_of_time import clock
from core.multibody.table.measures import Measures
from core.multibody.table.rolling import rate_of


@dataclass(frozen=True)
class Support:
    """How what is round about its corners reaches a plane.

    Attributes
    ----------
    depth : polynomial
        How far it reaches below a corner (m).
    lever : tuple of polynomial
        From the corner to the point that touches, in body axes (m); empty where nothing is about the corner.
    axes : three lists of int
        The coordinates of these axes.
    below : tuple of ball
        The same in space, of a ball without other coordinates than its turns.
    turns : tuple of int
        These coordinates.
    """

    depth: Poly
    lever: tuple[Poly, ...] = ()
    axes: Sequence[Sequence[int]] = ()
    below: tuple[Ball, ...] = ()
    turns: tuple[int, ...] = ()

    def velocity(self, relative: Sequence[Poly], e: Sequence[Ball]) -> list[tuple[Poly, LinearForm]]:
        """Return the terms of the velocity along a unit vector of the point that touches (m/s).

        Parameters
        ----------
        relative : sequence of polynomial
            From a point of the plane to the corner (m).
        """
        parts = [(constant(x), rate_of(relative[k])) for k, x in enumerate(e) if not is_zero(x)]
        for p, axis in zip(self.lever, self.axes, strict=True):
            parts.append((p, {j: constant(x) for j, x in zip(axis, e, strict=True) if not is_zero(x)}))
        if self.turns:
            spin = zip(self.turns, cross(self.below, e), strict=True)
            parts.append((constant(ONE), {j: constant(x) for j, x in spin if not is_zero(x)}))
        return parts

    def along(self, e: Sequence[Ball]) -> Poly:
        """Return the component along a unit vector of what leads from the corner to the point that touches (m)."""
        terms = [
            (ONE, product(p, combined(*((x, coordinate(j)) for j, x in zip(axis, e, strict=True)))))
            for p, axis in zip(self.lever, self.axes, strict=True)
        ]
        return combined(*terms)

    def carried(
        self,
        measures: Measures,
        names: tuple[str, str],
        d: Sequence[Poly],
        n: Sequence[Ball],
        e: Sequence[Ball],
        rate: Ball,
    ) -> tuple[Poly, LinearForm]:
        """Return the term of a slip along e by which a plane moves that turns about its normal at a rate (rad/s).

        The plane moves with rate n x r, where r leads from the point about which it turns to that which touches.

        Parameters
        ----------
        names : tuple of two strings
            Of the connection, and of a coordinate that may be needed for a component of r.
        d : sequence of polynomial
            From the point about which it turns to the corner (m).
        """
        f = cross(e, n)
        arm = combined((ONE, dot(list(map(constant, f)), d)), (ONE, self.along(f)))
        arm = measures.affine(names[0], names[1], "m", arm)
        return combined((-rate, arm)), {clock(measures): constant(ONE)}


def support(measures: Measures, name: str, side: Side, n: Sequence[Poly], path: Path, *, levers: bool) -> Support:
    """Return how a side reaches a plane.

    Parameters
    ----------
    n : three polynomials
        The normal of the plane, towards the free side.
    levers : bool
        Whether the point that touches is needed; the plane does not turn then.

    Raises
    ------
    InvalidParameter
        For a disc or cylinder whose whole rim touches at the start, and for a body without axes.
    """
    if not side.round:
        return Support({})
    if not side.semi_axes and not levers:
        return Support(constant(side.radius))
    frame = side.frame
    axes, turns = (None, None) if frame is None else (frame.axes, frame.turns)
    if turns is not None and not side.semi_axes:
        below = tuple(-side.radius * entry(x, ()) for x in n)
        return Support(constant(side.radius), below=below, turns=turns)
    if axes is None:
        raise InvalidParameter(
            path, "be left out for a round body that cannot turn", remedy="give the body its moments of inertia"
        )
    leaning = [
        measures.affine(name, f"{name}.leaning.{i + 1}", "1", dot(n, list(map(coordinate, axis))))
        for i, axis in enumerate(axes)
    ]
    if not side.semi_axes:
        lever = tuple(combined((-side.radius, x)) for x in leaning)
        return Support(constant(side.radius), lever, axes)
    squares = [a * a for a in side.semi_axes]
    table = measures.table
    reach = sum((a * raised(evaluated(x, table.q), 2) for a, x in zip(squares, leaning, strict=True)), ONE - ONE)
    if not reach > 0:
        raise InvalidParameter(
            path,
            "start inclined, above the plane too: of the level rim of a disc or cylinder no point is the lowest",
            remedy="turn the body by its axes, or describe places of its rim that touch",
        )
    h = table.coordinate(f"{name}.reach", "m", reach.sqrt())
    measures.limits.append(Limit("singular", name, length=coordinate(h)))
    if not levers:
        measures.hold(
            name, combined((ONE, {(h, h): ONE}), *((-a, product(x, x)) for a, x in zip(squares, leaning, strict=True)))
        )
        return Support(coordinate(h))
    points: list[Poly] = []
    for i, (a, x) in enumerate(zip(squares, leaning, strict=True)):
        if is_zero(a):
            points.append({})
            continue
        p = table.coordinate(f"{name}.lever.{i + 1}", "m", -a * evaluated(x, table.q) / table.q[h])
        measures.hold(name, combined((ONE, {(h, p): ONE}), (a, x)))
        points.append(coordinate(p))
    # Its gradient does not vanish with h as that of h^2 - sum (a_i nu_i)^2 does.
    measures.hold(name, combined((ONE, coordinate(h)), (ONE, dot(points, leaning))))
    return Support(coordinate(h), tuple(points), axes)
