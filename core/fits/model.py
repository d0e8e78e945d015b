"""What is compared with the data: figures as the instrument shows them, and their slopes by all unknown numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter, MechanicsError
from core.fits.computed import Computed
from core.fits.instrument import STAGES, Stage, observed
from core.fits.observations import Observations
from core.fits.unknowns import Nuisance

TIME_STEP = 2.0**-20
"""Of the span of the times: over which figures are differenced by time."""


class Model:
    """Figures as functions of unknown numbers of a question, and of those of an instrument, one after the other.

    Parameters
    ----------
    computed : Computed
    count : int
        Unknown numbers of the question.
    nuisances : sequence of Nuisance
    data : Observations
    """

    def __init__(self, computed: Computed, count: int, nuisances: Sequence[Nuisance], data: Observations) -> None:
        self._computed, self.count = computed, count
        self.names: list[str] = []
        """Of the instrument's numbers."""
        self._stages: list[tuple[Stage, slice]] = []
        self._shifts: list[tuple[list[int], int]] = []
        """Columns whose times are shifted, and the place of the shift."""
        starts: list[float] = []
        scales: list[float] = []
        factors: list[int] = []
        self._span = 0.0 if data.times is None else float(np.max(np.abs(data.times), initial=0.0))
        staged: dict[int, tuple[Stage, slice]] = {}
        for k, nuisance in enumerate(nuisances):
            columns = data.places(nuisance.columns, ("nuisance", k, "figure"))
            pointer, place = f"/nuisance/{k}", count + len(starts)
            if nuisance.kind == "time shift":
                if data.times is None:
                    raise InvalidParameter(("nuisance", k, "kind"), "be another one where the data have no times")
                if any(set(columns) & set(others) for others, _ in self._shifts):
                    raise InvalidParameter(("nuisance", k, "figure"), "name columns that no other time shift has")
                self._shifts.append((columns, place))
                self.names.append(pointer)
                starts.append(0.0)
                scales.append(self._span or 1.0)
                continue
            stage = STAGES[nuisance.kind](columns)
            staged[k] = stage, slice(place, place + len(stage.start))
            self.names += [pointer + end for end in stage.names]
            starts += stage.start.tolist()
            spread = float(np.max(np.std(data.values[:, columns], axis=0), initial=0.0)) or 1.0
            scales += [spread if nuisance.kind == "offset" else 1.0] * len(stage.start)
            factors += [place] if nuisance.kind == "scale" else []
        order = list(STAGES)
        for k in sorted(staged, key=lambda k: order.index(nuisances[k].kind)):
            self._stages.append(staged[k])
        self.start, self.scales = np.array(starts), np.array(scales)
        """Of the instrument's numbers: where it is perfect, and changes that matter."""
        self.relative = np.array([*range(count), *factors], dtype=np.int64)
        """Places of the numbers whose changes are seen beside their own size."""

    def shown(self, numbers: Floats) -> Floats:
        """Return the figures as the instrument shows them, shape (n, m)."""
        return observed(self._stages, self._figures(numbers), (), numbers)[0]

    def slopes(self, numbers: Floats, steps: Floats, *, central: bool) -> Floats:
        """Return the slopes by all numbers, shape (n, m, k).

        Parameters
        ----------
        steps : ndarray, shape (count,)
            By which the numbers of the question are changed.
        central : bool
            Whether to either side, or upwards alone.
        """
        figures = self._figures(numbers)
        changes = [self._slope(numbers, k, float(steps[k]), figures, central) for k in range(self.count)]
        in_time = [self._in_time(numbers, columns, place, figures) for columns, place in self._shifts]
        _, pushed, own = observed(self._stages, figures, [*changes, *in_time], numbers)
        found = np.zeros((*figures.shape, len(numbers)))
        for k in range(self.count):
            found[..., k] = pushed[k]
        for (_, place), slope in zip(self._shifts, pushed[self.count :], strict=True):
            found[..., place] = slope
        for place, slope in own.items():
            found[..., place] = slope
        return found

    def _figures(self, numbers: Floats) -> Floats:
        """Return the figures, each column at the times that its clock has shown."""
        own = numbers[: self.count]
        shifts = [float(numbers[place]) for _, place in self._shifts]
        shifted = [column for columns, _ in self._shifts for column in columns]
        found = None
        for (columns, _), shift in zip(self._shifts, shifts, strict=True):
            moved = self._computed(own, shift)
            found = np.array(moved) if found is None else found
            found[:, columns] = moved[:, columns]
        if found is None:
            return self._computed(own)
        rest = [column for column in range(found.shape[1]) if column not in shifted]
        if rest:
            found[:, rest] = self._computed(own)[:, rest]
        return found

    def _slope(self, numbers: Floats, k: int, step: float, figures: Floats, central: bool) -> Floats:
        """Return the slope by a number of the question, from one side where there is no answer on the other."""
        sides = []
        fault: MechanicsError | None = None
        for sign in (1.0, -1.0):
            moved = numbers.copy()
            moved[k] += sign * step
            try:
                sides.append((moved[k], self._figures(moved)))
            except MechanicsError as error:
                fault = error
                continue
            if not central:
                break
        if not sides:
            assert fault is not None
            raise fault
        if len(sides) == 1:
            sides.append((numbers[k], figures))
        (one, more), (other, less) = sides
        found: Floats = (more - less) / (one - other)
        return found

    def _in_time(self, numbers: Floats, columns: list[int], place: int, figures: Floats) -> Floats:
        step = np.zeros_like(numbers)
        step[place] = (self._span or 1.0) * TIME_STEP
        sides = []
        for sign in (1.0, -1.0):
            try:
                sides.append((sign * step[place], self._figures(numbers + sign * step)))
            except MechanicsError:
                sides.append((0.0, figures))
        (one, more), (other, less) = sides
        found = np.zeros_like(figures)
        if one != other:
            found[:, columns] = ((more - less) / (one - other))[:, columns]
        return found
