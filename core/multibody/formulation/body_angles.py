"""Angles of bodies as formulas of the coordinates, with the whole turns that they start with."""

from __future__ import annotations

from collections.abc import Mapping

from core.formulas import Node
from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.polynomials import ONE, Ball, is_zero
from core.multibody.formulation.formula_nodes import call, node_of_sum, number
from core.multibody.formulation.trigonometric_sums import Sum, Term, Wave, added


def angle_of_body(cosine: Sum, sine: Sum, given: Ball, start: Mapping[str, Ball]) -> Node:
    """Return the angle with a cosine and a sine.

    Where these are those of an affine function of the coordinates it is that function, with all its turns, and
    otherwise an `atan2`, which tells later turns no more than any.

    Parameters
    ----------
    cosine, sine : Sum
    given : ball
        The angle at the start (rad).
    start : mapping of str to ball
        Of the coordinates.
    """
    if cosine.constant() is not None and sine.constant() is not None:
        return number(given)
    waves = {term.wave for one in (cosine, sine) for term in one.terms}
    if len(waves) == 1 and (wave := waves.pop()):
        angle = added(Sum.variable(name).times(ONE * factor) for name, factor in wave)
        for way in (ONE, -ONE):
            offset = given - way * angle.value(start)
            if _is_angle(cosine, sine, wave, way, offset):
                return node_of_sum(angle.times(way) + Sum.number(offset))
    found = call("atan2", node_of_sum(sine), node_of_sum(cosine))
    whole = 2 * ONE.pi()
    turns = round(float((given - polar_angle(cosine.value(start), sine.value(start))) / whole))
    return found if turns == 0 else Node("+", inner=(found, number(turns * whole)))


def _is_angle(cosine: Sum, sine: Sum, wave: Wave, way: Ball, offset: Ball) -> bool:
    """Return whether two sums are cosine and sine of a wave, one way or the other, and an offset."""
    s, c = offset.sin_cos()
    even, odd = Term(function="cos", wave=wave), Term(function="sin", wave=wave)
    left = (cosine - Sum({even: c, odd: -way * s}), sine - Sum({odd: way * c, even: s}))
    return all(is_zero(x) for one in left for x in one.terms.values())
