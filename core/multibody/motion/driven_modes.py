"""Linear equations that swings or exponentials of time drive: modes, with a coordinate for each of what drives.

The real part of exp(p t) solves u'' = 2 Re(p) u' - |p|^2 u, so that what drives a linear part is one more coordinate of
it, which nothing pushes back. At resonance two roots coincide; `Modes` then has the exponential of its matrix.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from flint import acb

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, is_zero
from core.multibody.equations.dynamics import accelerations, restricted
from core.multibody.equations.packed import pair
from core.multibody.laws.law import Law
from core.multibody.laws.linear import Exponential, Linear, linear_form
from core.multibody.motion.modes import Modes
from core.multibody.motion.motion import BallState, Mode, Motion, States
from core.multibody.motion.uniform import Uniform
from core.multibody.table.law_pieces import enter
from core.multibody.table.table import Row, Table

MOST_TURNED = 1e6
"""Radians up to which turns are counted where several directions turn differently: a million samples of doubles."""


@dataclass(frozen=True)
class DrivenModes(Motion):
    """A linear part with what drives it.

    Attributes
    ----------
    free : Modes
        Without what drives.
    whole : Modes
        With it: the coordinates `own` first.
    own : sequence of int
        The coordinates that are not known before.
    clock : mapping of int to ball
        The coordinate that is time, and its value at the start; none where it is among `own`.
    swings : mapping of int to pair of complex balls
        Coordinates that are the real part of z exp(p t).
    """

    free: Modes
    whole: Modes
    own: Sequence[int]
    clock: Mapping[int, Ball]
    swings: Mapping[int, Exponential]
    name: str = "modes"
    why: str = "the geometry is linear, the forces are linear in places and velocities, and what drives them swings"
    how: str = "closed form"
    period: Ball | None = None

    @property
    def modes(self) -> tuple[Mode, ...]:
        """The characteristic roots of the motion without what drives it, slowest first."""
        return self.free.modes

    @property
    def is_faster_in_doubles(self) -> bool:
        """See `Motion.is_faster_in_doubles`."""
        return self.whole.is_faster_in_doubles

    @property
    def _size(self) -> int:
        return len(self.own) + len(self.clock) + len(self.swings)

    def _known(self, t: Ball) -> list[tuple[int, Ball, Ball]]:
        """Return the coordinates that are known before, each with its value and rate at a time."""
        found = [(k, start + t, ONE) for k, start in self.clock.items()]
        turned: dict[Any, Any] = {}
        for k, (z, p) in self.swings.items():
            # A cosine and its sine have one exponent.
            if id(p) not in turned:
                turned[id(p)] = (p * t).exp()
            value = z * turned[id(p)]
            found.append((k, value.real, (p * value).real))
        return found

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, enclosed by balls and rounded to pairs."""
        found = self.whole.states(times, finer=finer)
        own, count, shape = list(self.own), len(self.own), (len(times), self._size)
        q, v, q_error, v_error = np.zeros((*shape, 2)), np.zeros((*shape, 2)), np.zeros(shape), np.zeros(shape)
        q[:, own], v[:, own] = found.q[:, :count], found.v[:, :count]
        q_error[:, own], v_error[:, own] = found.q_error[:, :count], found.v_error[:, :count]
        for s, t in enumerate(times):
            for k, value, rate in self._known(ONE * float(t)):
                q[s, k], v[s, k] = pair(value, 0), pair(rate, 0)
                q_error[s, k], v_error[s, k] = (float(x.rad()) + 2.0**-104 * abs(float(x.mid())) for x in (value, rate))
        return States(q, v, q_error, v_error)

    def in_balls(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the states at each time."""
        found = []
        for t, state in zip(times, self.whole.in_balls(times), strict=True):
            q, v = [ZERO] * self._size, [ZERO] * self._size
            for k, i in enumerate(self.own):
                q[i], v[i] = state.q[k], state.v[k]
            for k, value, rate in self._known(t):
                q[k], v[k] = value, rate
            found.append(BallState(q, v))
        return found

    def in_doubles(self, times: Floats) -> tuple[Floats, Floats] | None:
        """Return coordinates and rates in doubles, None where roots coincide or have turned far."""
        found = self.whole.in_doubles(times)
        if found is None:
            return None
        own, count, shape = list(self.own), len(self.own), (len(times), self._size)
        q, v = np.zeros(shape), np.zeros(shape)
        q[:, own], v[:, own] = found[0][:, :count], found[1][:, :count]
        for k, start in self.clock.items():
            q[:, k], v[:, k] = float(start) + times, 1.0
        for k, (z, p) in self.swings.items():
            value = complex(z) * np.exp(complex(p) * times)
            q[:, k], v[:, k] = value.real, (complex(p) * value).real
        return q, v

    @property
    def _turning_rates(self) -> list[Ball]:
        """By what angle in a second each direction turns, from its coordinate of the smaller number to the other."""
        swings = list(self.swings.items())
        return [p.imag if c < s else -p.imag for (c, (_, p)), (s, _) in zip(swings[::2], swings[1::2], strict=True)]

    def angles_turned(self, times: Sequence[Ball]) -> list[Ball] | None:
        """Return how far what turns evenly has turned, None where several directions turn differently."""
        rates = self._turning_rates
        if not rates or not all(is_zero(rate - rates[0]) for rate in rates):
            return None
        return [rates[0] * time for time in times]

    def nodes(self, end: float) -> Floats:
        """Return four times to half a turn of the fastest direction."""
        turned = max((abs(float(rate)) for rate in self._turning_rates), default=0.0) * abs(end)
        if turned > MOST_TURNED:
            reason = f"its directions turn by {turned:.3g} rad, and are counted up to {MOST_TURNED:g}"
            raise AccuracyUnreachable(None, np.inf, reason, path=("times",))
        return np.linspace(0.0, end, 2 + math.ceil(4.0 * turned / math.pi))

    def keeps_positive(self, length: Poly) -> bool:
        """Return whether the amplitudes of the modes show it."""
        number = {i: k for k, i in enumerate(self.own)}
        if not all(i in number for key in length for i in key):
            return False
        return self.whole.keeps_positive({tuple(number[i] for i in key): x for key, x in length.items()})


def driven_modes(part: Table, gain: Sequence[Ball]) -> DrivenModes | Uniform | None:
    """Return the motion of a part whose rows are linear and whose forces are so or swing by time; None of others.

    Parameters
    ----------
    part : Table
    gain : sequence of ball
        Its accelerations at the start.
    """
    forms = [(law, form) for law in part.acting if (form := linear_form(law.root, law.inputs, law.numbers)) is not None]
    if len(forms) < len(part.acting) or part.gyration:
        return None
    timed = {i for i, unit in enumerate(part.units) if unit == "s"}
    swings = _turning(part.rows, timed, part.q)
    known = timed | set(swings or ())
    if swings is None or any(known & row.coordinates() and not row.coordinates() <= known for row in part.rows):
        return None
    if timed and _in_proportion(part, forms, timed):
        if swings:
            return None
        known = set()
    if any(swings.keys() & set(law.push) or _named(law, form) & swings.keys() for law, form in forms):
        return None
    own = [i for i in range(len(part.names)) if i not in known]
    entered, number = _without(part, set(swings)), {i: k for k, i in enumerate(own)}
    for law, form in forms:
        enter(entered, law, form)
    still = restricted(entered, own)
    driven = _Driven(restricted(still, range(len(own))))
    # A phase begins later than the formulas count from.
    now = next((part.q[i] for i in sorted(timed)), ZERO)
    for law, form in forms:
        for z, p in form.exponentials:
            for i, x in law.push.items():
                driven.push(number[i], x * z * (p * now).exp(), p)
    for entries, order in ((part.stiffness, 0), (part.damping, 1), ({**part.mass, **_mirrored(part.mass)}, 2)):
        for (i, j), x in entries.items():
            if i in number and j in swings:
                z, p = swings[j]
                driven.push(number[i], -x * z * p**order, p)
    if not (driven.added or still.stiffness or still.damping or swings):
        return Uniform(part, gain)
    _, chosen = accelerations(still)
    clock = {i: part.q[i] for i in sorted(timed & known)}
    return DrivenModes(Modes.of(still, chosen), Modes.of(driven.table, chosen), own, clock, swings)


def _without(part: Table, known: set[int]) -> Table:
    """Return a table without formulas, and without what couples its coordinates to those that are known."""
    return replace(
        part,
        load=dict(part.load),
        laws=[],
        stiffness={key: x for key, x in part.stiffness.items() if not known & set(key)},
        damping={key: x for key, x in part.damping.items() if not known & set(key)},
    )


def _mirrored(mass: Mapping[tuple[int, int], Ball]) -> dict[tuple[int, int], Ball]:
    return {(j, i): x for (i, j), x in mass.items()}


def _turning(rows: Sequence[Row], timed: set[int], q: Sequence[Ball]) -> dict[int, Exponential] | None:
    """Return cosines and sines that turn evenly with the time; None where other rows are not constant."""
    uneven = [row for row in rows if not row.constant]
    found: dict[int, Exponential] = {}
    for row in uneven:
        pair_of = sorted(set(row.rates) - timed)
        if row.measure is not None or len(pair_of) != 2 or row.rate != 0 or row.drag:
            continue
        for c, s in (pair_of, pair_of[::-1]):
            along, across, rate = (row.rates.get(k, {}) for k in (s, c, next(iter(timed), -1)))
            if set(along) == {(c,)} and set(across) == {(s,)} and set(rate) == {()}:
                lead = along[(c,)]
                if is_zero(across[(s,)] + lead) and any(_is_unit(other, c, s) for other in uneven):
                    p = acb(0, -rate[()] / lead)
                    found |= {c: (acb(q[c], q[s]), p), s: (acb(q[s], -q[c]), p)}
                break
    return found if all(set(row.rates) <= {*found, *timed} for row in uneven) else None


def _is_unit(row: Row, c: int, s: int) -> bool:
    """Return whether a row holds the sum of two squares at one."""
    given = row.measure
    if given is None or set(given) != {(c, c), (s, s), ()}:
        return False
    return is_zero(given[c, c] - given[s, s]) and is_zero(given[c, c] + given[()])


def _named(law: Law, form: Linear) -> set[int]:
    return {i for name in form.factors if name for i in law.inputs[name].coordinates()}


def _in_proportion(part: Table, forms: Sequence[tuple[Law, Linear]], timed: set[int]) -> bool:
    """Return whether anything is in proportion to the time."""
    if any(timed & (_named(law, form) | set(law.push)) for law, form in forms):
        return True
    return any(timed & set(key) for entries in (part.mass, part.stiffness, part.damping) for key in entries)


class _Driven:
    """A table with coordinates u for what drives it.

    Attributes
    ----------
    added : list
        The exponents p, each with its coordinate.
    """

    def __init__(self, table: Table) -> None:
        self.table, self.added = table, list[tuple[Any, int]]()

    def push(self, i: int, z: Any, p: Any) -> None:
        """Add a force that is the real part of z exp(p t).

        With u the real part of exp(p t), and v its rate, exp(p t) = u + i (Re(p) u - v)/Im(p).
        """
        k, place, rate = self._coordinate(p), z.real, ZERO
        if not is_zero(p.imag):
            place, rate = z.real - z.imag * p.real / p.imag, z.imag / p.imag
        self.table.add_stiffness(i, k, -place)
        if not is_zero(rate):
            self.table.add_damping(i, k, -rate)

    def _coordinate(self, p: Any) -> int:
        for q, k in self.added:
            if is_zero((p - q).real) and is_zero((p - q).imag):
                return k
        k = self.table.coordinate(f"drive {len(self.added) + 1}", "1", ONE)
        self.table.v[k] = p.real
        self.table.add_mass(k, k, ONE)
        self.table.add_stiffness(k, k, p.real * p.real + p.imag * p.imag)
        if not is_zero(p.real):
            self.table.add_damping(k, k, -2 * p.real)
        self.added.append((p, k))
        return k
