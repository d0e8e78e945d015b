"""The members of a study, answered: each by the ordinary way of a request, or many at a time with the same bits."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf, isfinite, nan
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.assessment.figures import steps_of, value_at
from core.assessment.propagation import changed
from core.errors import MechanicsError, Path
from service.observability.logs import LOG
from service.problems import code_of
from service.routes.assessments.route_source import Refused, RouteSource
from service.routing import Answer, Columns

FAULT = "internal-error"
"""Code of a member whose answer is a fault of the service."""

NO_ROOM = "no-room"

TOGETHER = 8192
"""Members that are answered at a time where many are: few enough that their process answers its scheduler between."""

BYTES_OF_A_FILE = 4096
"""Beside its numbers, as folders round it up."""

FILES_PER_SECOND = 4
"""Stretches of members have half a second, unless they are the last."""

TRIED = 64
"""Members of the sample that is tried before a study is worked on."""

GOLDEN = 0.6180339887498949
"""The golden ratio less 1, whose multiples modulo 1 are spread most evenly."""

LONGEST_DETAIL = 300
"""Characters of a problem's detail that are repeated in the state of a study."""

Labels = NDArray[np.uint16]


@dataclass(frozen=True, eq=False)
class Block:
    """Members that follow each other, with their results.

    Attributes
    ----------
    start : int
        Number of the first.
    inputs : ndarray, shape (n, a)
        Of each varied input its number, or its place in `values`.
    figures : ndarray, shape (n, q)
        NaN where an answer has none.
    failures, warnings : ndarray, shape (n,)
        0 for none, k for the k-th of the names.
    failure_names, warning_names : tuple of str
        Codes of problems; codes of warnings, several joined by commas.
    """

    start: int
    inputs: Floats
    figures: Floats
    failures: Labels
    warnings: Labels
    failure_names: tuple[str, ...]
    warning_names: tuple[str, ...]

    def document(self) -> Answer:
        """Return the block as it is written."""
        return {
            "start": self.start,
            "inputs": self.inputs,
            "figures": self.figures,
            "failures": self.failures,
            "warnings": self.warnings,
            "failure_names": list(self.failure_names),
            "warning_names": list(self.warning_names),
        }


class Reason(NamedTuple):
    """Why a member has no answer: the code and the detail of its problem."""

    code: str
    detail: str


class _Names:
    """Names in the order in which they occur, and their labels from 1; no name has 0."""

    def __init__(self) -> None:
        self._labels: dict[tuple[str, ...], int] = {}

    def label(self, codes: tuple[str, ...]) -> int:
        return self._labels.setdefault(codes, len(self._labels) + 1) if codes else 0

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(map(",".join, self._labels))


class _Rows(NamedTuple):
    """Members that follow each other, and where their results are written; see `Block`."""

    numbers: Floats
    figures: Floats
    failures: Labels
    warnings: Labels
    failed: _Names
    warned: _Names


