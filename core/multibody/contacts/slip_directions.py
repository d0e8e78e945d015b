"""Directions of slip in space: along which way a contact slides, and along which it begins to.

Friction points against the slip. While something slides, the first of the two directions of its slip is turned into
that of the slip, so that the other has the rate zero. Where it is still to be found along which it will slide, after an
impact or from rest, it is the angle at which the slip that follows is along the slip assumed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import cos, pi, sin

from flint import arb, ctx

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, LinearForm, combined, is_zero
from core.multibody.contacts.contact_responses import across_rate, slip_rate
from core.multibody.table.connection_effects import Unilateral

Direction = tuple[Ball, Ball]
"""Cosine and sine of the angle with the first direction of slip."""

AHEAD: Direction = (ONE, ZERO)
"""The direction of the slip itself, in axes along it."""

_DIRECTIONS_TRIED = 48
"""Directions that are tried, evenly around."""
_MOST_CUTS = 100
"""Cuts between two samples: digits grow by a factor of 1.44 with each of them, so that some dozen reach 320 bits."""

_GUARD_OF_AN_ANGLE = 40
"""Bits to which the angle found is not trusted."""


def turned(one: Unilateral, direction: Direction) -> Unilateral:
    """Return a contact in space whose first direction of slip is another one."""
    if one.slip is None or one.across is None or one.tangents is None or direction == AHEAD:
        return one
    c, s = direction
    first, second = one.tangents
    return replace(
        one,
        slip=_sum(c, one.slip, s, one.across),
        across=_sum(-s, one.slip, c, one.across),
        tangents=(
            [c * x + s * y for x, y in zip(first, second, strict=True)],
            [c * y - s * x for x, y in zip(first, second, strict=True)],
        ),
    )


def _sum(a: Ball, first: LinearForm, b: Ball, second: LinearForm) -> LinearForm:
    found = {j: combined((a, first.get(j, {})), (b, second.get(j, {}))) for j in {*first, *second}}
    return {j: poly for j, poly in found.items() if poly}


def along_slip(
    unilateral: Sequence[Unilateral], chosen: Sequence[int], q: Sequence[Ball], v: Sequence[Ball]
) -> list[Unilateral]:
    """Return the measures, those chosen that slip in space turned into the direction in which they do."""
    found = list(unilateral)
    for i in chosen:
        one = found[i]
        if one.across is None:
            continue
        s, c = across_rate(one, q, v), slip_rate(one, q, v)
        if is_zero(s) and (is_zero(c) or c > 0):
            continue
        # The width to which rates are known is no width of the direction: that is a choice.
        x, y = arb(c.mid()), arb(s.mid())
        size = (x * x + y * y).sqrt()
        found[i] = turned(one, (x / size, y / size))
    return found


def directions(after: Callable[[Direction], Direction | None]) -> list[Direction]:
    """Return the directions in which slip may follow.

    Parameters
    ----------
    after : callable
        The components of the slip, or of its change, that follow if friction is against a direction; None where nothing
        follows.
    """

    def off(direction: Direction) -> Ball | None:
        found = after(direction)
        return None if found is None else found[1] * direction[0] - found[0] * direction[1]

    ahead = after(AHEAD)
    if ahead is not None and is_zero(ahead[1]) and (is_zero(ahead[0]) or ahead[0] > 0):
        return [AHEAD]
    # What is ahead but for rounding is between two samples.
    angles = [2 * pi * (k - 0.5) / _DIRECTIONS_TRIED for k in range(_DIRECTIONS_TRIED + 1)]
    values = [off((arb(cos(angle)), arb(sin(angle)))) for angle in angles]
    found = []
    for (a, left), (b, right) in zip(
        zip(angles, values, strict=True), list(zip(angles, values, strict=True))[1:], strict=False
    ):
        if left is None or right is None or (left.mid() > 0) == (right.mid() > 0):
            continue
        root = _between(off, (a, b), (left, right))
        if root is None:
            continue
        there = after(root)
        if there is not None and there[0] * root[0] + there[1] * root[1] > 0:
            found.append(root)
    return found


def _between(
    off: Callable[[Direction], Ball | None], ends: tuple[float, float], values: tuple[Ball, Ball]
) -> Direction | None:
    """Return the direction between two angles that is off by nothing, by the Illinois method.

    Of a bracket, the end that stays has its value halved, so that both ends move.
    """
    first, second = (arb(end) for end in ends)
    before, last = values
    for _ in range(_MOST_CUTS):
        following = arb((second - last * (second - first) / (last - before)).mid())
        value = off(_at(following))
        if value is None:
            return None
        if (value.mid() > 0) == (last.mid() > 0):
            before = before / 2
        else:
            first, before = second, last
        near = abs(following - second) < 2.0 ** (_GUARD_OF_AN_ANGLE - ctx.prec)
        second, last = following, value
        if near or is_zero(value):
            break
    return _at(arb(second.mid(), 2.0 ** (_GUARD_OF_AN_ANGLE - ctx.prec)))


def _at(angle: Ball) -> Direction:
    sine, cosine = angle.sin_cos()
    return cosine, sine
