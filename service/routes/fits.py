"""POST /v1/fits: numbers of a question found from measured data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from core.arrays import Floats
from core.errors import Path, inside_field
from core.fits.comparison import compared
from core.fits.fit import Data, Fit, fit
from core.fits.losses import Robust
from core.fits.observations import MOST_COLUMNS, Measured
from core.fits.statistics import INVOLVED
from core.fits.unknowns import Nuisance, Unknown
from core.fits.wording import combination
from core.notices import Notice
from core.quantities import Unit
from core.systems.budget import Budget
from service.problems import Refusal
from service.requests.figures import WrittenFigure
from service.responses.linear_svg import Line, Panel, panels
from service.responses.svg import SVG
from service.responses.unit_text import unit_text
from service.routes.assessments.question_table import WITHIN, EndpointRequest, QuestionTable, moved_inside
from service.routes.assessments.route_source import Refused
from service.routing import Answer, PostRoute
from service.schemas import Envelope, Ratio, Request, Seconds, View

MOST_COMPARED = 5
MOST_NUISANCES = 10

OWN_UNIT = Unit("as of the number")
PRODUCT = Unit("product of those of the two numbers")
COLUMN_UNIT = Unit("as in units")

Sent = Annotated[float, Field(allow_inf_nan=False)]


class FitData(Request):
    """Measured data by column, all of one length; null where a number is missing."""

    columns: dict[str, list[Sent | None]] = Field(
        description=f"Numbers by the name of the column, at most {MOST_COLUMNS} columns. Rows count from 0."
    )
    times: str | None = Field(
        default=None, description="The column of times; left out where figures are not of a time, such as a period."
    )
    figures: dict[str, WrittenFigure] = Field(
        min_length=1,
        description="Which figures of the answer columns are: bob.position.x, wheel.angle, angular_velocity.y, or a "
        "JSON pointer, an event or a count.",
    )
    standard_deviations: dict[str, Sent | list[Sent | None] | str] = Field(
        default={},
        description="Of columns of figures, in their unit: one number, one for each row, or the name of a column. Left "
        "out for the only column, one deviation is estimated from the residuals.",
    )
    units: dict[str, str] = Field(
        default={}, description="Of columns that are not in the SI unit of their figure, or of times: cm, deg, ms."
    )


class FitModel(Request):
    """Another question for the same data."""

    question: EndpointRequest
    unknown: list[Unknown] = Field(min_length=1, description="Numbers of its request that are to be found.")


class FitRequest(FitModel):
    """A question, measured data, and which numbers of the question they are to find."""

    COLUMNS_AT: ClassVar[Path] = ("data", "columns")
    """Where the columns of a file are put, if they are one."""

    data: FitData
    nuisance: list[Nuisance] = Field(
        default=[],
        max_length=MOST_NUISANCES,
        description="What is not known of the instrument. data = offset + scale * (figures along turned axes, at the "
        "times of the data plus the time shift); each entry is one number, a frame in space three.",
    )
    robust: Robust | None = Field(
        default=None, description="A loss that grows less than squares, for data with outliers; default: squares."
    )
    compare: list[FitModel] = Field(
        default=[],
        max_length=MOST_COMPARED,
        description="Other questions, fitted to the same data with the same nuisance and loss.",
    )


class FittedNumber(View):
    """A number that was found."""

    value: Annotated[float, OWN_UNIT]
    standard_error: Annotated[float | None, OWN_UNIT] = Field(
        description="null where the data do not determine it, or leave nothing to estimate deviations from."
    )
    interval: Annotated[tuple[float, float] | None, OWN_UNIT] = Field(
        description="Of 95 %: so many standard errors to either side, and what the computed motions may add."
    )


class NotDetermined(View):
    """A combination of numbers that the data do not determine."""

    combination: str = Field(description="In words.")
    direction: dict[str, Ratio[float]] = Field(
        description="Relative changes of the numbers by pointer, the largest 1; of a number that is 0, over its scale."
    )


class ComparedQuestion(View):
    """How another question fits the same data."""

    chi_squared: Ratio[float]
    degrees_of_freedom: int = Field(json_schema_extra={"x-unit": "1"})
    earns: bool = Field(
        description="Whether the further unknowns, of whichever question has more, lower chi-squared by more than "
        "chance does in one of twenty cases; of two with as many, whether this one is twenty times as likely."
    )
    why: str
    parameters: dict[str, FittedNumber]


class FitAnswer(Envelope):
    """Numbers that fit data best, and how well they are known."""

    parameters: dict[str, FittedNumber] = Field(description="By pointer into the request of the question.")
    nuisance: dict[str, FittedNumber] = Field(
        description="By pointer into this request, in SI units; the components of a turn in space end with /x, /y, /z."
    )
    covariance: list[list[Annotated[float | None, PRODUCT]]] = Field(description="In the order of unknown.")
    correlation: list[list[Ratio[float] | None]] = Field(description="In the order of unknown.")
    chi_squared: Ratio[float] = Field(
        description="Sum of the squares of the residuals in their standard deviations, and of the priors; where a "
        "deviation is estimated, of the residuals in SI units."
    )
    degrees_of_freedom: int = Field(
        description="Numbers of data and priors less those found.", json_schema_extra={"x-unit": "1"}
    )
    probability: Ratio[float] | None = Field(
        description="With which chance makes chi-squared larger; null where the deviation is estimated, or nothing is "
        "left to test."
    )
    standard_deviation: Annotated[float | None, COLUMN_UNIT] = Field(
        description="That was estimated from the residuals; null where deviations are given."
    )
    time: list[Seconds[float] | None] | None = Field(description="Of the rows.")
    residuals: dict[str, list[Annotated[float | None, COLUMN_UNIT]]] = Field(
        description="Data minus figures by column and row, in SI units; null where the row was left out."
    )
    units: dict[str, str] = Field(description="SI units of the residuals, by column.")
    left_out: list[int] = Field(description="Rows in which a number is missing.", json_schema_extra={"x-unit": "1"})
    outliers: list[int] = Field(
        description="Rows with a residual that is larger than all of as many normal ones are in 99 of 100 cases.",
        json_schema_extra={"x-unit": "1"},
    )
    not_determined: list[NotDetermined]
    comparison: list[ComparedQuestion] = Field(description="In the order of compare.")
    model_error: dict[str, Annotated[float, OWN_UNIT]] = Field(
        description="By how much errors of the computed figures, and the end of the search, may move each number."
    )
    evaluations: int = Field(description="Times that the question was answered.", json_schema_extra={"x-unit": "1"})


SUMMARY = "Numbers of a question found from measured data, with covariance, and what the data do not determine"

DESCRIPTION = """Least squares, in standard deviations, of data minus what the question computes at the times of the
data. Rows in which a number is missing (null) are left out and named. Ranges (`between`) are searched from many starts.
Where no start explains the data, the early rows are fitted first. The data may be sent as CSV or as a numpy archive
beside the request: see the guide on fitting.
`Accept: image/svg+xml` draws the residuals."""


def fitting(routes: Sequence[PostRoute]) -> PostRoute:
    """Return the route that finds numbers of questions to `routes`."""
    table = QuestionTable(routes, (), "be fitted to data")

    def handle(question: FitRequest, budget: Budget) -> Answer:
        found = _fitted(table, question, question, budget)
        others = []
        for k, other in enumerate(question.compare):
            try:
                with inside_field("compare", k):
                    others.append(_fitted(table, other, question, budget))
            except Refusal as refusal:
                raise moved_inside(refusal.problem, ("compare", k)) from None
        return _view(found, others)

    return PostRoute(
        "/v1/fits", "fit", SUMMARY, "assessment", FitRequest, FitAnswer, handle, description=DESCRIPTION,
        representations={SVG: draw_residuals},
    )  # fmt: skip


def _fitted(table: QuestionTable, asked: FitModel, question: FitRequest, budget: Budget) -> Fit:
    """Return the fit of a question; the answer at the numbers found is held against its description, trials are not."""
    given = question.data
    measured = Measured(given.columns, given.times, tuple(given.figures), given.standard_deviations, given.units)
    table.readable(asked.question)
    source, trials = (table.source(asked.question, one) for one in (budget, replace(budget, audited=False)))
    data = Data(measured, given.figures)
    request, unknown = asked.question.request, asked.unknown
    try:
        return fit(source, request, data, unknown, question.nuisance, question.robust, trials=trials)
    except Refused as refused:
        # By the reader of the question, with the numbers from which the search starts.
        raise moved_inside(refused.refusal.problem, WITHIN) from None


def _view(found: Fit, others: Sequence[Fit]) -> Answer:
    known, data = found.statistics, found.data
    numbers = _numbers(found)
    count = found.unknowns
    covariance, correlation = known.covariance[:count, :count], known.correlation[:count, :count].copy()
    np.fill_diagonal(correlation, 1.0)
    lost = ~known.determined[:count]
    estimated = data.deviations is None
    warnings = [
        Notice("at-end-of-range", f"{name} is at an end of its range: its error is not what limits it", ("unknown",))
        for name in found.at_ends
    ]
    warnings += [
        Notice("other-minimum", f"the data are explained nearly as well by {_listed(found.names, other)}", ("unknown",))
        for other in found.others
    ]
    if data.left_out:
        rows = ", ".join(map(str, data.left_out[:20]))
        warnings.append(Notice("rows-left-out", f"a number is missing in rows {rows}"[:300], ("data", "columns")))
    return {
        "parameters": {name: numbers[name] for name in found.names[:count]},
        "nuisance": {name: numbers[name] for name in found.names[count:]},
        "covariance": _with_nulls(covariance, lost),
        "correlation": _with_nulls(correlation, lost),
        "chi_squared": known.chi_squared,
        "degrees_of_freedom": known.degrees_of_freedom,
        "probability": known.probability,
        "standard_deviation": known.deviation if estimated else None,
        "time": None if data.times is None else _by_row(data.times, found),
        "residuals": {name: _by_row(found.residuals[:, k], found) for k, name in enumerate(data.names)},
        "units": dict(zip(data.names, found.units, strict=True)),
        "left_out": data.left_out,
        "outliers": [int(data.rows[k]) for k in known.outliers],
        "not_determined": [
            {
                "combination": combination(one, found.names),
                "direction": {
                    name: share
                    for name, share in zip(found.names, one.direction.tolist(), strict=True)
                    if abs(share) > INVOLVED
                },
            }
            for one in known.undetermined
        ],
        "comparison": [_compared(found, other) for other in others],
        "model_error": dict(zip(found.names, known.model_error.tolist(), strict=True)),
        "evaluations": found.evaluations,
        "warnings": warnings,
    }


def _compared(found: Fit, other: Fit) -> Answer:
    one, numbers = compared(found, other), _numbers(other)
    return {
        "chi_squared": one.chi_squared,
        "degrees_of_freedom": one.degrees_of_freedom,
        "earns": one.earns,
        "why": one.why,
        "parameters": {name: numbers[name] for name in other.names[: other.unknowns]},
    }


def _numbers(found: Fit) -> dict[str, Answer]:
    known = found.statistics
    shown = known.determined & (known.standard_errors > 0.0)
    return {
        name: {
            "value": value,
            "standard_error": error if seen else None,
            "interval": [value - half, value + half] if seen else None,
        }
        for name, value, error, half, seen in zip(
            found.names,
            found.values.tolist(),
            known.standard_errors.tolist(),
            known.half_widths.tolist(),
            shown.tolist(),
            strict=True,
        )
    }


def _with_nulls(matrix: Floats, lost: Any) -> list[list[float | None]]:
    return [
        [None if lost[i] or lost[j] else value for j, value in enumerate(row)] for i, row in enumerate(matrix.tolist())
    ]


def _by_row(values: Floats, found: Fit) -> list[float | None]:
    """Return values of complete rows at the places of the rows that were sent."""
    rows: list[float | None] = [None] * found.data.sent
    for row, value in zip(found.data.rows.tolist(), values.tolist(), strict=True):
        rows[row] = value
    return rows


def _listed(names: Sequence[str], numbers: Floats) -> str:
    return ", ".join(f"{name} = {number:.6g}" for name, number in zip(names, numbers.tolist(), strict=True))


def draw_residuals(answer: Answer) -> bytes:
    """Return the residuals over time, or over the rows, as an SVG document: a panel for each column."""
    shown = []
    for name, residuals in answer["residuals"].items():
        rows = [k for k, value in enumerate(residuals) if value is not None]
        across = rows if answer["time"] is None else [answer["time"][k] for k in rows]
        up = f"{name}: data minus figure ({unit_text(answer['units'][name])})"
        points = Line("", np.array(across, dtype=float), np.array([residuals[k] for k in rows]), dots=True)
        zero = Line("", np.array([min(across), max(across)], dtype=float), np.zeros(2))
        shown.append(Panel("row" if answer["time"] is None else "time (s)", up, [points, zero]))
    chance = answer["probability"]
    title = "Residuals" if chance is None else f"Residuals; a larger chi-squared has a probability of {chance:.3g}"
    return panels(title, shown).encode()
