"""What connections become: rows of the table, and the forces that their multipliers are.

A row is written so that its multiplier is the force itself where one coordinate system allows it; where not, the force
is the multiplier times an affine polynomial (a component of a direction).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.errors import InvalidParameter, Path, PlacesDisagree
from core.multibody.algebra.directions import perpendicular, unit
from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    combined,
    constant,
    coordinate,
    degree,
    difference,
    dot,
    evaluated,
    product,
)
from core.multibody.table.connection_effects import Force, Kept, LevelRim, Limit, Push, Timed, Unilateral, WorkTerm
from core.multibody.table.coordinates import Coordinates
from core.multibody.table.frames import Point
from core.multibody.table.momenta import StateFunction
from core.multibody.table.table import Row

COMPONENTS = ("x", "y", "z")

AT_START, AT_BEGINNING = "at the start", "when it begins"
"""The moments at which a connection takes from the places what it holds, as faults say them."""

CLOSE = 1e-6
"""Relative mismatch of positions up to which rounded figures are taken to be meant as the connections say."""


class Measures:
    """Adds the rows of connections to the table of the bodies.

    Parameters
    ----------
    coordinates : Coordinates
    one_sided : bool
        Whether strings may go slack: they are then no rows, but stand in `unilateral`.
    sketch : bool
        Whether places need not satisfy the connections.
    """

    def __init__(self, coordinates: Coordinates, *, one_sided: bool = False, sketch: bool = False) -> None:
        self.one_sided, self.sketch = one_sided, sketch
        # Whether the connection that is added does not act at this time.
        self.waiting = False
        # When that connection takes from the places what it holds, as faults say it.
        self.moment = AT_START
        # The connections that act, by their numbers, with the coordinates at their beginning; None is the start.
        self.begun: Mapping[int, Sequence[Ball] | None] = {}
        self.start_places = list(coordinates.table.q)
        # What begins and ends, and blows, by their connections.
        self.timed: dict[str, Timed] = {}
        self.blows: dict[str, Push] = {}
        self.unilateral: list[Unilateral] = []
        self.coordinates, self.table = coordinates, coordinates.table
        self.numerals, self.dimension = coordinates.numerals, coordinates.dimension
        self.forces: list[Force] = []
        self.limits: list[Limit] = []
        self.works: list[WorkTerm] = []
        self.potential = ZERO
        # What has mass beside the bodies: its potential in gravity, and its momentum and angular momentum by name.
        self.fall: Poly = {}
        self.momenta: dict[str, tuple[StateFunction, StateFunction]] = {}
        self.conservative = True
        # Polynomials that keep their values all the time, or the scene is beyond what its connections mean.
        self.kept: list[Kept] = []
        self.level_rims: list[LevelRim] = []
        # The horizontal direction of a plane that spins about its vertical: rates along it press across the plane.
        self.pressed_by: list[Ball] | None = None
        # The coordinates of functions of time, by what they are functions of.
        self.functions_of_time: dict[tuple[object, ...], list[int]] = {}
        self._lengths: dict[tuple[str, ...], int] = {}
        self._inverses: dict[int, int] = {}

    @property
    def loose(self) -> bool:
        """Whether places need not satisfy the connection that is added: in a sketch, or while that does not act."""
        return self.sketch or self.waiting

    def hold(self, name: str, measure: Poly) -> int:
        """Add a measure that stays zero and return the number of its row."""
        self.table.rows.append(Row.held(name, measure))
        return len(self.table.rows) - 1

    def affine(self, name: str, own: str, unit: str, measure: Poly) -> Poly:
        """Return a measure as a polynomial of degree one, if need be by a coordinate that equals it."""
        if degree(measure) <= 1:
            return measure
        index = self.table.coordinate(own, unit, evaluated(measure, self.table.q))
        self.hold(name, difference(coordinate(index), measure))
        return coordinate(index)

    def roll(self, name: str, rates: LinearForm) -> int:
        """Add a combination of rates that stays zero and return the number of its row."""
        self.table.rows.append(Row(name, None, rates))
        return len(self.table.rows) - 1

    def force(self, name: str, terms: Sequence[tuple[int, Poly]], unit: str = "N") -> int:
        """Name a force that multipliers are, and return its number."""
        self.forces.append(Force(name, unit, list(terms)))
        return len(self.forces) - 1

    def coincide(self, name: str, a: Point, b: Point, path: Path) -> list[int]:
        """Hold two places together; the force is that on `a`."""
        if a.body is not None and a.body == b.body:
            raise InvalidParameter(path, "connect two different bodies, or a body and the ground")
        if a.body is None and b.body is None:
            raise InvalidParameter(path, "connect a body")
        rows = [self.hold(name, difference(x, y)) for x, y in zip(a.at, b.at, strict=True)]
        for axis, row in zip(COMPONENTS, rows, strict=False):
            self.force(f"{name}.{axis}", [(row, constant(ONE))])
        return rows

    def rod(self, name: str, a: Point, b: Point, length: object, drive: Poly | None, path: Path) -> None:
        """Hold two places at a distance, which may be driven; the force is the pull."""
        self._two(a, b, path)
        d = [difference(y, x) for x, y in zip(a.at, b.at, strict=True)]
        now = self.squared(d)
        if drive is not None:
            span = drive
        elif length is None:
            # What waits takes it where it begins.
            span = constant(ONE if self.waiting else now.sqrt())
        else:
            span = constant(self.numerals.number(length, (*path, "length")))
        size, where = evaluated(span, self.table.q), (*path, "length" if drive is None else "drive")
        if not size > 0:
            raise InvalidParameter(where, "be greater than 0 m", remedy="hold the places by a pin")
        if not self.loose and not abs(now - size * size) < CLOSE * (now + size * size):
            raise PlacesDisagree(
                where,
                f"be {float(now.sqrt()):.10g} m, as the places are apart {self.moment}",
                remedy="leave it out, or move the bodies",
            )
        half = ONE / 2
        row = self.hold(name, combined((half, dot(d, d)), (-half, product(span, span))))
        self.force(f"{name}.force", [(row, combined((-ONE, span)))])

    def squared(self, d: Sequence[Poly]) -> Ball:
        """Return the square of a vector at the start."""
        values = [evaluated(x, self.table.q) for x in d]
        return sum((x * x for x in values[1:]), values[0] * values[0])

    def length(self, name: str, a: Point, b: Point, path: Path) -> int:
        """Return the coordinate that is the distance of two places, made once for each pair."""
        self._two(a, b, path)
        key = tuple(sorted(repr(sorted(x.items())) for p in (a, b) for x in p.at))
        if key in self._lengths:
            return self._lengths[key]
        d = [difference(y, x) for x, y in zip(a.at, b.at, strict=True)]
        # What waits has the distance of its beginning.
        square = ONE if self.waiting else self.squared(d)
        if not square > 0:
            raise InvalidParameter(path, "start with its ends apart: the direction of its force is not determined")
        index = self.table.coordinate(f"{name}.length", "m", square.sqrt())
        half = ONE / 2
        self.hold(name, combined((half, {(index, index): ONE}), (-half, dot(d, d))))
        self.limits.append(Limit("singular", name, length=coordinate(index)))
        self._lengths[key] = index
        return index

    def shared(self) -> tuple[dict[tuple[str, ...], int], dict[int, int]]:
        """Return the coordinates that connections share: lengths, and one over lengths."""
        return dict(self._lengths), dict(self._inverses)

    def restore_shared(self, lengths: dict[tuple[str, ...], int], inverses: dict[int, int]) -> None:
        """Let no later connection share what has been added since: see `shared`."""
        self._lengths, self._inverses = lengths, inverses

    def inverse(self, name: str, length: int) -> int:
        """Return the coordinate that is one over a length, made once for each."""
        if length not in self._inverses:
            index = self.table.coordinate(f"{name}.inverse", "1/m", 1 / self.table.q[length])
            self.hold(name, {(length, index): ONE, (): -ONE})
            self._inverses[length] = index
        return self._inverses[length]

    def aligned(
        self, name: str, a: str | None, b: str | None, directions: Sequence[Sequence[Ball]], path: Path
    ) -> None:
        """Hold directions of body `a`, given in space at the start, in body `b`; the moment is that on `a`.

        The multipliers of a direction e are a vector, whose product e x lambda is their moment.
        """
        moment: list[list[tuple[int, Poly]]] = [[] for _ in range(1 if self.dimension == 2 else 3)]
        for components in directions:
            first = self.coordinates.vector_of(a, self.in_body(a, components), path)
            second = self.coordinates.vector_of(b, self.in_body(b, components), path)
            measures = [difference(x, y) for x, y in zip(first, second, strict=True)]
            rows = [self.hold(name, measure) if measure else None for measure in measures]
            for i, terms in enumerate(moment):
                j, k = (0, 1) if self.dimension == 2 else ((i + 1) % 3, (i + 2) % 3)
                for sign, arm, row in ((ONE, first[j], rows[k]), (-ONE, first[k], rows[j])):
                    if row is not None and arm:
                        terms.append((row, combined((sign, arm))))
        for axis, terms in zip(("",) if self.dimension == 2 else (".x", ".y", ".z"), moment, strict=True):
            self.force(f"{name}.moment{axis}", terms, "N m")

    def in_body(self, body: str | None, components: Sequence[Ball]) -> list[Ball]:
        """Return the body components of a vector that is given in space at the start."""
        if body is None or not self.coordinates.frames[body].orients:
            return list(components)
        frame, q = self.coordinates.frames[body], self.table.q
        if frame.direction is not None:
            c, s = (q[i] for i in frame.direction)
            return [c * components[0] + s * components[1], c * components[1] - s * components[0]]
        assert frame.axes is not None, "a top whose direction is held has all of its axes"
        return [sum((q[i] * x for i, x in zip(axis, components, strict=True)), ZERO) for axis in frame.axes]

    def unturned(self, name: str, a: Point, b: Point, path: Path) -> None:
        """Hold the orientation of one body to another."""
        frames = [None if point.body is None else self.coordinates.frames[point.body] for point in (a, b)]
        axes = all(frame is None or frame.orients for frame in frames)
        # A sketch moves angles beside their cosines and sines, which alone places follow.
        if not axes or (self.dimension == 2 and None not in frames and not self.sketch):
            turns = [{} if frame is None or frame.turn is None else coordinate(frame.turn) for frame in frames]
            if all(frame is None or frame.turn is not None for frame in frames):
                # One row, whatever the attitude: cosine and sine would need both, of which one follows from the other.
                apart = difference(*turns)
                row = self.hold(name, difference(apart, constant(evaluated(apart, self.table.q))))
                self.force(f"{name}.moment", [(row, constant(ONE))], "N m")
                return
        if not axes:
            # A particle has no orientation that could be held or hold.
            return
        unit = [[ONE if i == j else ZERO for j in range(self.dimension)] for i in range(self.dimension)]
        self.aligned(name, a.body, b.body, unit[: 1 if self.dimension == 2 else 3], path)

    def slide(self, name: str, a: Point, b: Point, along: Sequence[Ball], path: Path) -> None:
        """Hold place `a` on a line through `b`, whose direction is given in the axes of the body of `b`."""
        d = [difference(x, y) for x, y in zip(a.at, b.at, strict=True)]
        for number, components in enumerate(perpendicular(along, path)):
            normal = self.coordinates.vector_of(b.body, components, path)
            if max(map(degree, normal)) + max(map(degree, d)) > 2:
                raise InvalidParameter(path, "be simpler")
            row = self.hold(name, dot(normal, d))
            suffix = "normal" if self.dimension == 2 else f"normal.{number + 1}"
            self.force(f"{name}.{suffix}", [(row, constant(ONE))])

    def on_curve(self, name: str, p: Point, curve: Mapping[str, object], path: Path) -> None:
        """Hold a place on a line, circle, sphere, plane or parabola, of the ground or of a body."""
        where = (*path, "on")
        at = self.coordinates.point(self._field(curve, "at", where), (*where, "at"))
        if at.body is not None and at.body == p.body:
            raise InvalidParameter((*where, "at"), "belong to another body than the place")
        d = [difference(x, y) for x, y in zip(p.at, at.at, strict=True)]
        keys = set(curve) - {"at"}
        if keys == {"radius"}:
            radius = self.numerals.number(curve["radius"], (*where, "radius"))
            if not radius > 0:
                raise InvalidParameter((*where, "radius"), "be greater than 0 m")
            half = ONE / 2
            row = self.hold(name, combined((half, dot(d, d)), (-half, constant(radius * radius))))
            self.force(f"{name}.normal", [(row, constant(radius))])
            self._components(name, row, d)
        elif self.dimension == 3 and keys == {"normal"}:
            normal = self.coordinates.vector_of(at.body, self._unit(curve["normal"], (*where, "normal")), where)
            row = self.hold(name, dot(normal, d))
            self.force(f"{name}.normal", [(row, constant(ONE))])
        elif self.dimension == 3 and keys == {"direction"}:
            self.slide(name, p, at, self._unit(curve["direction"], (*where, "direction")), where)
        elif self.dimension == 2 and keys <= {"slope"}:
            cosine, sine = self.numerals.angle(curve.get("slope", 0), (*where, "slope"))
            normal = self.coordinates.vector_of(at.body, [-sine, cosine], where)
            row = self.hold(name, dot(normal, d))
            self.force(f"{name}.normal", [(row, constant(ONE))])
        elif self.dimension == 2 and keys <= {"slope", "curvature"}:
            self._parabola(name, d, at, curve, where)
        else:
            kinds = "slope; radius; curvature" if self.dimension == 2 else "direction; normal; radius"
            raise InvalidParameter(where, f"have at, and one of: {kinds}")

    def _parabola(self, name: str, d: list[Poly], at: Point, curve: Mapping[str, object], where: Path) -> None:
        curvature = self.numerals.number(curve["curvature"], (*where, "curvature"))
        cosine, sine = self.numerals.angle(curve.get("slope", 0), (*where, "slope"))
        tangent = self.coordinates.vector_of(at.body, [cosine, sine], where)
        normal = self.coordinates.vector_of(at.body, [-sine, cosine], where)
        x, y = dot(tangent, d), dot(normal, d)
        x = self.affine(name, f"{name}.along", "m", x)
        row = self.hold(name, combined((ONE, y), (-curvature / 2, product(x, x))))
        if at.body is None:
            # The gradient is normal - curvature x tangent, and the multiplier goes with it.
            parts = [
                combined((ONE, normal[i]), (-curvature * evaluated(tangent[i], self.table.q), x)) for i in range(2)
            ]
            self._components(name, row, parts)

    def _components(self, name: str, row: int, parts: Sequence[Poly]) -> None:
        for axis, part in zip(COMPONENTS, parts, strict=False):
            self.force(f"{name}.{axis}", [(row, part)])

    def _field(self, mapping: Mapping[str, object], key: str, path: Path) -> object:
        if not isinstance(mapping, Mapping) or key not in mapping:
            raise InvalidParameter((*path, key), "be given")
        return mapping[key]

    def _unit(self, value: object, path: Path) -> list[Ball]:
        vector = self.numerals.vector(value, path, self.dimension)
        return unit(vector, path)

    def _two(self, a: Point, b: Point, path: Path) -> None:
        if a.body is None and b.body is None:
            raise InvalidParameter(path, "connect a body")
        if a.body is not None and a.body == b.body:
            raise InvalidParameter(path, "connect two different bodies, or a body and the ground")
