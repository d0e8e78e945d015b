"""What the free places of curves and surfaces span."""

from __future__ import annotations

from flint import arb

from core.balls import precision
from core.multibody.algebra.polynomials import BITS, Poly, is_zero
from core.multibody.reduction.free_places import FreePlaces, tangent_directions
from core.multibody.table.table import Table

CIRCLE: Poly = {(0, 0): arb(1), (1, 1): arb(1), (): arb(-1)}
CYLINDER: Poly = CIRCLE
PLANE: Poly = {(2,): arb(1), (0,): arb(-2), (): arb(1)}


def table() -> Table:
    made = Table()
    for name, value in zip("xyz", (arb(6) / 10, arb(8) / 10, arb(2) / 10), strict=True):
        made.coordinate(f"p.{name}", "m", value)
    return made


def test_directions_are_those_that_the_measures_leave() -> None:
    with precision(BITS):
        (along,) = tangent_directions(table(), [CIRCLE])
        assert is_zero(along[0] * 6 + along[1] * 8)


def test_a_circle_spans_its_plane_and_an_ellipse_on_a_cylinder_its_own() -> None:
    with precision(BITS):
        circle = FreePlaces(table(), [CIRCLE], [CIRCLE])
        assert circle.span()
        assert circle.complement() == []
        ellipse = FreePlaces(table(), [CYLINDER, PLANE], [CYLINDER, PLANE])
        assert ellipse.span()
        (normal,) = ellipse.complement()
        # The plane z = 2 x - 1 through the start.
        assert is_zero(normal[0] + 2 * normal[2])
        assert 1 not in normal or is_zero(normal[1])


def test_places_that_other_measures_exclude_are_not_found() -> None:
    with precision(BITS):
        assert not FreePlaces(table(), [CYLINDER], [CYLINDER, PLANE]).span()
