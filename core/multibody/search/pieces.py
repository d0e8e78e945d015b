"""A motion as Taylor polynomials of coordinates, rates and multipliers on consecutive intervals of time.

The state at the start of an interval is the motion's own, whatever its model: closed forms know it at any time, series
from their steps. So the polynomials of a later interval are as right as those of the first one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import dd_add, dd_mul
from core.errors import AccuracyUnreachable, NotApplicable
from core.formulas import names_of
from core.multibody.algebra.polynomials import ZERO, LinearForm, Poly, coordinate
from core.multibody.algebra.square_inverse import padded
from core.multibody.equations.packed import Packed, Units, packed_values, two_to
from core.multibody.laws.kernel import values_of_laws
from core.multibody.laws.law import Input, Law
from core.multibody.motion.whole import Whole, spread
from core.multibody.search.curves import Curve, differentiate
from core.multibody.search.taylor import ORDER, expand
from core.multibody.table.connection_effects import Force

PAST_A_PERIOD = 1.0 + 2.0**-20
"""A period and a millionth of it, so that a zero at its end, and what touches a value there, are within."""

UNKNOWN = 2.0**900
"""Size of what may have any value, of which squares of shares are still doubles."""

COEFFICIENTS = ORDER - 1
"""Of every curve: multipliers have two powers less than coordinates."""


@dataclass(frozen=True)
class Pieces:
    """A motion on some intervals.

    Attributes
    ----------
    lengths : ndarray, shape (p,)
        In seconds, negative where time runs backwards; powers of two.
    natural : ndarray, shape (p,)
        How long they could be, were no more of interest; less than their lengths where a corner ends them.
    places, multipliers : ndarrays, shape (p, n, order + 1, 2) and (p, rows, order - 1, 2)
        Coefficients of powers of time as a share of the length.
    place_sizes, multiplier_sizes : ndarrays, shape (p, n, order + 1) and (p, rows, order - 1)
        Of the terms that these consist of.
    """

    lengths: Floats
    natural: Floats
    places: Floats
    place_sizes: Floats
    multipliers: Floats
    multiplier_sizes: Floats

    @property
    def shape(self) -> tuple[int, int]:
        """Intervals, and coefficients of a curve."""
        return len(self.lengths), COEFFICIENTS

    @property
    def cut(self) -> NDArray[np.bool_]:
        """Which pieces end at a corner of a formula, shape (p,)."""
        found: NDArray[np.bool_] = self.natural < np.abs(self.lengths)
        return found

    def shortened(self, lengths: Floats) -> Pieces:
        """Return the pieces with other lengths, shape (p,), that are no longer and powers of two as well."""
        ratio = lengths / np.abs(self.lengths)
        powers = ratio[:, None, None] ** np.arange(self.places.shape[2])
        own = powers[..., : self.multipliers.shape[2]]
        return Pieces(
            ratio * self.lengths,
            self.natural,
            self.places * powers[..., None],
            self.place_sizes * powers,
            self.multipliers * own[..., None],
            self.multiplier_sizes * own,
        )

    def place(self, i: int) -> Curve:
        """Return a coordinate."""
        return Curve(
            np.ascontiguousarray(self.places[:, i, :COEFFICIENTS]),
            np.ascontiguousarray(self.place_sizes[:, i, :COEFFICIENTS]),
        )

    def rate(self, i: int) -> Curve:
        """Return its rate."""
        values = np.empty((*self.shape, 2))
        differentiate(np.ascontiguousarray(self.places[:, i]), self.lengths, values)
        powers = np.arange(1.0, COEFFICIENTS + 1.0)
        sizes = powers * self.place_sizes[:, i, 1 : COEFFICIENTS + 1] / np.abs(self.lengths)[:, None]
        return Curve(values, sizes)

    def multiplier(self, row: int) -> Curve:
        """Return the multiplier of a row."""
        return Curve(
            np.ascontiguousarray(self.multipliers[:, row]), np.ascontiguousarray(self.multiplier_sizes[:, row])
        )

    def nothing(self) -> Curve:
        """Return zero."""
        return Curve.constant(ZERO, self.shape)

    def of(self, poly: Poly) -> Curve:
        """Return a polynomial of the coordinates."""
        total = self.nothing()
        for key, factor in poly.items():
            if not key:
                total = total.plus(factor, Curve.constant(ZERO + 1, self.shape))
            else:
                term = self.place(key[0])
                for i in key[1:]:
                    term = term.times(self.place(i))
                total = total.plus(factor, term)
        return total

    def of_rates(self, line: LinearForm) -> Curve:
        """Return a linear form in the rates."""
        total = self.nothing()
        for j, poly in line.items():
            total = total.plus(ZERO + 1, self.of(poly).times(self.rate(j)))
        return total

    def law(self, law: Law) -> Curve:
        """Return the value of a formula of one piece."""
        inputs = {name: one for name, one in law.inputs.items() if name in names_of(law.root)}
        # Every input is a coordinate of its own, so that rates have the powers of their own series.
        own = {name: Input(coordinate(k)) for k, name in enumerate(inputs)}
        laws = packed_values([replace(law, inputs=own, push={})])
        curves = [self.of_input(one) for one in inputs.values()]
        path = np.zeros((len(self.lengths), 2, (COEFFICIENTS + 1) * len(curves)))
        largest = np.zeros(self.shape)
        for k, curve in enumerate(curves):
            path[:, :, k : COEFFICIENTS * len(curves) : len(curves)] = np.swapaxes(curve.values, 1, 2)
            largest = np.maximum(largest, curve.sizes)
        values, sizes = np.zeros((*self.shape, 2)), np.zeros(self.shape)
        for p, each in enumerate(path):
            space = np.zeros((len(laws.operations), COEFFICIENTS, 2))
            for k in range(COEFFICIENTS):
                values_of_laws(laws, each, len(curves), k, 1.0, space)
            values[p], sizes[p] = space[laws.push_at[0, 1]], np.abs(space[..., 0]).max(axis=0)
        # Beyond its domain nothing is known of it, not even at the start of a piece.
        beyond = ~np.isfinite(values).all(axis=(1, 2))
        values[beyond], sizes[beyond] = 0.0, UNKNOWN
        return Curve(values, np.maximum(sizes, largest))

    def of_input(self, given: Input) -> Curve:
        """Return what a name of a formula stands for."""
        if not given.rate:
            return self.of(given.form)
        return self.of_rates({key[0]: {(): slope} for key, slope in given.form.items() if key})

    def force(self, force: Force) -> Curve:
        """Return a force.

        Raises
        ------
        NotApplicable
            For a force that is a formula.
        """
        if force.of_laws:
            raise NotApplicable(
                f'"{force.name}" is a formula: when it takes a value, and how large it becomes, is not answered yet',
                path=("outputs",),
                remedy="ask for its samples, by forces-in-time",
            )
        total = self.of(force.of_state)
        for j, factor in force.of_rates.items():
            total = total.plus(factor, self.rate(j))
        for j, factor in force.of_squares.items():
            rate = self.rate(j)
            total = total.plus(factor, rate.times(rate))
        for row, poly in force.terms:
            total = total.plus(ZERO + 1, self.of(poly).times(self.multiplier(row)))
        return total


class Expanded(Protocol):
    """A motion that is expanded about any of its times."""

    def __call__(self, times: Floats, reach: Floats) -> Pieces:
        """Return pieces that begin at times of shape (p,) and are as long as their polynomials hold, or reach."""


@dataclass(frozen=True)
class ExpandedWhole:
    """The motion of a whole scene with its multipliers, from its states in pairs: its table as described is expanded.

    Attributes
    ----------
    whole : Whole
    kind : {"fine", "check", "reference", "doubles"}
        Which of the runs of a motion without a closed form.
    coarse : bool
        Whether a few roundings of doubles will do for closed forms.
    """

    whole: Whole
    kind: str = "fine"
    coarse: bool = False

    def __call__(self, times: Floats, reach: Floats) -> Pieces:
        """Return the pieces.

        Raises
        ------
        AccuracyUnreachable
            At a place where the connections lose their rank.
        """
        arrays, units, chosen = self.whole.arrays
        rows = len(self.whole.measures.table.rows)
        own = _from_steps(self.whole, self.whole.parts_of(None), self.kind, times, reach)
        if own is not None:
            return _with_all_rows(units, chosen, rows, *_with_multipliers(arrays, units, *own))
        return expanded_from(arrays, units, chosen, rows, self._states(times), reach)

    def _states(self, times: Floats) -> tuple[Floats, Floats]:
        if not self.coarse:
            return self.whole.in_pairs(times, self.kind)
        z, w = self.whole.reduced_in_doubles(times, self.kind)
        slopes, offsets = self.whole.affine
        return spread(slopes, offsets, z), spread(slopes, np.zeros_like(offsets), w)


@dataclass(frozen=True)
class ExpandedPlaces:
    """The same without multipliers, by the reduced table.

    A length that reaches zero is a singular place of the table as described, and often none of the reduced one. The
    attributes are those of `ExpandedWhole`, and the coordinates that are of interest: parts that they do not follow are
    left out, as if they were at zero.
    """

    whole: Whole
    kind: str = "fine"
    coarse: bool = False
    of: Sequence[int] | None = None

    def __call__(self, times: Floats, reach: Floats) -> Pieces:
        """Return the pieces; it raises as `ExpandedWhole` does."""
        # What stays follows none.
        parts = self.whole.parts_of(self.of) or self.whole.parts_of(None)
        own_steps = _from_steps(self.whole, parts, self.kind, times, reach)
        if own_steps is not None:
            lengths, places, place_sizes = own_steps
            nothing = np.zeros((len(times), 0, COEFFICIENTS, 2))
            return Pieces(*lengths, places, place_sizes, nothing, nothing[..., 0])
        arrays, units, where = self.whole.reduced_arrays(parts)
        states = self.whole.reduced_in_doubles if self.coarse else self.whole.reduced_in_pairs
        z, w = states(times, self.kind)
        lengths, own, own_sizes = _expanded(arrays, units, (z[:, where], w[:, where]), reach)
        slopes, offsets = self.whole.affine
        places, place_sizes = _spread_series(slopes, offsets, own, own_sizes, np.array(where, dtype=np.int64))
        nothing = np.zeros((len(times), 0, COEFFICIENTS, 2))
        return Pieces(*lengths, places, place_sizes, nothing, nothing[..., 0])


def expanded_from(
    arrays: Packed,
    units: Units,
    chosen: Sequence[int],
    rows: int,
    states: tuple[Floats, Floats],
    reach: Floats,
) -> Pieces:
    """Return the pieces that begin at states, with the multipliers of the chosen ones of some rows.

    Raises
    ------
    AccuracyUnreachable
        At a place where the connections lose their rank.
    """
    return _with_all_rows(units, chosen, rows, *_expanded(arrays, units, states, reach))


def _with_all_rows(
    units: Units, chosen: Sequence[int], rows: int, lengths: tuple[Floats, Floats], series: Floats, sizes: Floats
) -> Pieces:
    """Return pieces from the series of coordinates and of the multipliers of the chosen ones of some rows."""
    n = len(units.lengths)
    multipliers = np.zeros((len(series), rows, COEFFICIENTS, 2))
    multiplier_sizes = np.zeros((len(series), rows, COEFFICIENTS))
    factors = np.array([two_to(units.multiplier(row)) for row in chosen])
    multipliers[:, chosen] = series[:, n:, :COEFFICIENTS] * factors[:, None, None]
    multiplier_sizes[:, chosen] = sizes[:, n:, :COEFFICIENTS] * factors[:, None]
    return Pieces(*lengths, series[:, :n], sizes[:, :n], multipliers, multiplier_sizes)


def _expanded(
    arrays: Packed, units: Units, states: tuple[Floats, Floats], reach: Floats
) -> tuple[tuple[Floats, Floats], Floats, Floats]:
    """Return lengths of pieces and how long they could be (s); coefficients, in SI units but for multipliers; sizes."""
    q, v = states
    count, n = q.shape[:2]
    lengths, steps = np.zeros(count), np.zeros(count)
    series = np.zeros((count, n + arrays.rate.shape[0], ORDER + 1, 2))
    sizes = np.zeros(series.shape[:-1])
    # States of another layout would have the kernel compiled once more.
    down = units.down[None, :, None]
    places, rates = np.ascontiguousarray(q * down), np.ascontiguousarray(v * (down * two_to(units.time)))
    nothing = np.zeros((0, 2, 0))
    done = expand(arrays, places, rates, reach, units.up, units.time, lengths, steps, series, sizes, nothing)
    if done < count:
        raise AccuracyUnreachable(None, np.inf, "the connections lose their rank on the way", path=("times",))
    return (lengths, steps), series, sizes


def _from_steps(
    whole: Whole, parts: tuple[int, ...], kind: str, times: Floats, reach: Floats
) -> tuple[tuple[Floats, Floats], Floats, Floats] | None:
    """Return lengths of pieces and how long they could be (s), places and their sizes, of all coordinates.

    Those of stiff parts, whose Taylor series hold on far shorter pieces, are the polynomials of their own steps; None
    where there are no stiff parts.
    """
    ways = {k: whole.parts[k][1].steps_about(times, reach, kind, ORDER) for k in parts}
    stiff = {k: own for k, own in ways.items() if own is not None}
    if not stiff:
        return None
    found = [(list(whole.parts[k][0]), *own) for k, own in stiff.items()]
    others = tuple(k for k in parts if k not in stiff)
    if others:
        arrays, units, where = whole.reduced_arrays(others)
        z, w = whole.reduced_in_pairs(times, kind)
        found.append((where, *_expanded(arrays, units, (z[:, where], w[:, where]), reach)))
    lengths = np.sign(reach) * np.minimum.reduce([np.abs(own[0]) for _, own, _, _ in found])
    natural = np.minimum.reduce([own[1] for _, own, _, _ in found])
    where = [i for indices, _, _, _ in found for i in indices]
    powers = [(lengths / own[0])[:, None, None] ** np.arange(ORDER + 1) for _, own, _, _ in found]
    series = np.concatenate([x * by[..., None] for (*_, x, _), by in zip(found, powers, strict=True)], axis=1)
    sizes = np.concatenate([x * by for (*_, x), by in zip(found, powers, strict=True)], axis=1)
    slopes, offsets = whole.affine
    places, place_sizes = _spread_series(slopes, offsets, series, sizes, np.array(where, dtype=np.int64))
    return (lengths, natural), places, place_sizes


def _with_multipliers(
    arrays: Packed, units: Units, lengths: tuple[Floats, Floats], places: Floats, place_sizes: Floats
) -> tuple[tuple[Floats, Floats], Floats, Floats]:
    """Return pieces as `_expanded` does, with the multipliers of places that are known."""
    count, n = places.shape[:2]
    size, down = padded(n + arrays.rate.shape[0]), units.down[:, None, None]
    shares = two_to(units.time) / lengths[0]
    own = places * down * (shares[:, None] ** np.arange(ORDER + 1))[:, None, :, None]
    path = np.zeros((count, 2, ORDER + 1, size))
    path[..., :n] = np.transpose(own, (0, 3, 2, 1))
    q, v = np.ascontiguousarray(own[:, :, 0]), np.ascontiguousarray(own[:, :, 1])
    series = np.zeros((count, n + arrays.rate.shape[0], ORDER + 1, 2))
    sizes, formed = np.zeros(series.shape[:-1]), np.zeros(count)
    known = path.reshape(count, 2, -1)
    done = expand(arrays, q, v, lengths[0], units.up, units.time, formed, lengths[1].copy(), series, sizes, known)
    if done < count:
        raise AccuracyUnreachable(None, np.inf, "the connections lose their rank on the way", path=("times",))
    # Beyond the powers of the places those of the multipliers are rounding.
    series[:, n:, 1 + int(np.max(np.nonzero(places[..., 0])[2], initial=0)) :] = 0.0
    series[:, :n], sizes[:, :n] = places, place_sizes
    return lengths, series, sizes


@kernel()
def _spread_series(
    slopes: Floats, offsets: Floats, series: Floats, sizes: Floats, where: Integers
) -> tuple[Floats, Floats]:
    """Return the series of all coordinates and the sizes of their terms, from those of some of the reduced table.

    Parameters
    ----------
    series, sizes : (p, m, order + 1, 2) and (p, m, order + 1)
        The first of m are those of the coordinates `where` of the reduced table; the others are taken to be at zero.
    """
    pieces, count, powers = series.shape[0], slopes.shape[0], series.shape[2]
    found, of_terms = np.empty((pieces, count, powers, 2)), np.empty((pieces, count, powers))
    for s in range(pieces):
        for i in range(count):
            for k in range(powers):
                sh, sl = (offsets[i, 0], offsets[i, 1]) if k == 0 else (0.0, 0.0)
                size = abs(sh)
                total = size
                for m in range(len(where)):
                    slope, tail = slopes[i, where[m], 0], slopes[i, where[m], 1]
                    if slope != 0.0:
                        ph, pl = dd_mul(slope, tail, series[s, m, k, 0], series[s, m, k, 1])
                        sh, sl = dd_add(sh, sl, ph, pl)
                        size += abs(ph)
                        total += abs(slope) * sizes[s, m, k]
                if abs(sh) <= 2.0**-104 * size:
                    sh, sl = 0.0, 0.0
                found[s, i, k, 0], found[s, i, k, 1] = sh, sl
                of_terms[s, i, k] = total
    return found, of_terms


def repeats_after(whole: Whole, coordinates: Sequence[int] | None = None) -> float | None:
    """Return the time after which nothing new happens, of everything or of some coordinates; None where it does.

    It is a little more than a period, so that what touches zero at the start and so at the end is seen to do so.
    """
    among = [motion for _, motion in whole.parts] if coordinates is None else whole.motions_of(coordinates)
    moving = [motion for motion in among if motion.moves]
    if len(moving) != 1 or moving[0].period is None or moving[0].winds_on:
        return None
    return PAST_A_PERIOD * float(moving[0].period)
