"""Columns as the doubles nearest to what pairs of doubles say of the state: functions of it, evaluated in balls.

Coordinates and rates are the first doubles of their pairs. What is computed of them in doubles, angles, forces and
energies, is wrong by a few roundings. Here the state at every time is a table of balls as wide as its error, of which
the same functions are evaluated that answer the start.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import hypot, pi

import numpy as np
from flint import arb, arb_mat

from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.polynomials import ZERO, Ball, evaluated
from core.multibody.equations.dynamics import kinetic, potential
from core.multibody.equations.expansion import saddle
from core.multibody.laws.series import values_at
from core.multibody.motion.attitudes import angular_velocity, quaternion
from core.multibody.table.connection_effects import Force
from core.multibody.table.table import Table
from core.multibody.trajectory.columns import NEAREST, Columns
from core.systems.trajectory import Column

_WIDER = 1.02
"""Margin of the errors of states, which are doubles of their own."""


@dataclass(frozen=True)
class Nearest:
    """Makes the columns that `Columns` computes in doubles.

    Attributes
    ----------
    columns : Columns
        Of the same states.
    """

    columns: Columns

    def chosen(self, outputs: Sequence[object], determined: Sequence[bool]) -> dict[str, Column]:
        """Return the columns among some outputs, those of angles, forces and energies to the nearest double."""
        found = self.columns.chosen(outputs, determined)
        evaluated_anew = {name: values for name, values in self._functions(determined).items() if name in found}
        states = [self._state(s) for s in range(len(self.columns.times))] if evaluated_anew else []
        for name, function in evaluated_anew.items():
            found[name] = _nearest(found[name], [function(state) for state in states])
        return found

    def _functions(self, determined: Sequence[bool]) -> dict[str, Function]:
        """Return functions of the state by the names of their columns."""
        measures, found = self.columns.whole.measures, dict[str, Function]()
        for name, frame in measures.coordinates.frames.items():
            if frame.turn is None and frame.direction is not None:
                found[f"{name}.angle"] = partial(_angle, measures.coordinates.start_angle(name), frame.direction)
                found[f"{name}.angular_velocity"] = partial(_rate, frame.direction)
            elif frame.axes is not None:
                found[f"{name}.attitude"] = partial(_attitude, frame.axes)
                found[f"{name}.angular_velocity"] = partial(_angular_velocity, frame.axes)
        spin = sum((frame.spin_energy for frame in measures.coordinates.frames.values()), ZERO)
        found["energy.kinetic"] = lambda state: [kinetic(state.table) + spin]
        found["energy.potential"] = lambda state: [potential(state.table) + measures.potential]
        for force, known in zip(measures.forces, determined, strict=True):
            if known:
                found[force.name] = partial(_force, force)
        return found

    def _state(self, s: int) -> _State:
        states, table = self.columns.states, self.columns.whole.measures.table
        q, v = (
            [arb(float(high), _WIDER * float(error)) + arb(float(low)) for (high, low), error in zip(x, y, strict=True)]
            for x, y in ((states.q[s], states.q_error[s]), (states.v[s], states.v_error[s]))
        )
        return _State(replace(table, q=q, v=v), self.columns.whole.lasting_rows)


@dataclass(frozen=True)
class _State:
    """A table with the state of a time, and its independent rows."""

    table: Table
    chosen: Sequence[int]

    @cached_property
    def multipliers(self) -> dict[int, Ball]:
        """Those of the independent rows."""
        table, count = self.table, len(self.table.names)
        right = [*table.forces(), *(table.convective(table.rows[r]) for r in self.chosen)]
        solved = saddle(table, self.chosen).solve(arb_mat([[x] for x in right])).entries()
        return dict(zip(self.chosen, solved[count:], strict=True))


Function = Callable[[_State], Sequence[Ball]]
"""The components of a quantity."""


def _nearest(own: Column, balls: Sequence[Sequence[Ball]]) -> Column:
    """Return a column of the doubles nearest to balls, angles with the full turns that they have in doubles."""
    shape = own.values.shape
    near = own.values.reshape(shape[0], -1)
    if own.unit == "rad":
        balls = [
            [x + 2 * arb.pi() * round((y - float(x)) / (2 * pi)) for x, y in zip(*row, strict=True)]
            for row in zip(balls, near, strict=True)
        ]
    values = np.array([[float(x.mid()) for x in row] for row in balls]).reshape(shape)
    width = max((hypot(*(float(x.rad()) for x in row)) for row in balls), default=0.0)
    found = replace(own, values=values, error=0.0)
    return replace(found, error=_WIDER * width + NEAREST * found.largest)


def _angle(first: Ball, direction: tuple[int, int], state: _State) -> list[Ball]:
    """Return an angle up to full turns."""
    c, s = (state.table.q[i] for i in direction)
    x, y = first.cos(), first.sin()
    return [first + polar_angle(x * c + y * s, x * s - y * c)]


def _rate(direction: tuple[int, int], state: _State) -> list[Ball]:
    (c, s), (x, y) = ([z[i] for i in direction] for z in (state.table.q, state.table.v))
    return [c * y - s * x]


def _attitude(axes: Sequence[Sequence[int]], state: _State) -> list[Ball]:
    return quaternion([[state.table.q[i] for i in axis] for axis in axes])


def _angular_velocity(axes: Sequence[Sequence[int]], state: _State) -> list[Ball]:
    return angular_velocity(*([[x[i] for i in axis] for axis in axes] for x in (state.table.q, state.table.v)))


def _force(force: Force, state: _State) -> list[Ball]:
    q, v = state.table.q, state.table.v
    total = evaluated(force.of_state, q)
    for j, value in force.of_rates.items():
        total = total + value * v[j]
    for j, value in force.of_squares.items():
        total = total + value * v[j] * v[j]
    if force.of_laws:
        laws = values_at(state.table.laws, q, v)
        total = sum((value * laws[number] for number, value in force.of_laws.items()), total)
    return [sum((evaluated(poly, q) * state.multipliers.get(row, ZERO) for row, poly in force.terms), total)]
