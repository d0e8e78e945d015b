"""Named columns of a trajectory: positions, angles, attitudes, rates, forces and energies, each with unit and error."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from core.arrays import Floats, largest, largest_magnitude, row_lengths
from core.multibody.motion.attitudes import quaternions
from core.multibody.motion.motion import States
from core.multibody.motion.whole import Whole
from core.multibody.motion.whole import values as values_of
from core.multibody.table.connection_effects import Force
from core.multibody.table.momenta import StateFunction, momenta
from core.multibody.trajectory.column_errors import ROUNDED
from core.systems.trajectory import Column, How

_SMALL = 2.0**-50
"""What rounding to doubles adds to an error, relative to the largest value of a column."""
NEAREST = 2.0**-53 * (1 + 2.0**-20)
"""The same for coordinates and rates that are the doubles nearest to pairs."""
_SOLVED = 2.0**-100
"""Share of the largest multiplier, coordinate or rate to which all of them are known."""
MARGIN = 1.02
"""Margin for the reference's own error, which is some 2^-14 of what it judges."""


COLUMNS_OF_STATES = ("trajectory", "forces-in-time", "energy-in-time", "momenta-in-time")
"""Outputs that are columns of the state, in the order in which they are answered."""


Unknown = tuple[Floats, Floats]
"""By how much places and rates, each of shape (t, n), are wrong without their reference showing it."""


