"""Numbers of a question, and of the instrument, found from data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.arrays import Floats, largest_magnitude
from core.assessment.figures import steps_of
from core.assessment.propagation import SETTINGS, at, changed, numbers_of
from core.assessment.question_source import Source
from core.errors import BudgetExceeded, InvalidParameter, MechanicsError, NotApplicable, Path, inside_field, pointer_of
from core.fits.computed import Computed
from core.fits.losses import Robust
from core.fits.model import Model
from core.fits.observations import Measured, Observations
from core.fits.problem import Problem
from core.fits.search import polished, sought
from core.fits.statistics import Statistics, statistics
from core.fits.unknowns import Nuisance, Unknown
from core.near_names import did_you_mean

MOST_UNKNOWNS = 20
"""Numbers of the question and of the instrument together."""

MOST_SLOPES = 4_000_000
"""Numbers of data times numbers that are found: the slopes are held in some copies."""

ANOTHER = 4.0
"""Chi-squared by which another minimum may be worse and still be worth naming: two standard deviations."""
APART = 3.0
"""Standard errors that separate two minima."""


@dataclass(frozen=True)
class Data:
    """Measured columns, and which figures of the answer they are.

    Attributes
    ----------
    measured : Measured
    figures : mapping of str to Any
        By column: the name of a column of the answer or of a component of one, or a figure as requests name it.
    """

    measured: Measured
    figures: Mapping[str, Any]


@dataclass(frozen=True)
class Fit:
    """What data say of the numbers of a question.

    Attributes
    ----------
    names : tuple of str
        Pointers of the unknown numbers, then of the instrument's.
    unknowns : int
        How many of them are the question's.
    values : ndarray, shape (k,)
    statistics : Statistics
    data : Observations
    residuals : ndarray, shape (n, m)
        Data minus figures, in SI units.
    units : tuple of str
        These units.
    at_ends : tuple of str
        Numbers at an end of their range.
    others : tuple of ndarray
        Numbers of other minima that fit nearly as well.
    evaluations : int
        Times that the question was answered.
    """

    names: tuple[str, ...]
    unknowns: int
    values: Floats
    statistics: Statistics
    data: Observations
    residuals: Floats
    units: tuple[str, ...]
    at_ends: tuple[str, ...]
    others: tuple[Floats, ...]
    evaluations: int


def fit(
    source: Source,
    request: Any,
    data: Data,
    unknown: Sequence[Unknown],
    nuisance: Sequence[Nuisance] = (),
    robust: Robust | None = None,
    *,
    trials: Source | None = None,
) -> Fit:
    """Find numbers of a question from data.

    Parameters
    ----------
    source : Source
        Answers the question.
    request : Any
        As it would be sent.
    data : Data
    unknown : sequence of Unknown
    nuisance : sequence of Nuisance
    robust : Robust, optional
        Squares if omitted.
    trials : Source, optional
        Answers the questions on the way, where that costs less.

    Raises
    ------
    InvalidParameter
        With a path from ("data",), ("unknown",) or ("nuisance",).
    MechanicsError
        What the question is refused with at every start.
    """
    try:
        with np.errstate(all="ignore"):
            return _fitted(source, request, data, unknown, nuisance, robust, trials or source)
    except MechanicsError:
        raise
    except (np.linalg.LinAlgError, OverflowError, ValueError) as fault:
        # Of SciPy and numpy, about numbers that are not finite.
        raise _out_of_range() from fault


def _fitted(
    source: Source,
    request: Any,
    data: Data,
    unknown: Sequence[Unknown],
    nuisance: Sequence[Nuisance],
    robust: Robust | None,
    trials: Source,
) -> Fit:
    paths = [_path(one, k) for k, one in enumerate(unknown)]
    doubles = {path for path in paths if paths.count(path) > 1}
    if doubles:
        where = next(k for k, path in enumerate(paths) if path in doubles and path in paths[:k])
        raise InvalidParameter(("unknown", where, "pointer"), "lead to a number that no other entry has")
    request, begun = _started(request, unknown, paths)
    measured = data.measured
    with inside_field("data"):
        rows = measured.observations()
    computed = Computed(trials, request, paths, data.figures, rows.times, len(rows.rows))
    stated = computed.stated(begun, source)
    with inside_field("data"):
        factors = [measured.factor(name, unit) for name, (unit, _) in zip(rows.names, stated, strict=True)]
        observed = rows.times_factors(factors)
    model = Model(computed, len(unknown), nuisance, observed)
    start = np.concatenate([begun, model.start])
    priors = sum(one.prior is not None for one in unknown)
    if len(start) > MOST_UNKNOWNS:
        raise InvalidParameter("unknown", f"be at most {MOST_UNKNOWNS} with those of the instrument")
    if observed.values.size * len(start) > MOST_SLOPES:
        remedy = "send fewer rows or columns"
        raise BudgetExceeded(
            "slopes", observed.values.size * len(start), MOST_SLOPES, path=("data", "columns"), remedy=remedy
        )
    if observed.values.size + priors < len(start):
        rule = f"have at least as many numbers as there are unknowns: {observed.values.size} for {len(start)}"
        raise InvalidParameter(("data", "columns"), rule, remedy="send more rows, or give priors")
    if robust is not None and observed.deviations is None:
        raise InvalidParameter(
            ("data", "standard_deviations"), "be given where the loss is robust: it is in their unit"
        )
    size = [max(largest_magnitude(observed.values[:, k]), 1e-300) for k in range(len(stated))]
    error = max(bound / one for (_, bound), one in zip(stated, size, strict=True))
    problem = Problem(model, observed, unknown, start, robust, error)
    ends = sought(problem, unknown)
    numbers, slopes, left = polished(problem, ends[0][0])
    errors = [bound for _, bound in computed.stated(numbers[: len(unknown)], source)]
    found = statistics(problem, numbers, slopes, left, errors)
    if not found.finite:
        raise _out_of_range()
    residuals = observed.values - model.shown(numbers)
    names = (*(one.pointer for one in unknown), *model.names)
    at_ends = tuple(name for name, end in zip(names, problem.at_ends(numbers), strict=True) if end)
    return Fit(
        names,
        len(unknown),
        numbers,
        found,
        observed,
        residuals,
        tuple(unit for unit, _ in stated),
        at_ends,
        _others(ends, found, numbers, problem.unit),
        computed.evaluations,
    )


def _out_of_range() -> NotApplicable:
    remedy = "choose units in which data, deviations and numbers are moderate"
    return NotApplicable("the fit leaves the range of doubles", path=("data", "columns"), remedy=remedy)


def _path(unknown: Unknown, index: int) -> Path:
    try:
        return steps_of(unknown.pointer)
    except InvalidParameter:
        raise InvalidParameter(("unknown", index, "pointer"), "be a JSON pointer into the request") from None


def _started(request: Any, unknown: Sequence[Unknown], paths: Sequence[Path]) -> tuple[Any, Floats]:
    """Return the request with the starts of the unknown numbers, and these."""
    begun: list[float] = []
    for k, (one, path) in enumerate(zip(unknown, paths, strict=True)):
        written = at(request, path)
        is_number = isinstance(written, (int, float)) and not isinstance(written, bool)
        if written is None or not (is_number or isinstance(written, str)) or path[0] in SETTINGS:
            known = [pointer_of(other) for other, _ in numbers_of(request, zeros=True)]
            near = did_you_mean(one.pointer, known)
            raise InvalidParameter(("unknown", k, "pointer"), "lead to a number of the request", remedy=near)
        if one.start is not None:
            begun.append(one.start)
        elif is_number and (one.between is None or one.between[0] <= written <= one.between[1]):
            begun.append(float(written))
        elif one.between is not None:
            begun.append(0.5 * one.between[0] + 0.5 * one.between[1])
        else:
            raise InvalidParameter(("unknown", k, "start"), "be given where the request has a formula")
    return changed(request, dict(zip(paths, begun, strict=True))), np.array(begun)


def _others(
    ends: Sequence[tuple[Floats, float]], found: Statistics, numbers: Floats, unit: float
) -> tuple[Floats, ...]:
    """Return the numbers of other minima that fit nearly as well as the best."""
    others: list[Floats] = []
    variance = (found.deviation / unit) ** 2
    size = np.maximum(found.standard_errors, 1e-6 * np.abs(numbers)) * APART
    for other, cost in ends[1:]:
        near = any(np.all(np.abs(other - known) <= np.maximum(size, 1e-300)) for known in (numbers, *others))
        if not near and cost <= ends[0][1] + ANOTHER * variance:
            others.append(other)
    return tuple(others)
