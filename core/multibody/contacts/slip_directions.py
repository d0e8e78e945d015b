"""Directions of slip in space: along which way a contact slides, and along which it begins to.

Friction points against the slip. While something slides, the first of the two directions of its slip is turned into
that of the slip, so that the other has the rate zero. Where it is still to be found along which it will slide, after an
impact or from rest, it is the angle at which the slip that follows is along the slip assumed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import cos, pi, sin

from flint import arb, arb_mat, ctx

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, LinearForm, combined, is_zero
from core.multibody.contacts.contact_responses import across_rate, slip_rate
from core.multibody.table.connection_effects import Unilateral

Direction = tuple[Ball, Ball]
"""Cosine and sine of the angle with the first direction of slip."""
Slips = Sequence[Direction]
"""Directions of several contacts, or slips by their components."""

AHEAD: Direction = (ONE, ZERO)
"""The direction of the slip itself, in axes along it."""

_DIRECTIONS_TRIED = 48
"""Directions that are tried, evenly around."""
_MOST_CUTS = 100
"""Cuts between two samples: digits grow by a factor of 1.44 with each of them, so that some dozen reach 320 bits."""

_DESCRIBED = 2.0**-128
"""Share of a number below which its width is that of arithmetic in balls alone: pairs of doubles know 2^-106."""
_TURNS = 4
"""Times that directions of several contacts are turned into those that follow, before Newton's method: where all places
translate, the first time is exact; elsewhere they come near enough for it."""
_MOST_STEPS = 24
"""Turns and steps of Newton's method: its digits double, so that a dozen steps reach 1280 bits."""

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


def one_of(direction: Direction) -> Direction:
    """Return a direction without the width to which it is found: what moves on does so along one of them.

    A component that cannot be told from zero is: others would tie coordinates that have nothing to do with one another.
    """
    x, y = (ZERO if is_zero(component) else component for component in direction)
    return _unit(x, y)


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
        found[i] = turned(one, _unit(c, s))
    return found


def directions(after: Callable[[Direction], Direction | None], smooth: Direction = AHEAD) -> list[Direction]:
    """Return the directions in which slip may follow.

    Parameters
    ----------
    after : callable
        The components of the slip, or of its change, that follow if friction is against a direction; None where nothing
        follows.
    smooth : (ball, ball)
        Components of the slip that would follow without friction: what translates keeps that direction with it.
    """

    def off(direction: Direction) -> Ball | None:
        found = after(direction)
        return None if found is None else found[1] * direction[0] - found[0] * direction[1]

    # A direction of which a motion until now knows no more than pairs do keeps that width: what is across is within it.
    described = all(float(x.rad()) <= _DESCRIBED * abs(float(x.mid())) for x in smooth if not is_zero(x))
    for first in (AHEAD, one_of(smooth)) if described else (AHEAD,):
        follows = after(first)
        if follows is None:
            continue
        along, across = first[0] * follows[0] + first[1] * follows[1], first[0] * follows[1] - first[1] * follows[0]
        if is_zero(across) and (is_zero(along) or along > 0):
            return [first]
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
        gain = None if there is None else there[0] * root[0] + there[1] * root[1]
        # Where friction holds what pushes to the last, the slip grows with a later power of time.
        if gain is not None and (is_zero(gain) or gain > 0):
            found.append(root)
    return found


