"""Bodies of a description at other places, with other velocities, as numbers that are read back exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from math import floor, log10

from flint import arb

from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.assembly.exact_places import DIGITS
from core.multibody.language.body import SceneBody
from core.multibody.language.numerals import Numerals
from core.multibody.language.written import Number, Vector
from core.multibody.table.frames import Frame
from core.multibody.table.table import Table

DIGITS_OF_RATES = DIGITS - 10
"""Digits of velocities, which follow from places of `DIGITS` digits."""

BITS_OF_RATES = 1320
"""Precision at which they follow: 397 digits, to which the places satisfy the connections."""


def angle_between(frame: Frame, before: Sequence[Ball], after: Sequence[Ball]) -> Ball:
    """Return by how much a body of the plane is turned, between minus and plus half a turn (rad)."""
    if frame.direction is not None:
        c, s = frame.direction
        along = before[c] * after[c] + before[s] * after[s]
        across = before[c] * after[s] - before[s] * after[c]
        return ZERO if is_zero(across) and along > 0 else polar_angle(along, across)
    return ZERO if frame.turn is None else after[frame.turn] - before[frame.turn]


def turned_angle(frame: Frame, before: Sequence[Ball], after: Sequence[Ball]) -> Ball:
    """Return the angle by which a body is turned: in space about an axis, from zero to half a turn (rad)."""
    if frame.axes is None:
        return angle_between(frame, before, after)
    # Of a rotation the squares of the chords of three unit vectors sum up to 8 sin^2(angle / 2).
    squares = square_of([after[i] - before[i] for axis in frame.axes for i in axis])
    half = (squares / 8).sqrt() if squares > 0 else ZERO
    return 2 * half.min(arb(1)).asin()


def square_of(vector: Sequence[Ball]) -> Ball:
    """Return the square of the length of a vector."""
    return sum((x * x for x in vector), ZERO)


def placed_body(
    body: SceneBody, frame: Frame, table: Table, after: Sequence[Ball], start_angle: Ball, extent: float
) -> SceneBody:
    """Return a body of a description with the coordinates of other places; it keeps what does not change.

    Parameters
    ----------
    table : Table
        With the coordinates that the description has.
    start_angle : ball
        Of the description, in the plane (rad).
    extent : float
        Size of the scene (m), beside which places are rounded.
    """
    before = table.q
    if not same(frame.position, before, after, extent):
        body = replace(body, at=tuple(rounded(after[i], extent) for i in frame.position))
    if frame.axes is not None:
        if not all(same(axis, before, after, 1.0) for axis in frame.axes):
            body = replace(body, axes=tuple(tuple(rounded(after[i], 1.0) for i in axis) for axis in frame.axes))
        return body
    turned = angle_between(frame, before, after)
    if not is_zero(turned) and abs(turned) > arb(10) ** -(DIGITS - 10):
        degrees = rounded((start_angle + turned) * 180 / arb.pi(), 1.0)
        body = replace(body, angle={"degrees": degrees})
    return body


def moving_body(body: SceneBody, frame: Frame, table: Table, rates: Sequence[Ball], numerals: Numerals) -> SceneBody:
    """Return a body of a description with other rates in place of those that it gives."""
    path = ("bodies", frame.name)
    if body.velocity is not None:
        written = numerals.vector(body.velocity, (*path, "velocity"), len(frame.position))
        found = [rates[i] for i in frame.position]
        body = replace(body, velocity=_other_vector(body.velocity, written, found))
    if body.angular_velocity is None:
        return body
    given = body.angular_velocity
    if len(frame.position) == 2:
        rate = _rate_of_turn(frame, table, rates)
        if not _equal([numerals.number(given, (*path, "angular_velocity"))], [rate]):
            body = replace(body, angular_velocity=_significant(rate))
        return body
    if frame.axes is None and frame.turns is None:
        # Nothing sees how a ball is turned: it keeps the angular velocity that it has.
        return body
    assert not isinstance(given, (int, float, str)), "an angular velocity in space is a vector"
    written = numerals.vector(given, (*path, "angular_velocity"), 3)
    found = _angular_velocity(frame, table, rates)
    return replace(body, angular_velocity=_other_vector(given, written, found))  # type: ignore[arg-type]


def rounded(ball: Ball, extent: float, kept: int = DIGITS) -> Number:
    """Return a number to some digits beside a size: what is exact is found to be."""
    # A digit more or less does no harm, where the size is a power of ten.
    digits = kept - floor(log10(extent))
    power = arb(10) ** abs(digits)
    scaled = ball.mid() * power if digits >= 0 else ball.mid() / power
    whole = _whole((scaled.mid() + arb("0.5")).mid().floor())
    return Fraction(whole, 10**digits) if digits >= 0 else Fraction(whole * 10**-digits)


def _whole(ball: Ball) -> int:
    found = ball.unique_fmpz()
    assert found is not None, "a number without radius is a whole one or none"
    return int(found)


def same(indices: Sequence[int], before: Sequence[Ball], after: Sequence[Ball], extent: float) -> bool:
    """Return whether coordinates are the same to the digits to which places are found."""
    least = arb(10) ** -(DIGITS - 10) * extent
    return all(bool(abs(after[i] - before[i]) < least) for i in indices)


def _significant(ball: Ball) -> Number:
    size = float(abs(ball.mid()))
    return rounded(ball, size, DIGITS_OF_RATES) if size > 0.0 else 0


def _equal(written: Sequence[Ball], found: Sequence[Ball]) -> bool:
    scale = max(float(abs(x)) for x in (*written, *found))
    return all(bool(abs(x - y) <= arb(10) ** -(DIGITS - 15) * scale) for x, y in zip(written, found, strict=True))


def _other_vector(given: Vector, written: Sequence[Ball], found: Sequence[Ball]) -> Vector:
    if _equal(written, found):
        return given
    scale = max(float(abs(x)) for x in found)
    return tuple(rounded(x, scale, DIGITS_OF_RATES) for x in found) if scale > 0.0 else (0,) * len(found)


def _rate_of_turn(frame: Frame, table: Table, rates: Sequence[Ball]) -> Ball:
    if frame.direction is not None:
        c, s = frame.direction
        return table.q[c] * rates[s] - table.q[s] * rates[c]
    assert frame.turn is not None, "a body of the plane with an angular velocity can turn"
    return rates[frame.turn]


def _angular_velocity(frame: Frame, table: Table, rates: Sequence[Ball]) -> list[Ball]:
    """Return the angular velocity in body axes: half the sum of e x e' is that in space."""
    q = table.q
    if frame.axes is None:
        assert frame.turns is not None, "a body without axes rolls"
        assert frame.start_axes is not None, "a ball has axes at the start"
        return [sum((rates[j] * x for j, x in zip(frame.turns, own, strict=True)), ZERO) for own in frame.start_axes]
    space = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        space.append(sum(((q[e[j]] * rates[e[k]] - q[e[k]] * rates[e[j]]) / 2 for e in frame.axes), ZERO))
    return [sum((x * q[j] for x, j in zip(space, e, strict=True)), ZERO) for e in frame.axes]
