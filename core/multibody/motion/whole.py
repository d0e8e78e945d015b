"""The whole scene at many times: the states of its parts put together, and the multipliers that go with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from flint import arb

from core.arrays import Floats, Integers, largest_magnitude
from core.compiled import kernel
from core.double_double import dd_add, dd_mul
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, LinearForm, Poly, degree, entry, is_zero, substituted
from core.multibody.algebra.rank import Elimination, independent
from core.multibody.equations.dynamics import restricted, undetermined
from core.multibody.equations.packed import Packed, Units, packed, pair, two_to, units_of
from core.multibody.laws.samples import values_of
from core.multibody.motion.motion import Motion, States
from core.multibody.motion.series_pairs import multipliers_pairs
from core.multibody.reduction.reduction import Reduced
from core.multibody.table.connection_effects import Force, Limit
from core.multibody.table.measures import Measures
from core.multibody.table.table import Table

_NO_TERM = 2.0**-96
"""Sum of the terms of a measure, relative to the largest coordinate, below which it is zero to pairs of doubles, whose
roundings of 2^-106 a thousand operations gather: what is left of components that vanish."""


@dataclass(frozen=True)
class Whole:
    """A scene in motion.

    Attributes
    ----------
    acceleration : sequence of balls
        Of every coordinate as described, at the start; `reduced_accelerations`, of those of the reduced table.
    parts : sequence of (coordinates of the reduced table, motion)
    dropped : bool
        Whether rows were left out because they followed from others at the start.
    """

    measures: Measures
    reduced: Reduced
    acceleration: Sequence[Ball]
    reduced_accelerations: Sequence[Ball]
    parts: Sequence[tuple[Sequence[int], Motion]]
    dropped: bool = False
    _packed: dict[tuple[int, ...], tuple[Packed, Units, list[int]]] = field(
        default_factory=dict, init=False, repr=False
    )

    @property
    def limits(self) -> Sequence[Limit]:
        """What has to stay positive: by the connections, and on the branches that the passes chose."""
        return [*self.measures.limits, *self.reduced.branches]

    @cached_property
    def affine(self) -> tuple[Floats, Floats]:
        """Slopes and offsets of the coordinates as described in those of the reduced table, as pairs."""
        count = len(self.reduced.table.names)
        slopes = np.zeros((len(self.reduced.expressions), count, 2))
        offsets = np.zeros((len(self.reduced.expressions), 2))
        for i, expression in enumerate(self.reduced.expressions):
            for key, value in expression.items():
                if key:
                    slopes[i, key[0]] = pair(value, 0)
                else:
                    offsets[i] = pair(value, 0)
        return slopes, offsets

    def keeps(self, measure: Poly) -> bool:
        """Return whether an affine function of the coordinates as described is constant: by the passes and the rows.

        A gap with friction is a coordinate that the passes leave, since its multiplier is needed; its row keeps it.
        """
        changes = substituted(measure, self.reduced.expressions)
        held = Elimination()
        for row in self.reduced.table.rows:
            if all(degree(poly) <= 0 for poly in row.rates.values()):
                held.add({j: poly[()] for j, poly in row.rates.items()}, row.rate)
        free, rate = held.reduced({key[0]: x for key, x in changes.items() if key}, ZERO)
        return degree(changes) <= 1 and not free and is_zero(rate)

    @property
    def uniform(self) -> bool:
        """Whether every acceleration is constant."""
        return all(motion.uniform for _, motion in self.parts)

    @cached_property
    def arrays(self) -> tuple[Packed, Units, list[int]]:
        """The table as described for compiled code, its units, and the rows that it holds."""
        table, chosen = self._with_mass(), self.lasting_rows
        units = units_of(table, self.acceleration)
        return packed(table, chosen, units), units, chosen

    def _with_mass(self) -> Table:
        """Return the table as described, with a mass for what stays and has neither a mass nor a row that sees it.

        A massless pulley that hangs straight down is such across its strings: as it stays, a mass changes nothing.
        """
        table = self.measures.table
        still = {i for i, e in enumerate(self.reduced.expressions) if not any(e) and (i, i) not in table.mass}
        if not still:
            return table
        loose = undetermined(table, still, [row.line(table.q) for row in table.rows])
        mass = max((x for (i, j), x in table.mass.items() if i == j), key=float, default=ONE)
        return replace(table, mass={**table.mass, **{(i, i): mass for i in loose}})

    def parts_of(self, coordinates: Sequence[int] | None) -> tuple[int, ...]:
        """Return the numbers of the parts that these coordinates of the scene follow, all of them for None."""
        if coordinates is None:
            return tuple(range(len(self.parts)))
        seen = {key[0] for i in coordinates for key in self.reduced.expressions[i] if key}
        return tuple(k for k, (indices, _) in enumerate(self.parts) if seen & set(indices))

    def reduced_arrays(self, parts: tuple[int, ...]) -> tuple[Packed, Units, list[int]]:
        """Return the reduced table of some parts for compiled code, its units, and its coordinates."""
        if parts not in self._packed:
            own = self.parts[parts[0]] if len(parts) == 1 else None
            known = None if own is None else own[1].in_arrays
            if own is not None and known is not None:
                return (*known, list(own[0]))
            # A clock is in every part that it drives.
            where = sorted({i for k in parts for i in self.parts[k][0]})
            table = restricted(self.reduced.table, where)
            units = units_of(table, [self.reduced_accelerations[i] for i in where])
            chosen = table.independent_rows()
            self._packed[parts] = (packed(table, chosen, units), units, where)
        return self._packed[parts]

    @cached_property
    def lasting_rows(self) -> list[int]:
        """Rows of the table as described on which all others depend, in order.

        What holds as long as the scene lasts and has the same line everywhere comes first: what it leaves to others it
        leaves along the whole motion, whereas rows that turn with it, such as those of directions of welded bodies, may
        come to depend on one another.
        """
        rows, q = self.measures.table.rows, self.measures.table.q
        opens = {one.name for one in self.measures.unilateral}
        order = sorted(range(len(rows)), key=lambda r: not rows[r].constant or rows[r].name in opens)
        return sorted(order[k] for k in independent(rows[r].line(q) for r in order))

    def motion_of(self, coordinates: Sequence[int]) -> Motion | None:
        """Return the motion of the part that these coordinates of the scene follow, None where they stay."""
        return next(iter(self.motions_of(coordinates)), None)

    def motions_of(self, coordinates: Sequence[int]) -> list[Motion]:
        """Return the motions of the parts that these coordinates of the scene follow."""
        return [self.parts[k][1] for k in self.parts_of(coordinates)]

    def returns_after(self, motion: Motion) -> Ball | None:
        """Return the time (s) after which the state of a part returns, up to a turn about the vertical.

        None where it never does: what rolls on is elsewhere after its period, what turns over by whole turns is not. A
        coordinate that no body has, as the parameter of a closed curve, may go on: nothing depends on what winds on.
        """
        indices = next(own for own, one in self.parts if one is motion)
        moved = dict(zip(indices, motion.moved_on, strict=False))
        for i in {i for frame in self.measures.coordinates.frames.values() for i in frame.coordinates}:
            expression, unit = self.reduced.expressions[i], self.measures.table.units[i]
            way = sum((value * moved[key[0]] for key, value in expression.items() if key and key[0] in moved), ZERO)
            turns = way / (2 * arb.pi()) if unit == "rad" else way
            if not (turns.contains_integer() if unit == "rad" else turns.contains(0)):
                return None
        return motion.period

    def turned(self, direction: tuple[int, int], times: Floats) -> list[Ball] | None:
        """Return by how much a direction has turned since the start (rad), None where the motion does not know it."""
        motion = self.motion_of(direction)
        turned = None if motion is None else motion.angles_turned([arb(float(t)) for t in times])
        return None if turned is None else [self.sense(direction) * angle for angle in turned]

    def sense(self, direction: tuple[int, int]) -> int:
        """Return -1 where a direction turns against the place on a circle that it follows, else 1."""
        first, second = (self.reduced.expressions[i] for i in direction)
        x, y = sorted({key for key in (*first, *second) if key})
        return 1 if entry(first, x) * entry(second, y) > entry(first, y) * entry(second, x) else -1

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states at times of shape (t,)."""
        n, count = len(self.reduced.table.names), len(times)
        z, w = np.zeros((count, n, 2)), np.zeros((count, n, 2))
        z_error, w_error = np.zeros((count, n)), np.zeros((count, n))
        other, rate = np.zeros((count, n, 2)), np.zeros((count, n, 2))
        measured = False
        for indices, motion in self.parts:
            found = motion.states(times, finer=finer)
            where = list(indices)
            z[:, where], w[:, where] = found.q, found.v
            z_error[:, where], w_error[:, where] = found.q_error, found.v_error
            other[:, where], rate[:, where] = (found.q, found.v) if found.reference is None else found.reference
            measured = measured or found.reference is not None
        slopes, offsets = self.affine
        size = np.abs(slopes[:, :, 0]).T
        nothing = np.zeros_like(offsets)
        reference = (spread(slopes, offsets, other), spread(slopes, nothing, rate)) if measured else None
        return States(
            spread(slopes, offsets, z),
            spread(slopes, nothing, w),
            z_error @ size,
            w_error @ size,
            reference,
        )

    def states_at(self, z: Floats, w: Floats) -> States:
        """Return the states that go with coordinates and rates of the reduced table, each of shape (t, n)."""
        slopes, offsets = self.affine
        q = spread(slopes, offsets, np.stack([z, np.zeros_like(z)], axis=2))
        v = spread(slopes, np.zeros_like(offsets), np.stack([w, np.zeros_like(w)], axis=2))
        nothing = np.zeros(q.shape[:2])
        return States(q, v, nothing, nothing, None)

    def in_pairs(self, times: Floats, kind: str = "fine") -> tuple[Floats, Floats]:
        """Return every coordinate and rate at times of shape (t,), right to pairs of doubles, each of (t, n, 2).

        The kind is that of the runs of parts without a closed form: "fine" or the coarser "check", "reference" or
        "doubles".
        """
        slopes, offsets = self.affine
        z, w = self.reduced_in_pairs(times, kind)
        return spread(slopes, offsets, z), spread(slopes, np.zeros_like(offsets), w)

    def reduced_in_pairs(self, times: Floats, kind: str = "fine") -> tuple[Floats, Floats]:
        """Return the coordinates and rates of the reduced table, as `in_pairs` does."""
        shape = (len(times), len(self.reduced.table.names), 2)
        z, w = np.zeros(shape), np.zeros(shape)
        for indices, motion in self.parts:
            z[:, list(indices)], w[:, list(indices)] = motion.by(kind, times)
        return z, w

    @property
    def is_faster_in_doubles(self) -> bool:
        """Whether a part has a closed form that is evaluated faster in doubles."""
        return any(motion.is_faster_in_doubles for _, motion in self.parts)

    def reduced_in_doubles(self, times: Floats, kind: str = "fine") -> tuple[Floats, Floats]:
        """Return the states as `reduced_in_pairs`, where that is faster to a few roundings of doubles."""
        shape = (len(times), len(self.reduced.table.names), 2)
        z, w = np.zeros(shape), np.zeros(shape)
        for indices, motion in self.parts:
            where, fast = list(indices), motion.in_doubles(times)
            if fast is not None:
                z[:, where, 0], w[:, where, 0] = fast
            else:
                z[:, where], w[:, where] = motion.by(kind, times)
        return z, w

    def places(self, times: Floats) -> Floats:
        """Return every coordinate at times of one sign, shape (t, n), to a few roundings of the answer's."""
        z = np.zeros((len(times), len(self.reduced.table.names)))
        for indices, motion in self.parts:
            z[:, list(indices)] = motion.places_in_doubles(times)
        slopes, offsets = self.affine
        found: Floats = offsets[:, 0] + z @ slopes[:, :, 0].T
        return found

    def misfit(self, states: States) -> float:
        """Return by how much the rows are missed at most: measures relative to their terms, rates to the largest.

        What is known of places and rates is taken off: the terms of a product near zero, and all rates where a motion
        turns back, may be smaller than that.
        """
        q, v = states.q, states.v
        worst, nothing, fastest = 0.0, _NO_TERM * largest_magnitude(q), largest_magnitude(v)
        for row in self.measures.table.rows:
            if row.measure is not None:
                value, size = values(row.measure, q)
                held = size > nothing
                known = rates_along(row.rates, q, states.q_error[..., np.newaxis])[1]
                off = np.maximum(np.abs(value) - known, 0.0)
                worst = max(worst, float(np.max(off[held] / size[held], initial=0.0)))
            elif fastest > 0.0:
                value, own = rates_along(row.rates, q, v)[0], rates_along(row.rates, q, np.full_like(v, fastest))[1]
                known = rates_along(row.rates, q, states.v_error[..., np.newaxis])[1]
                off, size = np.maximum(np.abs(value - float(row.rate)) - known, 0.0), own + abs(float(row.rate))
                worst = max(worst, float(np.max(off[size > 0.0] / size[size > 0.0], initial=0.0)))
        return worst

    def multipliers(self, q: Floats, v: Floats) -> Floats:
        """Return the multipliers of every row, shape (t, rows), those of redundant rows zero.

        Raises
        ------
        AccuracyUnreachable
            At a place where the connections lose their rank.
        """
        _, units, chosen = self.arrays
        found = self._solved(q, v)[1]
        total = np.zeros((len(q), len(self.measures.table.rows)))
        for k, r in enumerate(chosen):
            total[:, r] = found[:, k, 0] * two_to(units.multiplier(r))
        return total

    def largest_multipliers(self, multipliers: Floats) -> Floats:
        """Return the largest of multipliers of shape (t, rows), in the units of the kernels, as one of each row."""
        powers = self._powers
        return self._of_each_row(float(np.max(np.ldexp(np.abs(multipliers), -powers[None, :]), initial=0.0)))

    def largest_forces(self, q: Floats, v: Floats) -> Floats:
        """Return the largest term of the forces that multipliers balance at states, as one multiplier of each row."""
        units, table = self.arrays[1], self.measures.table
        place, rate = (np.max(np.abs(x[..., 0]), axis=0, initial=0.0) for x in (q, v))
        terms = [(i, abs(float(x))) for i, x in table.load.items()]
        terms += [(i, abs(float(x)) * place[j]) for (i, j), x in table.stiffness.items()]
        terms += [(i, abs(float(x)) * rate[j]) for (i, j), x in table.damping.items()]
        terms += [(i, abs(float(x)) * place[j] * rate[k]) for (i, j, k), x in table.gyration.items()]
        for law in table.acting:
            pushed = largest_magnitude(values_of(law, q, v)[0])
            terms += [(i, abs(float(x)) * pushed) for i, x in law.push.items()]
        power = 2 * units.time - units.action
        return self._of_each_row(max((float(np.ldexp(x, units.lengths[i] + power)) for i, x in terms), default=0.0))

    def largest_rates(self, v: Floats) -> Floats:
        """Return for every coordinate the largest rate among those of its unit: what cancels where its own is zero."""
        lengths, largest = np.array(self.arrays[1].lengths), np.max(np.abs(v[..., 0]), axis=0, initial=0.0)
        alike = lengths[:, None] == lengths
        found: Floats = np.max(np.where(alike, largest, 0.0), axis=1, initial=0.0)
        return found

    @property
    def _powers(self) -> Integers:
        """Exponents of two of the multiplier of every row."""
        units = self.arrays[1]
        return np.array([units.multiplier(row) for row in range(len(self.measures.table.rows))], dtype=np.int64)

    def _of_each_row(self, size: float) -> Floats:
        """Return a size in the units of the kernels as a multiplier of each row."""
        found: Floats = np.ldexp(size, self._powers)
        return found

    def accelerations(self, q: Floats, v: Floats) -> Floats:
        """Return the acceleration of every coordinate at states, shape (t, n); it raises as `multipliers` does."""
        units = self.arrays[1]
        up = np.array([two_to(e - 2 * units.time) for e in units.lengths])
        found: Floats = self._solved(q, v)[0][..., 0] * up
        return found

    def _solved(self, q: Floats, v: Floats) -> tuple[Floats, Floats]:
        arrays, units, chosen = self.arrays
        down = units.down[None, :, None]
        acceleration, found = np.zeros_like(q), np.zeros((len(q), len(chosen), 2))
        done = multipliers_pairs(arrays, q * down, v * (down * two_to(units.time)), acceleration, found)
        if done < len(q):
            raise AccuracyUnreachable(None, np.inf, "the connections lose their rank on the way", path=("times",))
        return acceleration, found

    def turns_with(self, force: Force) -> list[int]:
        """Return the rows of the pushes with which a force turns: none where its direction stays."""
        return []

    def force(self, force: Force, q: Floats, v: Floats, multipliers: Floats) -> tuple[Floats, Floats]:
        """Return a force at every state, and the sum of the magnitudes of its terms, each of shape (t,)."""
        total, size = values(force.of_state, q)
        for j, value in force.of_rates.items():
            term = float(value) * v[:, j, 0]
            total, size = total + term, size + np.abs(term)
        for j, value in force.of_squares.items():
            term = float(value) * v[:, j, 0] ** 2
            total, size = total + term, size + np.abs(term)
        for number, value in force.of_laws.items():
            given, given_size = values_of(self.measures.table.laws[number], q, v)
            total, size = total + float(value) * given, size + abs(float(value)) * given_size
        for row, poly in force.terms:
            factor, factor_size = values(poly, q)
            total = total + factor * multipliers[:, row]
            size = size + factor_size * np.abs(multipliers[:, row])
        return total, size


