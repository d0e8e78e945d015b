"""What is summed up along a motion: works of every connection, friction and impacts, and lengths of paths.

Between events they are integrals. A contact that slides takes the power mu N |slip|; an impact
takes at once what its impulse times the mean rate is. Of bounces that accumulate the impacts take what all else leaves
over of the change of kinetic energy.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from flint import arb

from core.arrays import Floats, Integers
from core.errors import NotApplicable
from core.multibody.algebra.polynomials import Ball
from core.multibody.contacts.contact_states import force_names
from core.multibody.equations.packed import nearest, pair
from core.multibody.motion.numerical import BEFORE_SINGULAR
from core.multibody.motion.whole import rates_along
from core.multibody.phases.phase import Phase
from core.multibody.phases.phase_columns import ColumnsInPhases
from core.multibody.phases.stretches import Stretch, stretches
from core.multibody.start import energy_of
from core.multibody.table.connection_effects import Unilateral, WorkTerm
from core.multibody.table.momenta import work_of_potential
from core.multibody.trajectory.along import State, power_of, smooth_times, speed_of, summed, velocities_of
from core.systems.trajectory import Column, How

_SMALL = 2.0**-50
"""Rounding of a sum in doubles, as a share of its largest term: four units in the last place."""

_MARGIN = 4.0
"""Factor on the difference from the reference, which has an error of its own."""

FRICTION, IMPACTS = "friction.work", "impacts.work"

Power = Callable[[State], tuple[Floats, Floats]]
"""From states to summands, and how large their terms are."""


@dataclass
class _Sum:
    """One sum at the samples so far, and what it has come to at the start of a stretch, each with an error."""

    values: Floats
    errors: Floats
    carried: float = 0.0
    error: float = 0.0

    def add(self, value: float, error: float) -> None:
        """Add what happens at one time."""
        self.carried, self.error = self.carried + value, self.error + error


class Sums:
    """Sums along a motion at some times; of those before the start they are negative where what is summed up is not.

    Parameters
    ----------
    columns : ColumnsInPhases
    times : ndarray, shape (t,)
    how : str
    """

    def __init__(self, columns: ColumnsInPhases, times: Floats, how: How) -> None:
        self.motion, self.times, self.how = columns.motion, times, how
        self.pieces = list(stretches(columns.motion, float(times.max(initial=0.0)), finer=columns.finer))
        # As of phases: at the double that an event has a time is in the stretch that begins.
        starts = [nearest(piece.start) for piece in self.pieces]
        self.where = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
        self._smooth: dict[tuple[int, tuple[int, ...], float], Floats] = {}

    def paths(self) -> dict[str, Column]:
        """Return the lengths of the paths of centres of mass (m)."""
        frames = self.motion.base.measures.coordinates.frames
        velocities, found = velocities_of(frames), {}
        for name, frame in frames.items():
            one, function = self._sum(), _sized(partial(speed_of, velocities[name]))
            for number, piece in enumerate(self.pieces):
                self._integrate(one, number, piece, function, frame.position)
            found[f"{name}.path"] = self._column(one, "m")
        return found

    def works(self) -> dict[str, Column]:
        """Return the works of laws, and of friction and impacts of everything that touches (J).

        What rigid bodies do not determine is left out.

        Raises
        ------
        NotApplicable
            Where a motor holds a rate through impacts, of which it takes a share.
        """
        measures = self.motion.base.measures
        if self.motion.impacts and any(work.rows for work in measures.works):
            raise NotApplicable(
                "works are not answered where something is driven through impacts: what holds the rate takes a share",
                path=("outputs",),
                remedy="ask for energy-in-time: what it and the energy_loss of the events leave over is that share",
            )
        found = {f"{work.name}.work": self._sum() for work in measures.works}
        for one in self.motion.unilateral:
            found |= {f"{one.name}.{FRICTION}": self._sum()} if one.slip is not None else {}
            found[f"{one.name}.{IMPACTS}"] = self._sum()
        found |= self._sudden(found)
        unknown: set[str] = set()
        phase = -1
        timed = {k for one in measures.timed.values() for k in one.works}
        for number, piece in enumerate(self.pieces):
            if piece.number != phase:
                phase = piece.number
                self._impacts(found, unknown, phase)
            for k, work in enumerate(piece.whole.measures.works):
                name = f"{work.name}.work"
                if work.potential is not None:
                    self._by_potential(found[name], number, piece, work, carried=k in timed)
                else:
                    self._integrate(found[name], number, piece, _sized(power_of(piece.whole, work)))
            for i, one in enumerate(piece.phase.unilateral):
                if one.slip is not None:
                    self._rub(found, unknown, i, one, number, piece)
                self._put(found[f"{one.name}.{IMPACTS}"], *_nothing(*self._local(number, piece)))
            if piece.phase.settles:
                settling = [f"{one}.{IMPACTS}" for one in piece.phase.settles]
                # How measures that come to rest together share what they take is not known.
                if unknown or len(settling) > 1:
                    unknown.update(settling)
                if piece.arc is not None:
                    self._bounce(found, number, piece)
                elif number + 1 < len(self.pieces):
                    self._come_to_rest(found[settling[0]], piece, self.pieces[number + 1])
        return {name: self._column(one, "J") for name, one in found.items() if name not in unknown}

    def _sum(self) -> _Sum:
        return _Sum(np.zeros(len(self.times)), np.zeros(len(self.times)))

    def _sudden(self, others: Collection[str]) -> dict[str, _Sum]:
        """Return the sums of what begins and strikes, which takes or brings energy at its own times alone."""
        phases, found = np.array([piece.number for piece in self.pieces])[self.where], dict[str, _Sum]()
        for number, name, work in sorted(self.motion.impacts, key=lambda one: one[1]):
            if f"{name}.{IMPACTS}" in others or work is None:
                continue
            one, (value, error) = found.setdefault(f"{name}.{IMPACTS}", self._sum()), _rounded(work)
            one.values[phases >= number] += value
            one.errors[phases >= number] += error
        return found

    def _column(self, one: _Sum, unit: str) -> Column:
        # What a single stretch has come to is not added to anything.
        rounded = _SMALL * np.abs(one.values) if len(self.pieces) > 1 else 0.0
        error = float(np.max(one.errors + rounded, initial=0.0))
        return Column(one.values, unit, error, self.how)

    def _local(self, number: int, piece: Stretch) -> tuple[Integers, Floats]:
        """Return which samples are in a stretch, and their times since its start, with that of its end."""
        mine = np.flatnonzero(self.where == number)
        late = np.array([pair(arb(float(self.times[k])) - piece.start, 0)[0] for k in mine], dtype=np.float64)
        return mine, np.append(np.clip(late, 0.0 if number else -np.inf, piece.length), piece.length)

    def _put(self, one: _Sum, mine: Integers, values: Floats, errors: Floats) -> None:
        """Take the values of a sum on a stretch, at its samples and its end."""
        one.values[mine], one.errors[mine] = one.carried + values[:-1], one.error + errors[:-1]
        one.add(float(values[-1]), float(errors[-1]))

    def _integrate(
        self, one: _Sum, number: int, piece: Stretch, function: Power, of: Sequence[int] | None = None
    ) -> None:
        """Add the integral of a function of some coordinates, of all for None."""
        mine, times = self._local(number, piece)
        parts = piece.whole.parts_of(of)

        def integrand(times: Floats) -> tuple[Floats, Floats, Floats]:
            states = piece.states(times)
            own, size = function((states.q, states.v))
            return own, own if states.reference is None else function(states.reference)[0], size

        nodes = partial(self._nodes, number, piece, parts)
        values, errors = summed(integrand, nodes, partial(piece.period, parts), times)
        if piece.phase.unknown is not None:
            errors += np.abs(times) * _unknown(piece, function)
        if len(self.pieces) > 1:
            # An event that comes later or earlier changes a sum by as much as the summands on either side.
            ends = np.abs(integrand(np.array([0.0, piece.length]))[0])
            one.error += piece.late * float(ends[0])
            errors[-1] += (piece.late + 2.0**-53 * piece.length) * float(ends[1])
        self._put(one, mine, values, errors)

    def _nodes(self, number: int, piece: Stretch, parts: tuple[int, ...], end: float) -> Floats:
        """Return times up to `end` between which functions of some parts are smooth, and the speeds in them."""
        if (number, parts, end) not in self._smooth:
            frames = piece.whole.measures.coordinates.frames.values()
            moved = [list(frame.position) for frame in frames if piece.whole.parts_of(frame.position) == parts]
            of = sorted({i for place in moved for i in place}) if moved else None
            # The last sample may be as good as at a singular place; beyond, halves are as smooth.
            found = smooth_times(piece.expansions(of), moved, BEFORE_SINGULAR * end)
            self._smooth[number, parts, end] = found
        return self._smooth[number, parts, end]

    def _by_potential(self, one: _Sum, number: int, piece: Stretch, work: WorkTerm, *, carried: bool) -> None:
        """Add the fall of a potential: since the start of the scene, or where it begins and ends, of the stretch."""
        mine, times = self._local(number, piece)
        potential, states = work.potential or {}, piece.states(times)
        start = np.array([pair(x, 0) for x in self.motion.phases[0].tracks[0].q])
        if carried:
            start = piece.states(np.zeros(1)).q[0]
        done, size = work_of_potential(potential, start, states.q)
        other = states.q.copy()
        # The first double of a pair would swallow an error smaller than its rounding.
        other[..., 1] += states.q_error
        moved = np.abs(work_of_potential(potential, start, other)[0] - done)
        if states.reference is not None:
            by_reference = work_of_potential(potential, start, states.reference[0])[0]
            moved = np.maximum(moved, _MARGIN * np.abs(by_reference - done))
        if not carried:
            # It is a function of the place.
            one.carried, one.error = 0.0, 0.0
        self._put(one, mine, done, _SMALL * size + moved)

    def _impacts(self, found: dict[str, _Sum], unknown: set[str], phase: int) -> None:
        """Add the works of the impacts with which a phase begins."""
        for number, name, work in self.motion.impacts:
            if number != phase:
                continue
            if work is None:
                unknown.add(f"{name}.{IMPACTS}")
            else:
                found[f"{name}.{IMPACTS}"].add(*_rounded(work))

    def _rub(
        self, found: dict[str, _Sum], unknown: set[str], i: int, one: Unilateral, number: int, piece: Stretch
    ) -> None:
        """Add the work of the friction of a contact."""
        phase, name = piece.phase, f"{one.name}.{FRICTION}"
        row = phase.tables[0].normal[i]
        if row is None or not phase.states[i].sense:
            self._put(found[name], *_nothing(*self._local(number, piece)))
            return
        if not _determined(phase, force_names(one)[0]):
            unknown.add(name)
            return
        whole = piece.whole

        def power(state: State) -> tuple[Floats, Floats]:
            q, v = state
            slips = [rates_along(line, q, v) for line in one.slips]
            speed = np.abs(slips[0][0]) if len(slips) == 1 else np.hypot(slips[0][0], slips[1][0])
            push = float(one.kinetic) * whole.multipliers(q, v)[:, row]
            # The slip is what the rates of a place and of a turn leave of one another.
            return -push * speed, np.abs(push) * sum(size for _, size in slips)

        self._integrate(found[name], number, piece, power)

    def _bounce(self, found: dict[str, _Sum], number: int, piece: Stretch) -> None:
        """Give the impacts that are not listed what all else leaves over of the change of kinetic energy."""
        mine, times = self._local(number, piece)
        settling = f"{piece.phase.settles[0]}.{IMPACTS}"
        kinetic = piece.columns(times, self.how, "energy-in-time")["energy.kinetic"]
        others = [one for name, one in found.items() if name != settling]
        values = kinetic.values - energy_of(self.motion.base).kinetic
        left = np.append(values[:-1] - sum(one.values[mine] for one in others), values[-1])
        left[-1] -= sum(one.carried for one in others)
        errors = np.append(sum(one.errors[mine] for one in others), sum(one.error for one in others))
        one = found[settling]
        one.carried, one.error = 0.0, 0.0
        # Arcs are evaluated in doubles: their rates may be wrong by two roundings of each of their terms.
        self._put(one, mine, left, errors + 8.0 * kinetic.error)

    def _come_to_rest(self, one: _Sum, piece: Stretch, following: Stretch) -> None:
        """Add what impacts take that are over in next to no time: their loss is that at the end of the stretch.

        Forces have worked along the motion without these impacts, which is taken to that end.
        """
        alone = replace(piece, phase=replace(piece.phase, tail=None))
        ends = alone.columns(np.array([piece.length]), self.how, "energy-in-time")["energy.kinetic"]
        starts = following.columns(np.zeros(1), self.how, "energy-in-time")["energy.kinetic"]
        one.add(float(starts.values[0] - ends.values[0]), starts.error + ends.error)


def _unknown(piece: Stretch, function: Power) -> float:
    """Return by how much a summand is wrong for what both tracks have left out, to first order."""
    states = piece.states(piece.length * np.array([0.0, 0.5, 1.0]))
    here, total = function((states.q, states.v))[0], np.zeros(3)
    for which, sizes in enumerate((states.q_error, states.v_error)):
        for i in np.flatnonzero(sizes.any(axis=0)):
            state = [states.q.copy(), states.v.copy()]
            state[which][:, i, 0] += sizes[:, i]
            total += np.abs(function((state[0], state[1]))[0] - here)
    return float(total.max())


def _sized(function: Callable[[State], Floats]) -> Power:
    """Return a function whose terms are as large as itself."""

    def sized(state: State) -> tuple[Floats, Floats]:
        found = function(state)
        return found, np.abs(found)

    return sized


def _rounded(work: Ball) -> tuple[float, float]:
    """Return a work as a double, and by how much that is wrong at most."""
    return float(work), float(work.rad()) + 2.0**-52 * abs(float(work))


def _nothing(mine: Integers, times: Floats) -> tuple[Integers, Floats, Floats]:
    return mine, np.zeros(len(times)), np.zeros(len(times))


def _determined(phase: Phase, force: str) -> bool:
    """Return whether the scene determines a force in a phase."""
    forces = phase.models[0].described.measures.forces
    return phase.determined[next(k for k, one in enumerate(forces) if one.name == force)]
