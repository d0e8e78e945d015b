"""What a scene answers, and the one way in which every scene does: only what is asked for is computed."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Annotated, Any, ClassVar, Generic, TypeVar

import numpy as np

from core.balls import precision
from core.errors import AccuracyUnreachable, InvalidParameter
from core.notices import Notice
from core.quantities import Unit
from core.scenes.enclosure import BITS, MORE_BITS, Ball, Rounding, sign
from core.systems.rounding import Digits, covering, notices_of, rounded
from core.systems.system import Floats, Model
from core.systems.trajectory import Accuracy, Work
from core.work import spend

HORIZON = "horizon"
SMALLEST_SAMPLE = 1e-290
"""Columns of smaller numbers than this would lose digits below the normal range of doubles."""
WORK_OF_A_SCENE = 100
"""Units of work (`core.work`): the set-up of a scene and of its motion in balls, at one precision."""
MOTION = ("events", "ended", "trajectory")
"""Outputs that need the motion, in every scene."""

N = TypeVar("N")
"""Kind of number in which an answer is written: doubles, or decimal strings."""
Pair = tuple[N, N]


@dataclass(frozen=True)
class SceneEvent(Generic[N]):
    """Something that happens at an instant.

    Attributes
    ----------
    kind : str
        What happens; an event that ends the motion is also named by `ended`.
    time : number
        Measured from the given state.
    """

    kind: str
    time: Annotated[N, Unit("s")] | None


@dataclass(frozen=True)
class MechanicalEnergy(Generic[N]):
    """Energy of the given state.

    Attributes
    ----------
    kinetic : number
        Of translation and rotation.
    potential : number
        Zero at the height that the scene measures heights from.
    total : number
        Their sum.
    """

    kinetic: Annotated[N, Unit("J")] | None
    potential: Annotated[N, Unit("J")] | None
    total: Annotated[N, Unit("J")] | None


def outputs_of(figures: type) -> tuple[str, ...]:
    """Return the names of everything that can be asked for of a scene with such figures."""
    return (*(entry.name for entry in fields(figures)), *MOTION)


@dataclass(frozen=True)
class Event:
    """Something that happens at an instant.

    Attributes
    ----------
    kind : str
        For example ``"string-1-unwound"``.
    time : ball
        From the given state (s).
    """

    kind: str
    time: Ball


@dataclass(frozen=True, eq=False)
class Columns:
    """Samples of a motion, by name, each of shape (n,) or (n, 2), and a bound of their errors.

    Attributes
    ----------
    values : mapping of str to ndarray
        Without the times.
    errors : mapping of str to ndarray
        Bound of the absolute error of each sample, broadcastable to the values.
    scales : mapping of str to float
        Largest magnitude of each column in the motion, the given state included.
    notices : tuple of Notice
        Columns that could not be given, and why.
    """

    values: Mapping[str, Floats]
    errors: Mapping[str, Floats]
    scales: Mapping[str, float]
    notices: tuple[Notice, ...] = ()

    def error(self) -> float:
        """Return a bound of the error of any sample, relative to the largest norm of its column."""
        worst = 0.0
        for name, bound in self.errors.items():
            largest = float(np.max(bound, initial=0.0))
            if largest > 0.0:
                scale = self.scales[name]
                worst = max(worst, largest / scale if scale > 0.0 else math.inf)
        return worst

    def without_underflow(self, sizes: Mapping[str, Ball]) -> Columns:
        """Return the columns without those that a double is too small for, judged by the sizes given."""
        lost = {name for name, size in sizes.items() if sign(size) and abs(float(size)) < SMALLEST_SAMPLE}

        def kept(table: Mapping[str, Any]) -> dict[str, Any]:
            return {name: entry for name, entry in table.items() if name not in lost}

        notices = tuple(
            Notice("outside-double-range", f"trajectory/{name} is too small for doubles") for name in sorted(lost)
        )
        return Columns(kept(self.values), kept(self.errors), kept(self.scales), (*self.notices, *notices))


class Motion(ABC):
    """A motion known in closed form, as long as its model holds."""

    @property
    @abstractmethod
    def model(self) -> Model:
        """The model and its regime."""

    @property
    @abstractmethod
    def valid_from(self) -> float:
        """Earliest time at which the model holds, minus infinity if it always did (s)."""

    @property
    @abstractmethod
    def end(self) -> Event | None:
        """The event that ends the motion, or None if nothing does."""

    @abstractmethod
    def events(self) -> tuple[Event, ...]:
        """Return what happens from t = 0 on, in order, the end included."""

    @abstractmethod
    def sample(self, times: Floats) -> Columns:
        """Return the motion at `times`, shape (n,), all between the beginning and the end."""


class UnbrokenMotion(Motion):
    """A motion in one piece: nothing happens but its end.

    Parameters
    ----------
    end : Event or None
    end_of_reversed : callable
        Returns what would end the motion backwards in time, only called where `valid_from` is needed.
    """

    def __init__(self, end: Event | None, end_of_reversed: Callable[[], Event | None]) -> None:
        self._end, self._end_of_reversed = end, end_of_reversed

    @cached_property
    def valid_from(self) -> float:
        """When the reversed motion would end."""
        first = self._end_of_reversed()
        # The difference, unlike the negative, of zero has no sign.
        return -math.inf if first is None else 0.0 - float(first.time)

    @property
    def end(self) -> Event | None:
        """The only event."""
        return self._end

    def events(self) -> tuple[Event, ...]:
        """Return the end, if there is one."""
        return () if self._end is None else (self._end,)


@dataclass(frozen=True, eq=False)
class SceneAnswer:
    """Answer to a question about a scene.

    Attributes
    ----------
    model : Model
        The smallest model that suffices for what was asked.
    figures : mapping
        The outputs that were asked for, by name: numbers, lists, mappings, None where a double cannot hold the number.
    trajectory : mapping of str to ndarray, or None
        Columns, the first of them ``time``: only the samples that exist.
    ended : str or None
        ``"horizon"``, or the event that ended the motion before it; None if nothing ends it or no motion was requested.
    accuracy : Accuracy
        Bound of the error: of figures relative to themselves, of samples to the largest norm of their column.
    warnings : tuple of Notice
        What the reader must know.
    work : Work
        Samples computed.
    requested_samples : int
        Samples asked for; `work` counts those that exist.
    """

    model: Model
    figures: Mapping[str, Any]
    trajectory: Mapping[str, Floats] | None
    ended: str | None
    accuracy: Accuracy
    warnings: tuple[Notice, ...]
    work: Work
    requested_samples: int

    def rounded(self, digits: Digits) -> SceneAnswer:
        """Return the answer with columns, all but the times, of fewer digits, covered by the error that is stated."""
        columns, added = {}, 0.0
        for name, column in (self.trajectory or {}).items():
            columns[name], more = (column, 0.0) if name == "time" else rounded(column, digits, self.accuracy.error)
            added = max(added, more)
        return replace(
            self,
            trajectory=None if self.trajectory is None else columns,
            accuracy=covering(self.accuracy, added),
            warnings=(*self.warnings, *notices_of(self.accuracy, added)),
        )


@dataclass(frozen=True)
class ConstrainedSystem(ABC):
    """A scene: parameters, figures that follow from them, and a motion."""

    outputs: ClassVar[tuple[str, ...]]
    """Names of everything that can be asked for: the fields of `figures_type`, and `MOTION`."""
    figures_type: ClassVar[type]
    """Dataclass, generic in the kind of number, that declares the figures: names, units, meanings."""
    samples_type: ClassVar[type]
    """Dataclass that declares the columns of the trajectory likewise, ``time`` first."""
    of_motion: ClassVar[tuple[str, ...]] = ()
    """Those among them, beside `MOTION`, that follow from the motion."""

    @abstractmethod
    def figures(self) -> Mapping[str, Callable[[], Any]]:
        """Return the figures that need no motion, by name, each to be computed only when it is called."""

    @abstractmethod
    def motion(self, horizon: float) -> Motion:
        """Return the motion at least up to `horizon` (s)."""

    @abstractmethod
    def static_model(self) -> Model:
        """Return the model of a question that needs no motion."""

    @property
    def has_motion(self) -> bool:
        """Whether the parameters suffice for a motion; if not, what needs one is left out unless it is asked for."""
        return True

    def motion_figures(self, motion: Motion) -> Mapping[str, Callable[[], Any]]:
        """Return figures of the motion beside its events, by name."""
        return {}

    def answer(
        self, times: Floats | None = None, outputs: frozenset[str] | None = None, accuracy: float = 1e-9
    ) -> SceneAnswer:
        """Compute what is asked for and nothing else.

        Parameters
        ----------
        times : ndarray, shape (n,), optional
            Instants of the trajectory, measured from the given state, in any order (s).
        outputs : frozenset of str, optional
            Names out of `outputs`; by default all, the trajectory if there are times.
        accuracy : float
            Largest error that is tolerated.

        Raises
        ------
        InvalidParameter
            For an unknown output, a trajectory without times, times that are not finite or before the beginning.
        AccuracyUnreachable
            If the bound of the error is larger than `accuracy`.
        """
        wanted = self.wanted(outputs, timed=times is not None)
        instants = None if times is None else _checked(times)
        with precision(BITS):
            found, sharp = self._compute(instants, wanted, accuracy)
        if not sharp:
            # What was computed so far is kept with the object, so a new one starts again.
            with precision(MORE_BITS):
                found, _ = replace(self)._compute(instants, wanted, accuracy)
        if found.accuracy.error > accuracy:
            raise AccuracyUnreachable(
                accuracy,
                found.accuracy.error,
                "the samples are differences of far larger numbers",
                remedy="ask for fewer digits",
            )
        return found

    def _compute(self, times: Floats | None, wanted: frozenset[str], accuracy: float) -> tuple[SceneAnswer, bool]:
        """Return the answer at the present precision, and whether that precision was enough."""
        spend(WORK_OF_A_SCENE + (0 if times is None else times.size))
        horizon = math.inf if times is None else float(np.max(times, initial=0.0))
        rounded = Rounding()
        table = dict(self.figures())
        motion, ended, trajectory, columns = None, None, None, None
        if wanted & {*MOTION, *self.of_motion}:
            motion = self.motion(horizon)
            ended = _ended(motion, horizon)
            table |= self.motion_figures(motion)
            table["events"] = lambda: _events(motion, horizon)
        figures = {name: rounded(table[name](), (name,)) for name in self.outputs if name in wanted and name in table}
        if motion is not None and times is not None and "trajectory" in wanted:
            existing = _existing(motion, times)
            columns = motion.sample(existing)
            trajectory = {"time": existing, **columns.values}
        answer = SceneAnswer(
            model=self.static_model() if motion is None else motion.model,
            figures=figures,
            trajectory=trajectory,
            ended=ended,
            accuracy=Accuracy(
                requested=accuracy,
                error=rounded.error if columns is None else max(rounded.error, columns.error()),
                how="closed form",
            ),
            warnings=(*rounded.notices, *self.notices(wanted), *(columns.notices if columns else ())),
            work=Work(samples=0 if trajectory is None else trajectory["time"].size),
            requested_samples=0 if times is None else times.size,
        )
        return answer, rounded.sharp

    def notices(self, wanted: frozenset[str]) -> tuple[Notice, ...]:
        """Return what the reader of the wanted outputs must know."""
        return ()

    def wanted(self, outputs: frozenset[str] | None, *, timed: bool) -> frozenset[str]:
        """Return the outputs that a question is about.

        Parameters
        ----------
        outputs : frozenset of str or None
            Those asked for by name; None for all that can be given.
        timed : bool
            Whether the question has times, without which there is no trajectory.

        Raises
        ------
        InvalidParameter
            For an unknown output, or a trajectory without times.
        """
        if outputs is None:
            names = frozenset(self.outputs) - (frozenset() if timed else frozenset({"trajectory"}))
            return names if timed or self.has_motion else names - {*MOTION, *self.of_motion}
        for name in sorted(outputs - set(self.outputs)):
            raise InvalidParameter("outputs", f"name known outputs, not {name!r}", remedy=f"one of {self.outputs}")
        if "trajectory" in outputs and not timed:
            raise InvalidParameter("times", "be given when a trajectory is asked for")
        return outputs


def _ended(motion: Motion, horizon: float) -> str | None:
    if motion.end is not None and float(motion.end.time) <= horizon:
        return motion.end.kind
    return HORIZON if math.isfinite(horizon) else None


def _events(motion: Motion, horizon: float) -> list[Mapping[str, Any]]:
    happened = [event for event in motion.events() if float(event.time) <= horizon]
    return [{"kind": event.kind, "time": event.time} for event in happened]


def _existing(motion: Motion, instants: Floats) -> Floats:
    """Return the instants at which there is a motion; samples past its end are not invented."""
    if float(np.min(instants, initial=0.0)) < motion.valid_from:
        raise InvalidParameter(
            "times",
            f"be at least {motion.valid_from:.17g} s",
            remedy="the model does not hold earlier; start from an earlier state",
        )
    return instants if motion.end is None else instants[instants <= float(motion.end.time)]


def _checked(times: Floats) -> Floats:
    instants = np.asarray(times, dtype=np.float64)
    if instants.ndim != 1:
        raise InvalidParameter("times", "be a list of numbers")
    if not np.all(np.isfinite(instants)):
        raise InvalidParameter("times", "be finite")
    return instants


def finite(values: Mapping[str, Floats]) -> Mapping[str, Floats]:
    """Return the columns, or refuse them if a sample has left the range of doubles."""
    for name, column in values.items():
        if not np.all(np.isfinite(column)):
            raise InvalidParameter(
                "times", f"keep {name} inside the range of double precision", remedy="ask for shorter times"
            )
    return values