def values(poly: Poly, q: Floats) -> tuple[Floats, Floats]:
    """Return a polynomial at every place of shape (t, n, 2), and the sum of the magnitudes of its terms."""
    total, size = np.zeros(len(q)), np.zeros(len(q))
    for key, value in poly.items():
        term = np.full(len(q), float(value))
        for i in key:
            term = term * q[:, i, 0]
        total, size = total + term, size + np.abs(term)
    return total, size


def rates_along(line: LinearForm, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return a linear form in the rates at states, and how large its terms are."""
    total, size = np.zeros(len(q)), np.zeros(len(q))
    for j, poly in line.items():
        factor, factor_size = values(poly, q)
        total = total + factor * v[:, j, 0]
        size = size + factor_size * np.abs(v[:, j, 0])
    return total, size


@kernel()
def spread(slopes: Floats, offsets: Floats, z: Floats) -> Floats:
    """Return offsets + slopes z in pairs for z of shape (t, n, 2)."""
    count, n = slopes.shape[0], slopes.shape[1]
    out = np.empty((z.shape[0], count, 2))
    for s in range(z.shape[0]):
        for i in range(count):
            sh, sl = offsets[i, 0], offsets[i, 1]
            size = abs(sh)
            for j in range(n):
                if slopes[i, j, 0] != 0.0:
                    ph, pl = dd_mul(slopes[i, j, 0], slopes[i, j, 1], z[s, j, 0], z[s, j, 1])
                    sh, sl = dd_add(sh, sl, ph, pl)
                    size += abs(ph)
            # What is below the rounding of its terms is zero: the velocity of a body beside that of its centre of mass.
            if abs(sh) <= 2.0**-104 * size:
                sh, sl = 0.0, 0.0
            out[s, i, 0], out[s, i, 1] = sh, sl
    return out
