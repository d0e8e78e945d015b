"""Measured data as rows of numbers: which are complete, in which units, and how well each is known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.units import factor
from core.errors import InvalidParameter, Path
from core.near_names import did_you_mean

MOST_ROWS, MOST_COLUMNS = 100_000, 40

RELATIVE = "without them it is not known how much each column counts; the deviation of one column alone is estimated"

Numbers = Sequence[float | None] | Floats


@dataclass(frozen=True)
class Measured:
    """Columns of numbers as they were sent, and what they mean.

    Attributes
    ----------
    columns : mapping of str to numbers
        None where a number is missing.
    times : str or None
        The column of times.
    figures : sequence of str
        The columns that are measured figures.
    standard_deviations : mapping of str to float, numbers or str
        By column of a figure: one for all rows, one for each, or the name of a column that has them.
    units : mapping of str to str
        By column, where it is not the SI unit of the figure.
    """

    columns: Mapping[str, Numbers]
    times: str | None
    figures: Sequence[str]
    standard_deviations: Mapping[str, float | Numbers | str]
    units: Mapping[str, str]

    def observations(self) -> Observations:
        """Return the complete rows, figures in the units that they were sent in.

        Raises
        ------
        InvalidParameter
            For columns that are missing, of unequal lengths, or hold what is no number; with the number of the row.
        """
        if not self.figures:
            raise InvalidParameter("figures", "name at least one column that was measured")
        if len(self.columns) > MOST_COLUMNS:
            raise InvalidParameter("columns", f"be at most {MOST_COLUMNS}")
        for field, named in (("standard_deviations", self.standard_deviations), ("units", self.units)):
            known = self.figures if field == "standard_deviations" else self.columns
            for name in named:
                if name not in known:
                    rule = f"be of a column{' of figures' if field == 'standard_deviations' else ''}"
                    raise InvalidParameter((field, name), rule, remedy=did_you_mean(name, known))
        count = len(next(iter(self.columns.values()), ()))
        if not 1 <= count <= MOST_ROWS:
            raise InvalidParameter("columns", f"have from 1 to {MOST_ROWS} rows")
        times = (
            None if self.times is None else self._column(self.times, ("times",), count) * self.factor(self.times, "s")
        )
        values = np.column_stack([self._column(name, ("figures", name), count) for name in self.figures])
        deviations = self._deviations(count)
        complete = np.isfinite(values).all(axis=1)
        for further in (times, deviations):
            if further is not None:
                complete &= np.isfinite(further.reshape(count, -1)).all(axis=1)
        rows = np.flatnonzero(complete)
        return Observations(
            count,
            rows,
            tuple(self.figures),
            None if times is None else times[rows],
            values[rows],
            None if deviations is None else deviations[rows],
        )

    def factor(self, name: str, unit: str) -> float:
        """Return what one unit of a column is in another unit."""
        try:
            return factor(self.units[name], unit) if name in self.units else 1.0
        except EntryFault as fault:
            rule = f"{fault.rule}: it is compared with what is in {unit}"
            raise InvalidParameter(("units", name), rule, remedy=fault.remedy) from None

    def _deviations(self, count: int) -> Floats | None:
        if not self.standard_deviations:
            if len(self.figures) > 1:
                raise InvalidParameter(
                    "standard_deviations", "be given for several columns of figures", remedy=RELATIVE
                )
            return None
        found = []
        for name in self.figures:
            path: Path = ("standard_deviations", name)
            given = self.standard_deviations.get(name)
            if given is None:
                remedy = "give one for every column, or, with one column of figures, none: then it is estimated"
                raise InvalidParameter(path, "be given", remedy=remedy)
            if isinstance(given, str):
                column = self._column(given, path, count)
            elif isinstance(given, (int, float)):
                column = np.full(count, float(given))
            else:
                column = _numbers(given, path, count)
            wrong = np.flatnonzero(~(column > 0.0) & ~np.isnan(column))
            if len(wrong):
                place = path if isinstance(given, (int, float, str)) else (*path, int(wrong[0]))
                raise InvalidParameter(place, f"be greater than 0 (row {wrong[0]})")
            found.append(column)
        return np.column_stack(found)

    def _column(self, name: str, path: Path, count: int) -> Floats:
        if name not in self.columns:
            raise InvalidParameter(path, "name a column of the data", remedy=did_you_mean(name, self.columns))
        return _numbers(self.columns[name], ("columns", name), count)


@dataclass(frozen=True)
class Observations:
    """Complete rows; times in seconds.

    Attributes
    ----------
    sent : int
        Number of rows that were sent.
    rows : ndarray of int, shape (n,)
        Which of these are complete, counted from 0.
    names : tuple of str
        Columns of figures.
    times : ndarray, shape (n,), or None
    values : ndarray, shape (n, m)
    deviations : ndarray, shape (n, m), or None
        Standard deviations; None where they are to be estimated.
    """

    sent: int
    rows: NDArray[np.int64]
    names: tuple[str, ...]
    times: Floats | None
    values: Floats
    deviations: Floats | None

    def times_factors(self, factors: Sequence[float]) -> Observations:
        """Return the rows with figures and deviations in other units."""
        deviations = None if self.deviations is None else self.deviations * factors
        return replace(self, values=self.values * factors, deviations=deviations)

    @property
    def left_out(self) -> list[int]:
        """Rows in which a number is missing."""
        return sorted(set(range(self.sent)) - set(self.rows.tolist()))

    def places(self, columns: Sequence[str], path: Path) -> list[int]:
        """Return the places of columns of figures."""
        for name in columns:
            if name not in self.names:
                raise InvalidParameter(path, "name a column of figures", remedy=did_you_mean(name, self.names))
        return [self.names.index(name) for name in columns]


def _numbers(given: Numbers, path: Path, count: int) -> Floats:
    """Return a column with NaN where a number is missing."""
    if len(given) != count:
        raise InvalidParameter(path, f"have as many rows as the first column, {count}, not {len(given)}")
    if isinstance(given, np.ndarray):
        wrong = np.flatnonzero(~np.isfinite(given))
    else:
        wrong = np.array([k for k, number in enumerate(given) if number is not None and not isfinite(number)])
    if len(wrong):
        row = int(wrong[0])
        raise InvalidParameter((*path, row), f"be finite (row {row})", remedy="write null where a number is missing")
    return np.array([np.nan if number is None else number for number in given], dtype=np.float64)
