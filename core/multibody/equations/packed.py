"""A table as arrays of doubles and their tails, in units of its own, for the compiled kernels.

Lengths, times and masses are scaled by powers of two, which is exact, so that coordinates, their changes and the
multipliers are of the order of one whatever the scene's units: nothing overflows at 1e100 m, and every tolerance is
relative to the scene.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from flint import arb

from core.arrays import Floats, Integers
from core.multibody.algebra.polynomials import ZERO, Ball
from core.multibody.algebra.recordable import deciding
from core.multibody.equations.expansion import expansion
from core.multibody.laws.kernel import PackedLaws
from core.multibody.laws.law import Law
from core.multibody.laws.samples import values_of
from core.multibody.laws.tape import Tape
from core.multibody.table.table import Table

GROUPS = {"1": 0, "m": 1, "rad": 2, "1/m": 3, "s": 5}
"""Coordinates of one unit share the scale by which steps are chosen."""
ANGLES = GROUPS["rad"]
"""The group of which one radian is the scale, wherever its coordinates are."""
FORCES = 4
"""The group of multipliers, whose steps are chosen as those of coordinates; a clock, beyond it, bounds none."""


class PackedSlides(NamedTuple):
    """Friction that turns with its slip; the last axis of arrays of numbers is (value, tail).

    Attributes
    ----------
    at : (d, 4)
        Of each: its row, the first of its entries in `Packed.lines`, its first coordinate in the arrays below, and how
        many of both there are.
    coordinates : (c,)
    along, across : (c, 2)
        The two constant lines of the slip.
    factor : (d, 2)
        The coefficient of friction below zero.
    finer : int
        1 where the unit of time is less than that of the scene, for a slip that is about to end.
    """

    at: Integers
    coordinates: Integers
    along: Floats
    across: Floats
    factor: Floats
    finer: int


class Packed(NamedTuple):
    """A table for the kernels; the last axis of every array of numbers is (value, tail).

    Attributes
    ----------
    mass : (n, n, 2)
    load : (n, 2)
    stiff, stiff_at : (p, 2) and (p, 2)
        Entries of K and their row and column.
    damp, damp_at : the same for D
    gyre, gyre_at : (p, 2) and (p, 3)
        Entries of B.
    lines, lines_at : (e, 2) and (e, 2)
        Entries of W that are not identically zero: constant part, row and column; after them those of X, of which
        those that turn with a slip are filled in for every state.
    slopes, slopes_at : (p, 2) and (p, 2)
        Their dependence on the coordinates: factor, entry, coordinate.
    offset : (m, 2)
        Constants of the measures.
    held : (m,)
        1 for a measure, 0 for a rate row.
    rate : (m, 2)
    group : (n,)
    binds : (e,)
        1 for an entry of W, 0 for one of X.
    laws : PackedLaws
    slides : PackedSlides
    """

    mass: Floats
    load: Floats
    stiff: Floats
    stiff_at: Integers
    damp: Floats
    damp_at: Integers
    gyre: Floats
    gyre_at: Integers
    lines: Floats
    lines_at: Integers
    slopes: Floats
    slopes_at: Integers
    offset: Floats
    held: Integers
    rate: Floats
    group: Integers
    binds: Integers
    laws: PackedLaws
    slides: PackedSlides


@dataclass(frozen=True)
class Units:
    """Exponents of two: a coordinate is 2^length[i] times its number in the kernels, and so on.

    Attributes
    ----------
    lengths : list of int
        Of each coordinate.
    time, action : int
        Of time, and of M times the square of a coordinate.
    rows : list of int
        Of each row: the kernels' row is the table's times 2^rows[r].
    """

    lengths: list[int]
    time: int
    action: int
    rows: list[int]

    @cached_property
    def up(self) -> Floats:
        """What the numbers of coordinates in the kernels are multiplied by, shape (n,)."""
        return np.array([two_to(e) for e in self.lengths])

    @cached_property
    def down(self) -> Floats:
        """What coordinates are multiplied by for the kernels, shape (n,)."""
        return np.array([two_to(-e) for e in self.lengths])

    def multiplier(self, row: int) -> int:
        """Return the exponent of a multiplier."""
        return self.action - 2 * self.time + self.rows[row]


@deciding
def exponent(ball: Ball) -> int | None:
    """Return the exponent of two of a number, None of zero."""
    if 0 in ball:
        return None
    mantissa, power = ball.mid().man_exp()
    return int(power) + int(abs(mantissa)).bit_length()


@deciding
def largest_exponent(balls: Sequence[Ball]) -> int | None:
    """Return the exponent of two of the largest of some numbers, None where all are zero or there are none."""
    return _most([exponent(x) for x in balls])


def pair(ball: Ball, power: int) -> tuple[float, float]:
    """Return a number times a power of two as an unevaluated sum of two doubles."""
    if type(ball) is not arb:
        # One that is recorded stands for those of all members.
        placed: tuple[float, float] = ball.pair(power)
        return placed
    middle = (ball * _two(power) if power else ball).mid()
    high = float(middle)
    return high, float(middle - high)


def nearest(ball: Ball) -> float:
    """Return the double nearest to the middle of a ball."""
    high, low = pair(ball, 0)
    return high + low


@lru_cache(maxsize=4096)
def _two(power: int) -> Ball:
    return (ZERO + 2) ** power


AT_ORIGIN = -24
"""Exponent of two of the share of its way within which a place is at the origin: events leave far less of it, also of
bounces of 2^-30 s, whose ways are 2^-60 m where places are known to 2^-92 m."""

ROUNDED = 60
"""Bits by which an acceleration is less than that of the loads where it is what rounding leaves of their balance: more
than doubles hold, and half of what pairs do."""


KNOWN = 88
"""Bits by which a place is less than the size of its body where it is what rounding leaves: events are known to 92."""


def _arms(table: Table) -> Iterator[int | None]:
    """Yield the exponents of lengths by which rows join a turn, or a direction, to a place."""
    for row in table.rows:
        # A constant beside a place that varies, as in the line of a length, may be what rounding leaves of zero.
        lines = {j: poly[()] for j, poly in row.rates.items() if poly.keys() == {()}}
        constant = {j: e for j, x in lines.items() if (e := exponent(x)) is not None}
        places = [e for j, e in constant.items() if table.units[j] == "m"]
        yield from (e - max(places) for j, e in constant.items() if places and table.units[j] in ("1", "rad"))


def _gyration(table: Table) -> list[int]:
    """Return the exponent of the radius of gyration of the heaviest bodies; nothing where none turns."""
    diagonal = [(table.units[i], exponent(x)) for (i, j), x in table.mass.items() if i == j]
    moves, turns = (_most([e for unit, e in diagonal if unit in units]) for units in (("m",), ("1", "rad")))
    return [] if moves is None or turns is None else [(turns - moves) // 2]


def units_of(table: Table, acceleration: Sequence[Ball]) -> Units:
    """Return units in which coordinates, rates and masses are of the order of one."""
    size, rate, pull = (_largest_of(table, x, ("m",)) for x in (table.q, table.v, acceleration))
    large = _most(_gyration(table))
    arms = _most([*_arms(table), large])
    if size is not None and arms is not None and size < arms - KNOWN:
        # A body at the origin, up to rounding.
        size = None
    turn, spin = (_largest_of(table, x, ("1", "rad")) for x in (table.v, acceleration))
    pushes = _pushes(table)
    heaviest = _most([*map(exponent, table.load.values()), *(e for _, e in pushes)])
    inert = _most([exponent(x) for (i, j), x in table.mass.items() if i == j])
    loaded = heaviest is not None and inert is not None
    if pull is not None and loaded and pull < (heaviest or 0) - (inert or 0) - ROUNDED:
        # What is left of loads that are balanced tells no scale.
        pull = None
    if spin is not None and loaded and size is not None and spin < (heaviest or 0) - (inert or 0) - size - ROUNDED:
        spin = None
    times = []
    if turn is not None:
        times.append(-turn)
    if spin is not None:
        times.append(-(spin // 2))
    times.extend(_times_of_formulas(table, at_origin=size is None))
    # What starts at the origin, or as near to it as rounding leaves an event, is measured by how far it comes until it
    # turns back, or something else has turned.
    ways = []
    if rate is not None and pull is not None:
        ways.append(2 * rate - pull)
    if times and (rate is not None or pull is not None):
        ways.append(rate + min(times) if rate is not None else (pull or 0) + 2 * min(times))
    # A turn that is nothing but rounding makes ways without end, and does not put at the origin what is farther from it
    # than a body is large.
    if size is None or (ways and size < min(ways) + AT_ORIGIN and (large is None or size < large + AT_ORIGIN)):
        size = min(ways, default=None)
    if arms is not None and (size is None or size < arms - KNOWN):
        # What rests at the origin, up to rounding, is measured by how large it is, or the arms at which it is held.
        size = arms
    size = 0 if size is None else size
    if rate is not None:
        times.append(size - rate)
    if pull is not None:
        times.append((size - pull) // 2)
    lengths = [{"1": 0, "rad": 0, "m": size, "1/m": -size, "s": 0}[unit] for unit in table.units]
    masses = [e + lengths[i] + lengths[j] for (i, j), x in table.mass.items() if (e := exponent(x)) is not None]
    works = [e + lengths[i] + lengths[j] for (i, j), x in table.stiffness.items() if (e := exponent(x)) is not None]
    works += [e + lengths[i] for i, x in table.load.items() if (e := exponent(x)) is not None]
    works += [e + lengths[i] for i, e in pushes]
    if masses and works:
        # Beside an equilibrium neither rates nor accelerations tell how fast springs swing and loads pull.
        times.append((max(masses) - max(works)) // 2)
    drags = [e + lengths[i] + lengths[j] for (i, j), x in table.damping.items() if (e := exponent(x)) is not None]
    if masses and drags:
        # Nor do they tell how fast dampers bring to rest what moves by rounding.
        times.append(max(masses) - max(drags))
    time = min(times, default=0)
    lengths = [time if unit == "s" else length for unit, length in zip(table.units, lengths, strict=True)]
    rows = []
    for row in table.rows:
        terms = [
            e + lengths[j] + (lengths[key[0]] if key else 0)
            for j, poly in row.rates.items()
            for key, x in poly.items()
            if (e := exponent(x)) is not None
        ]
        rows.append(-max(terms, default=0))
    return Units(lengths, time, max(masses, default=0), rows)


def _largest_of(table: Table, numbers: Sequence[Ball], units: Sequence[str]) -> int | None:
    """Return the exponent of the largest number of the coordinates that have some units."""
    return largest_exponent([x for x, unit in zip(numbers, table.units, strict=True) if unit in units])


def _pushes(table: Table) -> list[tuple[int, int]]:
    """Return coordinates that formulas push, and exponents of the largest terms of which these forces are sums."""
    acting = table.acting
    if not acting:
        return []
    q, v = (np.array([[[float(x.mid()), 0.0] for x in state]]) for state in (table.q, table.v))
    found = []
    for law in acting:
        size = float(values_of(law, q, v)[1][0])
        if 0.0 < size < math.inf:
            found += [(i, math.frexp(size)[1] + e) for i, x in law.push.items() if (e := exponent(x)) is not None]
    return found


HIGHEST_POWER = 5
"""Of time by which a formula tells how fast it changes: a square of what passes through zero moves it by the fourth."""


def _times_of_formulas(table: Table, *, at_origin: bool) -> list[int]:
    """Return in what times formulas change the motion, as exponents: where they vanish their values do not tell.

    Over the time that a power of the series takes to come up to a place, or what a rate makes of it. Where all is
    `at_origin`, places tell nothing.
    """
    if not table.acting:
        return []
    places, found = expansion(table, HIGHEST_POWER).places, []
    for units in (("m",), ("1", "rad")):
        own = [place for place, unit in zip(places, table.units, strict=True) if unit in units]
        sizes = [_most([exponent(place[k]) for place in own]) for k in range(HIGHEST_POWER + 1)]
        if at_origin and units == ("m",):
            sizes[0] = None
        for k, size in enumerate(sizes):
            ways = (
                []
                if size is None or k < 2
                else [(x - size) // (k - j) for j, x in enumerate(sizes[:2]) if x is not None]
            )
            if ways:
                found.append(max(ways))
    return [min(found)] if found else []


def _most(exponents: Sequence[int | None]) -> int | None:
    return max((e for e in exponents if e is not None), default=None)


def packed(table: Table, chosen: Sequence[int], units: Units) -> Packed:
    """Return the arrays of a table with the rows chosen, in the units given."""
    n, s, t, w = len(table.names), units.lengths, units.time, units.action
    mass = np.zeros((n, n, 2))
    for (i, j), x in table.mass.items():
        mass[i, j] = mass[j, i] = pair(x, s[i] + s[j] - w)
    load = np.zeros((n, 2))
    for i, x in table.load.items():
        load[i] = pair(x, s[i] + 2 * t - w)
    stiff = [pair(x, s[i] + s[j] + 2 * t - w) for (i, j), x in table.stiffness.items()]
    damp = [pair(x, s[i] + s[j] + t - w) for (i, j), x in table.damping.items()]
    gyre = [pair(x, s[i] + s[j] + s[k] + t - w) for (i, j, k), x in table.gyration.items()]
    lines, lines_at, slopes, slopes_at = [], [], [], []
    offset, rate, held = np.zeros((len(chosen), 2)), np.zeros((len(chosen), 2)), np.zeros(len(chosen), np.int64)
    for number, r in enumerate(chosen):
        row, up = table.rows[r], units.rows[r]
        for j, poly in row.rates.items():
            lines.append(pair(poly.get((), ZERO), s[j] + up))
            lines_at.append((number, j))
            for key, x in poly.items():
                if key:
                    slopes.append(pair(x, s[j] + s[key[0]] + up))
                    slopes_at.append((len(lines) - 1, key[0]))
        if row.measure is not None:
            held[number] = 1
            offset[number] = pair(row.measure.get((), ZERO), up)
        rate[number] = pair(row.rate, up + t)
    binding = len(lines)
    for number, r in enumerate(chosen):
        row, up = table.rows[r], units.rows[r]
        for j, poly in row.drag.items() if row.slide is None else ():
            lines.append(pair(poly.get((), ZERO), s[j] + up))
            lines_at.append((number, j))
            slopes.extend(pair(x, s[j] + s[key[0]] + up) for key, x in poly.items() if key)
            slopes_at.extend((len(lines) - 1, key[0]) for key in poly if key)
    slides = _packed_slides(table, chosen, units, len(lines))
    for number, _, first, count in slides.at.tolist():
        lines.extend([(0.0, 0.0)] * count)
        lines_at.extend((number, j) for j in slides.coordinates[first : first + count].tolist())
    return Packed(
        mass,
        load,
        _numbers(stiff),
        _indices(list(table.stiffness), 2),
        _numbers(damp),
        _indices(list(table.damping), 2),
        _numbers(gyre),
        _indices(list(table.gyration), 3),
        _numbers(lines),
        _indices(lines_at, 2),
        _numbers(slopes),
        _indices(slopes_at, 2),
        offset,
        held,
        rate,
        np.array([GROUPS[unit] for unit in table.units], dtype=np.int64),
        (np.arange(len(lines)) < binding).astype(np.int64),
        _packed_laws(table, units),
        slides,
    )


def _packed_slides(table: Table, chosen: Sequence[int], units: Units, before: int) -> PackedSlides:
    """Return the friction of rows chosen that turns with its slip, whose entries follow those before."""
    at, coordinates, lines, factors = list[tuple[int, ...]](), list[int](), [list[tuple[float, float]](), []], []
    for number, r in enumerate(chosen):
        slide = table.rows[r].slide
        if slide is None:
            continue
        factor, along, across = slide
        own = sorted({*along, *across})
        at.append((number, before + len(coordinates), len(coordinates), len(own)))
        factors.append(pair(factor, 0))
        for line, numbers in zip((along, across), lines, strict=True):
            numbers.extend(pair(line.get(j, {}).get((), ZERO), units.lengths[j] + units.rows[r]) for j in own)
        coordinates.extend(own)
    forms = [_numbers(line) for line in lines]
    return PackedSlides(
        _indices(at, 4), np.array(coordinates, dtype=np.int64), forms[0], forms[1], _numbers(factors), 0
    )


def _packed_laws(table: Table, units: Units) -> PackedLaws:
    """Return the laws of a table: their values are in SI units, along the time of the kernels."""
    tape, s, t = Tape.of(table.acting), units.lengths, units.time
    push = [
        (pair(x, s[i] + 2 * t - units.action), i, output)
        for law, output in zip(table.acting, tape.outputs, strict=True)
        for i, x in law.push.items()
    ]
    return PackedLaws(
        _indices(tape.operations, 5),
        _numbers([pair(x, 0) for x in tape.numbers]),
        _numbers([pair(x, s[i] - t if rate else s[i]) for i, x, rate in tape.terms]),
        np.array([i for i, _, _ in tape.terms], dtype=np.int64),
        _numbers([x for x, _, _ in push]),
        _indices([(i, output) for _, i, output in push], 2),
        int(not tape.is_polynomial_in({i for i, unit in enumerate(table.units) if unit == "s"})),
    )


def packed_values(laws: Sequence[Law]) -> PackedLaws:
    """Return laws in SI units, each of which pushes a coordinate of its number by its value."""
    tape = Tape.of(laws)
    return PackedLaws(
        _indices(tape.operations, 5),
        _numbers([pair(x, 0) for x in tape.numbers]),
        _numbers([pair(x, 0) for _, x, _ in tape.terms]),
        np.array([i for i, _, _ in tape.terms], dtype=np.int64),
        _numbers([(1.0, 0.0)] * len(laws)),
        _indices(list(enumerate(tape.outputs)), 2),
        1,
    )


def state(table: Table, units: Units) -> tuple[Floats, Floats]:
    """Return coordinates and rates at the start, each of shape (n, 2)."""
    q = [pair(x, -units.lengths[i]) for i, x in enumerate(table.q)]
    v = [pair(x, units.time - units.lengths[i]) for i, x in enumerate(table.v)]
    return _numbers(q), _numbers(v)


def two_to(power: int) -> float:
    """Return a power of two as a double, infinite or zero beyond their range."""
    return math.ldexp(1.0, power) if -1074 <= power <= 1023 else (math.inf if power > 0 else 0.0)


def _numbers(values: Sequence[tuple[float, float]]) -> Floats:
    return np.array(values, dtype=np.float64).reshape(-1, 2)


def _indices(values: Sequence[tuple[int, ...]], width: int) -> Integers:
    return np.array(values, dtype=np.int64).reshape(-1, width)