class Members:
    """Answers members.

    Parameters
    ----------
    question : StudyRequest
    source : RouteSource
        Answers the question and others to its path.
    """

    def __init__(self, question: Any, source: RouteSource) -> None:
        self._source, self._request = source, question.question.request
        self.design = question.all_members()
        self._places: list[list[Path]] = [
            [steps_of(entry.pointer), *map(steps_of, entry.also)] for entry in self.design.inputs
        ]
        self._figures = [steps_of(pointer) for pointer in question.quantities]

    @cached_property
    def together(self) -> bool:
        """Whether members are answered many at a time."""
        return self._many(self.design.numbers(0, 1)) is not None

    def bytes_of(self, seconds: float) -> int:
        """Return what the results of all members take, if these take some processor time (s)."""
        count: int = self.design.members
        each = 8 * (len(self._places) + len(self._figures)) + 4
        return count * each + BYTES_OF_A_FILE * min(count, 1 + int(FILES_PER_SECOND * seconds))

    def read(self, member: int) -> Any:
        """Return the question that a member asks, or raise its refusal."""
        return self._source.read(self._document(self.design.numbers(member, member + 1)[0].tolist()).encode())

    def block(self, start: int, stop: int, seconds: float = inf) -> Block:
        """Return the results of the members from `start` up to `stop`, or of the first of them if time runs out.

        Parameters
        ----------
        seconds : float
            Time after which no further member is begun; one is answered in any case.
        """
        until = perf_counter() + seconds
        numbers = self.design.numbers(start, stop)
        figures = np.full((stop - start, len(self._figures)), nan)
        failures, warnings = np.zeros(stop - start, np.uint16), np.zeros(stop - start, np.uint16)
        failed, warned = _Names(), _Names()
        done = 0
        while done < stop - start and not (done and perf_counter() > until):
            piece = slice(done, done + TOGETHER)
            rows = _Rows(numbers[piece], figures[piece], failures[piece], warnings[piece], failed, warned)
            done += self._answer(rows, until)
        names = failed.names, warned.names
        return Block(start, numbers[:done], figures[:done], failures[:done], warnings[:done], *names)

    def _answer(self, rows: _Rows, until: float) -> int:
        """Fill in the results of some members, and return of how many before the time was up; at least of one."""
        many = self._many(rows.numbers)
        single: Sequence[int] = range(len(rows.numbers))
        if many is not None:
            rows.figures[many.answered] = many.figures[many.answered]
            for code, which in many.warned.items():
                if (which & many.answered).any():
                    rows.warnings[which & many.answered] = rows.warned.label((code,))
            single = np.flatnonzero(~many.answered).tolist()
        for k in single:
            if k and perf_counter() > until:
                return k
            answer = self._answered(rows.numbers[k].tolist())
            if isinstance(answer, Reason):
                rows.failures[k] = rows.failed.label((answer.code,))
                continue
            row = [_figure(answer, path) for path in self._figures]
            if not all(value is None or isfinite(value) for value in row):
                rows.failures[k] = rows.failed.label((FAULT,))
                continue
            rows.figures[k] = [nan if value is None else value for value in row]
            codes = sorted({notice.code for notice in answer.get("warnings", ())})
            rows.warnings[k] = rows.warned.label(tuple(codes))
        return len(rows.numbers)

    def failed(self, start: int, stop: int, code: str) -> Block:
        """Return members that could not be answered, all for one reason."""
        none = np.zeros(stop - start, np.uint16)
        figures = np.full((stop - start, len(self._figures)), nan)
        return Block(start, self.design.numbers(start, stop), figures, none + np.uint16(1), none, (code,), ())

    def _many(self, numbers: Floats) -> Any:
        many = self._source.route.many
        if many is None or any(
            entry.values is not None and not _all_numbers(entry.values) for entry in self.design.inputs
        ):
            return None
        columns: Columns = {
            place: self._column(k, numbers[:, k]) for k, places in enumerate(self._places) for place in places
        }
        try:
            return many(self._request, columns, self._figures)
        except Exception:
            # What fails for many together is a fault of the service, which each of them may do without.
            LOG.exception("members could not be answered together")
            return None

    def _column(self, k: int, numbers: Floats) -> Floats:
        values = self.design.inputs[k].values
        return numbers if values is None else np.array(values, dtype=np.float64)[numbers.astype(np.int64)]

    def _document(self, numbers: Sequence[float]) -> str:
        """Return a member's request as JSON."""
        changes: dict[Path, Any] = {}
        for entry, places, number in zip(self.design.inputs, self._places, numbers, strict=True):
            changes |= dict.fromkeys(places, entry.value(number))
        return json.dumps(changed(self._request, changes))

    def _answered(self, numbers: Sequence[float]) -> Answer | Reason:
        """Return a member's answer, or why there is none."""
        try:
            return self._source.answer(self._document(numbers))
        except Refused as refused:
            return Reason(refused.refusal.problem.type.code, str(refused.refusal.problem.detail))
        except MechanicsError as error:
            return Reason(code_of(error), str(error))
        except MemoryError:
            return Reason(NO_ROOM, "the process lacks the memory for its answer")
        except Exception:
            return Reason(FAULT, "the service failed")

    def trial(self, seconds: float) -> str:
        """Return why no member of a sample has an answer: for each code the number of members and one of them.

        Empty if a member has an answer, which ends the trial, or if time runs out. If one member in 20 of the study has
        an answer, all of the sample are refused with a probability of 4 %; if one in ten has, of 0.1 %.

        Parameters
        ----------
        seconds : float
            Time after which no further member is begun.
        """
        until = perf_counter() + seconds
        count: int = self.design.members
        reasons: dict[str, list[tuple[int, str]]] = {}
        # Multiples of an irrational number: evenly spaced members could all have the same value of an inner input.
        sample = sorted({int(count * (k * GOLDEN % 1.0)) for k in range(TRIED)}) if count > TRIED else range(count)
        for member in sample:
            if perf_counter() > until:
                return ""
            answer = self._answered(self.design.numbers(member, member + 1)[0].tolist())
            if not isinstance(answer, Reason):
                return ""
            reasons.setdefault(answer.code, []).append((member, answer.detail))
        return "; ".join(
            f"{len(members)} of {len(sample)} members tried: {code}, such as member {members[0][0]}: "
            f"{shortened(members[0][1])}"
            for code, members in sorted(reasons.items(), key=lambda entry: -len(entry[1]))
        )


def shortened(detail: str) -> str:
    """Return a detail, or its beginning where it is long."""
    return detail if len(detail) <= LONGEST_DETAIL else f"{detail[:LONGEST_DETAIL]}..."


def number_of(value: Any) -> float | None:
    """Return a figure as a double, truth values as 1 and 0, decimal strings rounded; None for what is no number."""
    if isinstance(value, (bool, float)):
        return float(value)
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            return None
    return None


def _figure(answer: Mapping[str, Any], path: Path) -> float | None:
    return number_of(value_at(answer, path))


def _all_numbers(values: Sequence[Any]) -> bool:
    return all(type(value) in (int, float) for value in values)
