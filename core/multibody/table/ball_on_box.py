"""A ball, or a place, and a box in space: which of its faces, edges and corners the ball may meet.

With x the centre of the ball in axes of the box, from its middle, and h half of its sizes, the ball reaches the face of
axis i where |x_i| - h_i = r, an edge where the sum of two such squares is r^2, and a corner where that of three is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from core.errors import Path
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, constant, difference, dot, is_zero
from core.multibody.algebra.polynomials import product as times
from core.multibody.table.connection_effects import Facet
from core.multibody.table.contact_places import Side
from core.multibody.table.measures import Measures


@dataclass(frozen=True)
class _Axis:
    """Where a centre is along one axis of a box (m), and half the size of the box along it."""

    along: Poly
    half: Ball

    def beyond(self, sense: int) -> Poly:
        """Return how far it is beyond one of two faces (m)."""
        return combined((ONE * sense, self.along), (-self.half, constant(ONE)))

    def within(self) -> Iterator[Poly]:
        """Yield what is at or above zero between the two faces."""
        for sense in (1, -1):
            yield combined((-ONE, self.beyond(sense)))


def is_box(side: Side) -> bool:
    """Return whether a side is a box of space as a whole."""
    return side.frame is not None and side.frame.shape is not None and side.frame.shape.kind == "box"


def facets_of_box(measures: Measures, name: str, ball: Side, box: Side, path: Path) -> tuple[Facet, ...]:
    """Return what a ball may meet of a box: six faces, then twelve edges and eight corners, which a place does not."""
    low, high = box.offsets[0], box.offsets[6]
    middle = measures.coordinates.carried(str(box.body), [(x + y) / 2 for x, y in zip(low, high, strict=True)], path)
    apart = [difference(x, y) for x, y in zip(ball.points[0].at, middle.at, strict=True)]
    axes = []
    for i in range(3):
        unit = [ONE if k == i else ZERO for k in range(3)]
        line = dot(measures.coordinates.vector_of(box.body, unit, path), apart)
        along = measures.affine(name, f"{name}.beside.{i + 1}", "m", line)
        axes.append(_Axis(along, (high[i] - low[i]) / 2))
    faces = [
        Facet(
            combined((ONE, one.beyond(sense)), (-ball.radius, constant(ONE))),
            None,
            tuple(bound for other in axes if other is not one for bound in other.within()),
            edge=True,
        )
        for one in axes
        for sense in (1, -1)
    ]
    return (*faces, *(() if is_zero(ball.radius) else _rounded(axes, ball.radius)))


def _rounded(axes: Sequence[_Axis], radius: Ball) -> Iterator[Facet]:
    """Yield edges and corners, whose gap is (d^2 - r^2)/(2r) with d the distance of the centre."""
    for count in (2, 3):
        for chosen in combinations(axes, count):
            inside = [bound for axis in axes if axis not in chosen for bound in axis.within()]
            for senses in product((1, -1), repeat=count):
                beyond = [axis.beyond(sense) for axis, sense in zip(chosen, senses, strict=True)]
                squares = [(1 / (2 * radius), times(x, x)) for x in beyond]
                yield Facet(combined(*squares, (-radius / 2, constant(ONE))), None, (*beyond, *inside))
