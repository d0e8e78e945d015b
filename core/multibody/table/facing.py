"""Which edge or arc of an outline a corner may meet, from a state on.

A corner with a height above any edge touches nothing: that edge is watched. Otherwise it is on an edge, between whose
ends it stays for a while, or about a corner. What is nearest changes where a height or a position along an edge
passes through zero; signs at zero are those of the rates.

References
----------
M. C. Lin, J. F. Canny, "A fast algorithm for incremental distance calculation" (1991).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from core.multibody.algebra.polynomials import ZERO, Ball, Poly, change_by, evaluated, gradient, is_zero
from core.multibody.table.connection_effects import Facet, Unilateral


def facing(
    unilateral: Sequence[Unilateral], q: Sequence[Ball], v: Sequence[Ball], rounding: Sequence[Ball] = ()
) -> list[Unilateral]:
    """Return measures whose gaps are those of the facets that may be met from a state on.

    Parameters
    ----------
    rounding : sequence of ball
        Of coordinates: values that are no larger than what these change are zero. None where all are exact.
    """
    state, found = _State(q, v, rounding), []
    for one in unilateral:
        if one.facets:
            facet, near = _nearest(one, state)
            region = facet.region if near or not facet.edge else ()
            found.append(replace(one, gap=facet.gap, slip=facet.slip, region=region))
        else:
            found.append(one)
    return found


@dataclass(frozen=True)
class _State:
    """Values and rates of polynomials in a state."""

    q: Sequence[Ball]
    v: Sequence[Ball]
    rounding: Sequence[Ball] = ()

    def value(self, poly: Poly) -> Ball:
        found = evaluated(poly, self.q)
        rounded = self.rounding and bool(abs(found) < change_by(poly, self.q, self.rounding))
        return ZERO if is_zero(found) or rounded else found

    def rate(self, poly: Poly) -> Ball:
        found = sum((evaluated(part, self.q) * self.v[j] for j, part in gradient(poly).items()), ZERO)
        return ZERO if is_zero(found) else found


def _nearest(one: Unilateral, state: _State) -> tuple[Facet, bool]:
    """Return the facet that is to be watched, and whether the corner is on it or about it rather than above an edge."""
    edges = [facet for facet in one.facets if facet.edge]
    heights = [state.value(facet.gap) for facet in edges]
    highest = max(range(len(edges)), key=lambda k: float(heights[k].mid()))
    if heights[highest] > 0:
        return edges[highest], False
    level = [facet for facet, height in zip(edges, heights, strict=True) if height == 0]
    for facet in level:
        if _lies_in(facet, state, at_ends=one.first) and all(state.value(away) >= 0 for away, _ in facet.sides):
            return facet, True
    for facet in one.facets:
        if not facet.edge and _lies_in(facet, state, at_ends=True):
            return facet, True
    if level:
        # It leaves the end of an edge, along the line of another.
        return max(level, key=lambda facet: float(state.rate(facet.gap).mid())), False
    return edges[highest], True


def _lies_in(facet: Facet, state: _State, *, at_ends: bool) -> bool:
    """Return whether a corner is, or comes at once, where a facet is nearest; one that stays at an end may be in it."""
    for bound in facet.region:
        value = state.value(bound)
        if value == 0:
            value = state.rate(bound)
            if value == 0 and not at_ends:
                return False
        if value < 0:
            return False
    return True


def is_on_a_corner(one: Unilateral, q: Sequence[Ball], v: Sequence[Ball]) -> bool:
    """Return whether a corner that touches meets the end of an edge, along which none of its own edges lies."""
    state = _State(q, v)
    facet = next((facet for facet in one.facets if facet.gap is one.gap), None)
    if facet is None or not facet.sides:
        return False
    comes = state.rate(facet.gap) < 0
    for inwards, bound in zip((1, -1), facet.region, strict=True):
        along = any(state.value(away) == 0 and inwards * state.value(side) > 0 for away, side in facet.sides)
        if state.value(bound) == 0 and not along and (comes or state.rate(bound) == 0):
            return True
    return False