@dataclass(frozen=True)
class Columns:
    """Makes the columns of a scene at many times."""

    whole: Whole
    times: Floats
    states: States
    how: How
    rounding: float = _SMALL
    unknown: Unknown | None = None
    _along: dict[tuple[int, bool], Floats] = field(default_factory=dict, repr=False)

    def trajectory(self) -> dict[str, Column]:
        """Return what every body does."""
        found: dict[str, Column] = {}
        for name, frame in self.whole.measures.coordinates.frames.items():
            found[f"{name}.position"] = self._vector(frame.position, "m", rates=False)
            found[f"{name}.velocity"] = self._vector(frame.position, "m/s", rates=True)
            if frame.turn is not None:
                found[f"{name}.angle"] = self._scalar(frame.turn, "rad", rates=False)
                found[f"{name}.angular_velocity"] = self._scalar(frame.turn, "rad/s", rates=True)
            elif frame.direction is not None:
                found[f"{name}.angle"] = self._angle(frame.direction, name)
                found[f"{name}.angular_velocity"] = self._turning(frame.direction)
            elif frame.axis is not None:
                found[f"{name}.axis"] = self._vector(frame.axis[1], "1", rates=False)
            elif frame.axes is not None:
                found.update(self._attitude(name, frame.axes))
            elif frame.turns is not None:
                found[f"{name}.angular_velocity_in_space"] = self._vector(frame.turns, "rad/s", rates=True)
        return found

    def chosen(self, outputs: Sequence[object], determined: Sequence[bool]) -> dict[str, Column]:
        """Return the columns of the state that are among some outputs.

        Parameters
        ----------
        determined : sequence of bool
            Which of the forces the scene determines; the others are left out.
        """
        found: dict[str, Column] = {}
        for group in COLUMNS_OF_STATES:
            if group in outputs and (len(self.times) or group != "forces-in-time"):
                found.update(self.group(group, determined))
        return found

    def group(self, name: str, determined: Sequence[bool]) -> dict[str, Column]:
        """Return the columns of one of `COLUMNS_OF_STATES`."""
        if name == "trajectory":
            return self.trajectory()
        if name == "energy-in-time":
            return self.energy()
        if name == "momenta-in-time":
            return self.momenta()
        return self.forces([f for f, known in zip(self.whole.measures.forces, determined, strict=True) if known])

    def forces(self, chosen: Sequence[Force]) -> dict[str, Column]:
        """Return forces of connections in time."""
        q, v = self.states.q, self.states.v
        multipliers = self.whole.multipliers(q, v)
        # What should be zero is known no better than the largest of what is solved for with it and of what it balances.
        solved = self.whole.largest_multipliers(multipliers)
        balanced, rates = np.maximum(solved, self.whole.largest_forces(q, v)), self.whole.largest_rates(v)
        by_reference = None
        if self.states.reference is not None:
            by_reference = (*self.states.reference, self.whole.multipliers(*self.states.reference))
        moved = self._moved(len(chosen), lambda q, v: self._forces(chosen, q, v))
        found: dict[str, Column] = {}
        sizes: dict[str, float] = {}
        for k, force in enumerate(chosen):
            values, size = self.whole.force(force, q, v, multipliers)
            sizes[force.name] = float(size.max(initial=0.0))
            factors = [(row, float(np.max(values_of(poly, q)[1], initial=0.0))) for row, poly in force.terms]
            beside = sum(float(solved[row]) * factor for row, factor in factors)
            floor = sum(float(balanced[row]) * factor for row, factor in factors)
            error = _SMALL * sizes[force.name] + _SOLVED * floor + float(moved[k])
            beyond = sum(abs(float(x)) * rates[j] for j, x in force.of_rates.items())
            sizes[force.name] = max(sizes[force.name], floor, float(beyond))
            if by_reference is not None:
                other = self.whole.force(force, *by_reference)[0]
                error += 4.0 * largest_magnitude(values - other)
            # A force that is zero by symmetry is known as a share of those that are solved for with it.
            small = error > ROUNDED * largest_magnitude(values)
            found[force.name] = Column(values, force.unit, error, self.how, scale=beside if small else None)
        for unit in {column.unit for column in found.values()}:
            alike = {name: column for name, column in found.items() if column.unit == unit}
            if max(column.largest for column in alike.values()) <= max(column.error for column in alike.values()):
                # Where all forces are zero they are known as shares of the terms that cancel.
                for name, column in alike.items():
                    found[name] = replace(column, scale=max(column.scale or 0.0, sizes[name]))
        return found

    def _forces(self, chosen: Sequence[Force], q: Floats, v: Floats) -> Floats:
        """Return forces at states, shape (forces, t, 1)."""
        multipliers = self.whole.multipliers(q, v)
        found = [self.whole.force(force, q, v, multipliers)[0] for force in chosen]
        return np.array(found).reshape(len(chosen), len(q), 1)

    def _moved(self, count: int, functions: Callable[[Floats, Floats], Floats]) -> Floats:
        """Return by how much functions of the state are wrong for what is unknown of it, to first order.

        Parameters
        ----------
        functions : callable
            Returns the functions at states, shape (functions, t, components).
        """
        q, v = self.states.q, self.states.v
        if self.unknown is None or not len(q):
            return np.zeros(count)
        here = functions(q, v)
        total = np.zeros((count, len(q)))
        for which, sizes in enumerate(self.unknown):
            for i in np.flatnonzero(sizes.any(axis=0)):
                state = [q.copy(), v.copy()]
                state[which][:, i, 0] += sizes[:, i]
                total += np.linalg.norm(functions(*state) - here, axis=2)
        found: Floats = total.max(axis=1, initial=0.0)
        return found

    def momenta(self) -> dict[str, Column]:
        """Return momentum and angular momentum about the origin in time, of every body and of all."""
        measures = self.whole.measures
        found: dict[str, Column] = {}
        for name, function in momenta(measures.table, measures.coordinates.frames, measures.momenta).items():
            values, size = function.at(self.states.q, self.states.v)
            error = _SMALL * float(np.max(row_lengths(size), initial=0.0))
            error += float(self._moved(1, partial(_at, function))[0])
            if self.states.reference is not None:
                other = function.at(*self.states.reference)[0]
                error += 4.0 * float(np.max(row_lengths(values - other), initial=0.0))
            shown = values[:, 0] if values.shape[1] == 1 else values
            found[name] = Column(shown, function.unit, error, self.how)
        return found

    def energy(self) -> dict[str, Column]:
        """Return kinetic and potential energy in time."""
        pairs = [(self.states.q, self.states.v)]
        if self.states.reference is not None:
            pairs.append(self.states.reference)
        curves = [self._energies(*entry) for entry in pairs]
        moved = self._moved(2, lambda q, v: np.array([both[0][:, None] for both in self._energies(q, v)]))
        floors = self._energies_of_rounding()
        found: dict[str, Column] = {}
        for number, name in enumerate(("energy.kinetic", "energy.potential")):
            values, size = curves[0][number]
            error = _SMALL * float(size.max(initial=0.0)) + floors[number] + float(moved[number])
            if len(curves) > 1:
                error += 4.0 * largest_magnitude(values - curves[1][number][0])
            found[name] = Column(values, "J", error, self.how)
        return found

    def _energies(self, q: Floats, v: Floats) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
        measures = self.whole.measures
        table = measures.table
        spin = sum((float(frame.spin_energy) for frame in measures.coordinates.frames.values()), 0.0)
        kinetic = np.full(len(q), spin)
        potential = np.full(len(q), float(measures.potential))
        sizes = [np.abs(kinetic), np.abs(potential)]
        for (i, j), value in table.mass.items():
            term = float(value) * (0.5 if i == j else 1.0) * v[:, i, 0] * v[:, j, 0]
            kinetic, sizes[0] = kinetic + term, sizes[0] + np.abs(term)
        for i, value in table.potential_load.items():
            term = -float(value) * q[:, i, 0]
            potential, sizes[1] = potential + term, sizes[1] + np.abs(term)
        for (i, j), value in table.stiffness.items():
            term = 0.5 * float(value) * q[:, i, 0] * q[:, j, 0]
            potential, sizes[1] = potential + term, sizes[1] + np.abs(term)
        return (kinetic, sizes[0]), (potential, sizes[1])

    def _energies_of_rounding(self) -> tuple[float, float]:
        """Return to what the energies are known where a coordinate or rate should be zero, and is not quite."""
        table = self.whole.measures.table
        place, rate = (largest_magnitude(x[..., 0]) for x in (self.states.q, self.states.v))
        mass, load, stiffness = (
            sum(abs(float(value)) for value in entries.values())
            for entries in (table.mass, table.load, table.stiffness)
        )
        return _SOLVED * mass * rate * rate, _SOLVED * (load + stiffness * place) * place

    def _vector(self, indices: Sequence[int], unit: str, *, rates: bool) -> Column:
        where = list(indices)
        values = (self.states.v if rates else self.states.q)[:, where, 0]
        errors = (self.states.v_error if rates else self.states.q_error)[:, where]
        return Column(values, unit, _stated(values, row_lengths(errors), self.rounding), self.how)

    def _scalar(self, index: int, unit: str, *, rates: bool) -> Column:
        values = (self.states.v if rates else self.states.q)[:, index, 0]
        errors = (self.states.v_error if rates else self.states.q_error)[:, index]
        return Column(values, unit, _stated(values, errors, self.rounding), self.how)

    def _angle(self, direction: tuple[int, int], name: str) -> Column:
        """Return an unwrapped angle: the principal one, with the full turns that the way there has made."""
        table, start_angle = self.whole.measures.table, self.whole.measures.coordinates.start_angle(name)
        errors = self.states.q_error[:, direction[0]] + self.states.q_error[:, direction[1]]
        turned = self.whole.turned(direction, self.times)
        if turned is not None:
            # At any horizon, where the turns are too many to be counted on the way.
            values = np.array([float(start_angle + angle) for angle in turned])
            return Column(values, "rad", _stated(values, errors), self.how)
        c, s = (self.states.q[:, i, 0] for i in direction)
        start = [float(table.q[i]) for i in direction]
        principal = np.arctan2(start[0] * s - start[1] * c, start[0] * c + start[1] * s)
        turns = np.round((self._followed(direction) - principal) / (2 * math.pi))
        values = float(start_angle) + (principal + 2 * math.pi * turns)
        return Column(values, "rad", _stated(values, errors), self.how)

    def _followed(self, direction: tuple[int, int]) -> Floats:
        """Return the angle gone through since the start, well enough to count its turns."""
        total = np.zeros(len(self.times))
        motion = self.whole.motion_of(direction)
        for forward in (True, False):
            chosen = self.times >= 0.0 if forward else self.times < 0.0
            if motion is None or not np.any(chosen):
                continue
            times = self.times[chosen]
            grid = motion.nodes(float(times[np.argmax(np.abs(times))]))
            # A motion that repeats is followed for one period, and turns alike in each.
            period = None if motion.period is None else float(motion.period)
            if period is not None and abs(grid[-1]) >= period * (1 - 1e-9):
                grid = np.append(grid[np.abs(grid) < period * (1 - 1e-9)], math.copysign(period, grid[-1]))
            else:
                period = None
            # Bodies of one part are followed together.
            key = (id(motion), forward)
            if key not in self._along:
                self._along[key] = self.whole.places(grid)
            q = self._along[key][:, list(direction)]
            angle = np.unwrap(np.arctan2(q[:, 1], q[:, 0]))
            angle = angle - angle[0]
            if period is None:
                order = np.argsort(grid)
                total[chosen] = np.interp(times, grid[order], angle[order])
            else:
                count = np.floor(np.abs(times) / period)
                within = np.abs(times) - count * period
                turn = 2 * math.pi * round(angle[-1] / (2 * math.pi))
                total[chosen] = np.interp(within, np.abs(grid), angle) + count * turn
        return total

    def _turning(self, direction: tuple[int, int]) -> Column:
        i, j = direction
        q, v = self.states.q[..., 0], self.states.v[..., 0]
        values = q[:, i] * v[:, j] - q[:, j] * v[:, i]
        dq, dv = self.states.q_error, self.states.v_error
        errors = dv[:, i] + dv[:, j] + np.abs(v[:, j]) * dq[:, i] + np.abs(v[:, i]) * dq[:, j]
        return Column(values, "rad/s", _stated(values, errors), self.how)

    def _attitude(self, name: str, axes: Sequence[Sequence[int]]) -> dict[str, Column]:
        """Return the quaternion from body to space, and the angular velocity in body axes."""
        e = np.stack([self.states.q[:, list(axis), 0] for axis in axes], axis=1)
        rate = np.stack([self.states.v[:, list(axis), 0] for axis in axes], axis=1)
        omega = np.stack([np.einsum("ti,ti->t", rate[:, (k + 1) % 3], e[:, (k + 2) % 3]) for k in range(3)], axis=1)
        flat = [i for axis in axes for i in axis]
        off, off_rate = (row_lengths(x[:, flat]) for x in (self.states.q_error, self.states.v_error))
        fast = np.linalg.norm(rate, axis=(1, 2))
        quaternion = quaternions(e)
        return {
            f"{name}.attitude": Column(quaternion, "1", _stated(quaternion, off), self.how),
            f"{name}.angular_velocity": Column(omega, "rad/s", _stated(omega, off_rate + fast * off), self.how),
        }


def _at(function: StateFunction, q: Floats, v: Floats) -> Floats:
    """Return a function of the state as `Columns._moved` takes it."""
    return function.at(q, v)[0][None]


def _stated(values: Floats, errors: Floats, rounding: float = _SMALL) -> float:
    size = np.abs(values) if values.ndim == 1 else row_lengths(values)
    return MARGIN * largest(errors) + rounding * largest(size)
