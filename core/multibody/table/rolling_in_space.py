"""Rolling without slip in space: on a plane, and a ball on or in a cylinder or a sphere.

With n the unit vector from the surface to the centre C, the ball touches at C - R n, and v_C - R w x n is the velocity
of the surface there. The angular velocity w in space enters by three coordinates whose rates it is: a ball with equal
moments needs no others, because then I w' is the torque.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import cross, perpendicular, unit
from core.multibody.algebra.polynomials import (
    ONE,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    coordinate,
    difference,
    dot,
    evaluated,
    is_zero,
)
from core.multibody.language.contacts import Rolling
from core.multibody.table.contact_places import Side, side_of
from core.multibody.table.frames import Point
from core.multibody.table.measures import COMPONENTS, Measures
from core.multibody.table.rolling import rate_of, rolling_in_plane, sum_of_rates
from core.multibody.table.rolling_on_planes import roll_on_plane
from core.multibody.table.rows import add_rows
from core.multibody.table.table import Row

Vector = Sequence[Ball]


@add_rows.register
def rolling(connection: Rolling, measures: Measures, name: str, path: Path) -> None:
    """Add the rows of what rolls, in the plane or in space."""
    (rolling_in_plane if measures.dimension == 2 else rolling_in_space)(measures, name, connection, path)


def rolling_in_space(measures: Measures, name: str, connection: Rolling, path: Path) -> None:
    """Add the rows of what rolls.

    Raises
    ------
    InvalidParameter
        Where nothing that rolls or no surface is named, or what rolls is not on the surface.
    """
    place, on = connection.place, connection.on
    if place is None or on is None or connection.a is not None or connection.b is not None:
        raise InvalidParameter(path, "have place and on: bodies that roll on one another in space are not answered yet")
    side = _side(measures, place, (*path, "place"))
    where = (*path, "on")
    if not isinstance(on, Mapping) or "at" not in on:
        raise InvalidParameter((*where, "at"), "be given")
    at = measures.coordinates.point(on["at"], (*where, "at"))
    if at.body is not None and (at.body == side.body or measures.coordinates.frames[at.body].orients):
        raise InvalidParameter((*where, "at"), "be a point of the ground, or of another body that does not turn")
    keys = set(on) - {"at"}
    if "normal" in keys and keys <= {"normal", "rate"}:
        roll_on_plane(measures, name, side, at, on["normal"], on.get("rate", 0), where)
        return
    if keys not in ({"direction", "radius"}, {"radius"}):
        raise InvalidParameter(where, "have at, and one of: normal (and rate); direction and radius; radius")
    if side.frame is None or side.frame.turns is None:
        raise InvalidParameter(
            where, "be a plane for a body that is not a ball about its centre of mass", remedy='have at and "normal"'
        )
    surface = _Surface(measures, name, side.points[0], side.radius, list(side.frame.turns), at, where)
    if "direction" in keys:
        surface.cylinder(on["direction"], on["radius"])
    else:
        surface.sphere(on["radius"])


def _side(measures: Measures, place: str, path: Path) -> Side:
    """Return what rolls: a ball about a place of its body, or a body whose shape is a disc, an ellipsoid or a ball."""
    centre = measures.coordinates.point(place, path)
    frame = measures.coordinates.frames[centre.body] if centre.body is not None else None
    if frame is not None and frame.name == place and frame.shape is not None and frame.radius is None:
        side = side_of(measures, place, path)
        if side.round and len(side.points) == 1:
            return side
        raise InvalidParameter(
            path,
            f"be a disc, an ellipsoid or a ball: a {frame.shape.kind} touches at several places",
            remedy="describe a contact with friction, which rolls where it sticks",
        )
    if frame is None or frame.radius is None or frame.turns is None:
        raise InvalidParameter(path, "belong to a body with a radius, or a shape that rolls, and moments of inertia")
    return Side([centre], [()], frame.radius, frame)


class _Surface:
    """What a ball rolls on."""

    def __init__(
        self, measures: Measures, name: str, centre: Point, radius: Ball, turns: list[int], at: Point, path: Path
    ) -> None:
        self.measures, self.name, self.radius, self.turns, self.path = measures, name, radius, turns, path
        self.d = [difference(x, y) for x, y in zip(centre.at, at.at, strict=True)]
        self.rates = [rate_of(x) for x in self.d]

    def cylinder(self, direction: object, radius: object) -> None:
        """Roll on a cylinder, or inside it where the radius is negative."""
        measures, name, table = self.measures, self.name, self.measures.table
        a = unit(measures.numerals.vector(direction, (*self.path, "direction"), 3), (*self.path, "direction"))
        first = perpendicular(a, self.path)[0]
        second = cross(a, first)
        reach = self._reach(radius)
        away = [self._along(f) for f in (first, second)]
        start = [evaluated(x, table.q) / reach for x in away]
        size = (start[0] * start[0] + start[1] * start[1]).sqrt()
        if not size > 0:
            raise InvalidParameter(self.path, "start with the ball beside the axis")
        n = [table.coordinate(f"{name}.normal.{i + 1}", "1", x / size) for i, x in enumerate(start)]
        table.rows.append(Row.held(name, {(n[0], n[0]): ONE, (n[1], n[1]): ONE, (): -ONE}))
        rows = [measures.hold(name, difference(away[i], {(n[i],): reach})) for i in range(2)]
        measures.force(f"{name}.normal", [(rows[i], coordinate(n[i])) for i in range(2)])
        # Along the axis, and around it, along a x n.
        spin = {
            j: combined((-self.radius * first[i], coordinate(n[1])), (self.radius * second[i], coordinate(n[0])))
            for i, j in enumerate(self.turns)
        }
        rising = measures.roll(name, sum_of_rates(*self._velocity(a), *((poly, _one(j)) for j, poly in spin.items())))
        around = [
            (combined((second[i], coordinate(n[0])), (-first[i], coordinate(n[1]))), self.rates[i]) for i in range(3)
        ]
        circling = measures.roll(name, sum_of_rates(*around, self._spin([-self.radius * x for x in a])))
        measures.force(f"{name}.friction.along", [(rising, constant(ONE))])
        measures.force(f"{name}.friction.around", [(circling, constant(ONE))])

    def sphere(self, radius: object) -> None:
        """Roll on a sphere, or inside it where the radius is negative.

        No two directions of the tangent plane serve everywhere on a sphere. So the three components of the velocity are
        held, from which the measure follows; it is for positions at the start, and to see that they keep to it.
        """
        measures, name = self.measures, self.name
        reach = self._reach(radius)
        n = [combined((1 / reach, x)) for x in self.d]
        rows = []
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            # Component i of w x n is w_j n_k - w_k n_j.
            parts = [(constant(ONE), self.rates[i])]
            parts.append((combined((-self.radius, n[k])), _one(self.turns[j])))
            parts.append((combined((self.radius, n[j])), _one(self.turns[k])))
            rows.append(measures.roll(name, sum_of_rates(*parts)))
        half = ONE / 2
        held = measures.hold(name, combined((half, dot(self.d, self.d)), (-half * reach * reach, constant(ONE))))
        # A multiplier of the measure pushes along d, by as much as d is long.
        for i, axis in enumerate(COMPONENTS):
            measures.force(f"{name}.{axis}", [(rows[i], constant(ONE)), (held, self.d[i])])
        normal = [(row, x) for row, x in zip(rows, n, strict=True)]
        measures.force(f"{name}.normal", [*normal, (held, constant(reach))])

    def _reach(self, radius: object) -> Ball:
        own = self.measures.numerals.number(radius, (*self.path, "radius"))
        reach = own + self.radius
        if 0 in reach or 0 in own or (own < 0 and reach > 0):
            raise InvalidParameter((*self.path, "radius"), "leave room: negative of a hollow larger than the ball")
        return reach

    def _along(self, direction: Vector) -> Poly:
        return combined(*((x, self.d[i]) for i, x in enumerate(direction)))

    def _velocity(self, direction: Vector) -> list[tuple[Poly, LinearForm]]:
        return [(constant(x), self.rates[i]) for i, x in enumerate(direction) if not is_zero(x)]

    def _spin(self, weights: Vector) -> tuple[Poly, LinearForm]:
        return constant(ONE), {j: constant(x) for j, x in zip(self.turns, weights, strict=True) if not is_zero(x)}


def _one(index: int) -> LinearForm:
    return {index: constant(ONE)}
