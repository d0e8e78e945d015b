"""The set-up of a scene, recorded once for all members that differ from it in numbers alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from core.arrays import Floats, Integers
from core.errors import MechanicsError, Path
from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import Units, pair, state
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.members.lane_table import LaneForm, form_of, numbers_of
from core.multibody.members.recorded_balls import CODE, NotRecorded, Record, recording
from core.multibody.motion.modelling import Modelled, modelled
from core.multibody.motion.numerical import Numerical
from core.multibody.phases.smooth_motion import smooth_motion
from core.multibody.table.frames import Frame

MOST_COORDINATES = 24
"""Coordinates and rows of a table for lanes: the space of eight members stays in the nearest cache up to about that."""


MOST_RECORDS = 64
"""Set-ups that are recorded for one question: each costs some twenty times what its repetition does."""

MOST_IN_VAIN = 4
"""The same where none has led to a plan: the scene then is no motion in lanes."""


class _AsWritten(Numerals):
    """Numerals with recorded balls in place of numbers that members have each of their own, as they write them."""

    @property
    def as_written(self) -> bool:
        """That every number is read as it is written."""
        return True


@dataclass(frozen=True)
class Template:
    """An array of doubles of which some are of every member its own.

    Attributes
    ----------
    values : ndarray
    where : ndarray of int
        Places in the flat array.
    outputs, powers : ndarray of int
        Which of the outputs, each a value and its tail, and the powers of two by which they are multiplied.
    """

    values: Floats
    where: Integers
    outputs: Integers
    powers: Integers

    @classmethod
    def of(cls, values: Floats, record: Record) -> Template:
        """Return the template of an array with placeholders."""
        flat = np.ascontiguousarray(values).ravel()
        where = np.flatnonzero(np.isnan(flat))
        codes = flat.view(np.uint64)[where].tolist()
        numbers = list(record.numbers)
        if any(not 0 <= code - CODE < 2 * len(numbers) for code in codes):
            raise NotRecorded("a number of the table that is none")
        at = [(numbers[(code - CODE) // 2], (code - CODE) % 2) for code in codes]
        outputs = np.array([2 * output + part for (output, _), part in at], dtype=np.int64)
        return cls(values, where, outputs, np.array([power for (_, power), _ in at], dtype=np.int64))

    def filled(self, outputs: Floats) -> Floats:
        """Return the arrays of members, from their outputs of shape (members, 2 o), one after another."""
        found = np.tile(self.values.ravel(), (len(outputs), 1))
        found[:, self.where] = np.ldexp(outputs[:, self.outputs], self.powers)
        return found.reshape(len(outputs), *self.values.shape)


@dataclass(frozen=True)
class Setup:
    """Tables of members whose decisions come out alike.

    Attributes
    ----------
    form : LaneForm
    units : Units
        Of the arrays.
    numbers : Template
        The rows of numbers for lanes.
    slopes, offsets : Template
        The coordinates as described in those of the reduced table, as pairs.
    starts : Template
        Of every body with a direction: the start of its two components, and its angle.
    """

    form: LaneForm
    units: Units
    numbers: Template
    slopes: Template
    offsets: Template
    starts: Template


@dataclass
class Plan:
    """A record, and the tables to which its outcomes have led so far."""

    record: Record
    repeat: Callable[..., tuple[tuple[float, ...], tuple[Any, ...]] | None]
    frames: Mapping[str, Frame]
    setups: dict[tuple[Any, ...], Setup]

    @cached_property
    def bodies(self) -> tuple[object, ...]:
        """What of the coordinates columns are made of: members of several plans with the same are followed together."""
        return tuple(
            (name, *frame.position, frame.direction, frame.turn, repr(frame.axis), frame.turns)
            for name, frame in self.frames.items()
        )


class Plans:
    """What is known of a scene in which some numbers are left to members.

    Parameters
    ----------
    scene : Scene
        With `recorded_balls.Varied` at the places of these numbers.
    places : sequence of paths
    """

    def __init__(self, scene: Scene, places: Sequence[Path]) -> None:
        self.scene, self.places = scene, places
        self.numerals = Numerals.of({}, scene.numbers)
        self.known: list[Plan] = []
        self.records = 0

    def of(self, numbers: Sequence[float]) -> tuple[Plan, Setup, tuple[float, ...]] | None:
        """Return the plan of a member, its tables and its outputs; None for one that is to be answered by itself."""
        try:
            balls = [self.numerals.number(x, path) for x, path in zip(numbers, self.places, strict=True)]
        except MechanicsError:
            return None
        found = self._known(balls)
        if found is None and self.records < (MOST_RECORDS if self.known else MOST_IN_VAIN):
            self.records += 1
            try:
                with recording():
                    self._record(balls)
            except (NotRecorded, MechanicsError, ArithmeticError):
                # What is refused by itself is refused so, and what a record does not hold is answered so.
                return None
            found = self._known(balls)
        return found

    def _known(self, balls: Sequence[Ball]) -> tuple[Plan, Setup, tuple[float, ...]] | None:
        for k, plan in enumerate(self.known):
            try:
                found = plan.repeat(*balls)
            except (ArithmeticError, MechanicsError):
                continue
            if found is not None and found[1] in plan.setups:
                if k:
                    # Most members are like those before them.
                    self.known.insert(0, self.known.pop(k))
                return plan, plan.setups[found[1]], found[0]
        return None

    def _record(self, balls: Sequence[Ball]) -> None:
        """Record the set-up of a member, and keep its plan or its tables."""
        record = Record(len(balls))
        instead = dict(zip(self.places, record.begun(balls), strict=True))
        numerals = _AsWritten.of(self.scene.let, self.scene.numbers, instead=instead)
        model = modelled(self.scene, numerals)
        # Forces at the start are decided, too.
        ends = smooth_motion(model, np.zeros(0)).events
        record.complete = True
        setup = _setup_of(model, record)
        if ends:
            raise NotRecorded("a motion that ends at the start")
        same = next((plan for plan in self.known if plan.record.alike(record)), None)
        if same is None:
            frames = model.described.measures.coordinates.frames
            same = Plan(record, record.repeated(), frames, {})
            self.known.append(same)
        same.setups[record.outcomes] = setup


def _setup_of(model: Modelled, record: Record) -> Setup:
    """Return the tables of a model, whose motion has to be a Taylor series that nothing ends and no row follows."""
    whole, measures = model.whole, model.described.measures
    if len(whole.parts) != 1 or whole.dropped or measures.limits:
        raise NotRecorded("a motion of several parts, or one that is watched")
    motion, coordinates = whole.parts[0][1], measures.coordinates
    # What decays may be stiff, of which each member decides by itself.
    if type(motion) is not Numerical or motion.lost_to_doubles or len(motion.rows):
        raise NotRecorded("a motion of another model")
    arrays, table = motion.arrays, motion.table
    if "s" in table.units or len(arrays.slides.at):
        raise NotRecorded("what depends on time, or friction that turns")
    if len(arrays.load) + len(arrays.rate) > MOST_COORDINATES:
        raise NotRecorded("a large table")
    if list(whole.parts[0][0]) != list(range(len(table.names))):
        raise NotRecorded("coordinates in another order")
    starts: list[list[tuple[float, float]]] = []
    for name, frame in coordinates.frames.items():
        if frame.axes is not None:
            raise NotRecorded("attitudes in space")
        if frame.turn is None and frame.direction is not None:
            own = [measures.table.q[i] for i in frame.direction]
            starts.append([pair(x, 0) for x in (*own, coordinates.start_angle(name))])
    slopes, offsets = whole.affine
    numbers = numbers_of(arrays, *state(table, motion.units))
    return Setup(
        form_of(arrays),
        motion.units,
        Template.of(numbers, record),
        Template.of(slopes, record),
        Template.of(offsets, record),
        Template.of(np.array(starts, dtype=np.float64).reshape(-1, 3, 2), record),
    )