def directions_together(first: Slips, after: Callable[[Slips], Slips | None]) -> list[Direction] | None:
    """Return directions in which the slips of several contacts follow, each in its own; None if they are not found.

    Each direction is turned into that of the slip that follows; then by Newton's method, with the angles between the
    two as the residual and their differences as its derivatives.

    Parameters
    ----------
    first : sequence of Direction
        Components of slips, or of their changes, with which to begin.
    after : callable
        The components that follow if friction is against given directions; None where nothing follows.

    Returns
    -------
    list of Direction or None
        None at all where nothing follows, or one of the contacts would not slide.
    """
    slips: Slips | None = first
    if not any(is_zero(x) and is_zero(y) for x, y in first):
        # What translates keeps the direction that it would have without friction, also where that holds it to the last.
        straight = [one_of(slip) for slip in first]
        follows = after(straight)
        if follows is not None and all(map(_goes_along, straight, follows)):
            return straight
    assumed = [AHEAD] * len(first)
    width = 2.0 ** (_GUARD_OF_AN_ANGLE - ctx.prec)
    for step in range(_MOST_STEPS):
        if slips is None or any(is_zero(x) and is_zero(y) for x, y in slips):
            return []
        off = _angles(assumed, slips)
        ahead = all(c * x + s * y > 0 for (c, s), (x, y) in zip(assumed, slips, strict=True))
        if step and ahead and all(abs(x.mid()) < width or is_zero(x) for x in off):
            return _with_widths(assumed, off, after, width)
        change = _newton_step(assumed, off, after) if step > _TURNS and ahead else None
        if change is None:
            assumed = [_unit(*slip) for slip in slips]
        else:
            assumed = [_unit(c - x * s, s + x * c) for (c, s), x in zip(assumed, change, strict=True)]
        slips = after(assumed)
    return None


def _goes_along(direction: Direction, slip: Direction) -> bool:
    """Return whether a slip is along a direction, or none."""
    along, across = (
        direction[0] * slip[0] + direction[1] * slip[1],
        direction[0] * slip[1] - direction[1] * slip[0],
    )
    return is_zero(across) and (is_zero(along) or bool(along > 0))


def _with_widths(
    assumed: Slips, off: Sequence[Ball], after: Callable[[Slips], Slips | None], width: float
) -> list[Direction] | None:
    """Return directions that are found, as wide as they are known with the state; None where that is not determined."""
    widths: list[Ball] = [arb(width)] * len(assumed)
    if any(x.rad() > width for x in off):
        change = _newton_step(assumed, off, after)
        if change is None:
            return None
        widths = [arb(width) + 2 * abs(x).upper() for x in change]
    return [(arb(c, w), arb(s, w)) for (c, s), w in zip(assumed, widths, strict=True)]


def _angles(assumed: Slips, slips: Slips) -> list[Ball]:
    """Return the sines of the angles between slips and the directions assumed."""
    return [(c * y - s * x) / (x * x + y * y).sqrt() for (c, s), (x, y) in zip(assumed, slips, strict=True)]


def _newton_step(assumed: Slips, off: Sequence[Ball], after: Callable[[Slips], Slips | None]) -> list[Ball] | None:
    """Return by what the angles change, None where that is not determined."""
    # Differences are to be above what is known of the slips.
    known = max(float(x.rad()) for x in off)
    small = arb(max(2.0 ** (-ctx.prec // 2), known**0.5))
    columns = []
    for j, (c, s) in enumerate(assumed):
        moved = [*assumed[:j], _unit(c - small * s, s + small * c), *assumed[j + 1 :]]
        slips = after(moved)
        if slips is None:
            return None
        # Each angle is counted from the direction that it had before.
        columns.append([(x.mid() - y.mid()) / small for x, y in zip(_angles(assumed, slips), off, strict=True)])
    n = len(assumed)
    matrix = arb_mat([[columns[j][i] - (1 if i == j else 0) for j in range(n)] for i in range(n)])
    try:
        found: list[Ball] = matrix.solve(arb_mat([[-x] for x in off])).entries()
    except ZeroDivisionError:
        return None
    return found


def _unit(x: Ball, y: Ball) -> Direction:
    """Return a direction without the width of its components: it is a choice."""
    x, y = arb(x.mid()), arb(y.mid())
    size = (x * x + y * y).sqrt()
    return x / size, y / size


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
    if not abs(last) < max(abs(values[0].mid()), abs(values[1].mid())):
        # The force grows beyond all bounds between the ends and changes its sign there: no motion.
        return None
    # As wide as it is known with the state, by the slope between the ends.
    known = 2 * last.rad() * (ends[1] - ends[0]) / abs(values[1].mid() - values[0].mid())
    return _at(arb(second.mid(), known + 2.0 ** (_GUARD_OF_AN_ANGLE - ctx.prec)))


def _at(angle: Ball) -> Direction:
    sine, cosine = angle.sin_cos()
    return cosine, sine
