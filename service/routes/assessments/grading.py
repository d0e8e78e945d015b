"""From submissions to results: each claim is read, converted, compared, and its mistakes are recognised."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from core.assessment.compare import Judgement, Reference, compare
from core.assessment.comparisons import Comparison
from core.assessment.formulas import Formula
from core.assessment.judged_formulas import FORMULA, judge_formula
from core.assessment.mistakes import Figure, Mistake, WrongValues
from core.assessment.samples import consistent_method, errors_of_samples
from core.assessment.units import factor
from core.errors import InvalidParameter, MechanicsError, Path
from core.systems.system import Floats
from core.work import spend
from service.problems import Fault, Refusal, pointer_of, problem_of
from service.routes.assessments.assessed_question import AssessedQuestion, Variation, steps_of
from service.routes.assessments.submissions import LONGEST_POINTER, MOST_CLAIMS, Claim, Unreadable, read_claim
from service.schemas import fields_of

CLAIM = 4
"""Work (`core.work`) of judging a claim."""

MOST_IDENTIFIED = 100
"""Samples in one request of which the method is looked for: that takes some 10 ms for each."""

UNITLESS = ("1", "rad")
"""Units that may be left out."""

FEEDBACK: Mapping[str, str] = {
    "correct": "Correct.",
    "incorrect": "Not correct.",
    "missing-unit": "The unit is missing.",
    "wrong-unit": "The unit does not measure this quantity.",
    "not-gradable": "This cannot be judged: the tolerance is finer than the reference is known.",
    "unreadable": "This cannot be read.",
}

Result = dict[str, Any]


class Grader:
    """Grades submissions to one question.

    Parameters
    ----------
    asked : AssessedQuestion
    comparison : Comparison or None
        Of every figure that has none of its own.
    comparisons : mapping of str to Comparison
        By pointer.
    reveal : bool
        Whether results may say anything from which the reference could be found.
    catalogue : tuple of Mistake
    credits : mapping of str to float
        By tag, in place of the catalogue's.
    names : mapping of str to path, or None
        Of the numbers of the request, in formulas.

    Attributes
    ----------
    looked_for : int
        Samples whose method was to be looked for.
    """

    def __init__(
        self,
        asked: AssessedQuestion,
        comparison: Comparison | None,
        comparisons: Mapping[str, Comparison],
        reveal: bool,
        catalogue: tuple[Mistake, ...],
        credits: Mapping[str, float],
        names: Mapping[str, Path] | None,
    ) -> None:
        self._asked, self._comparison, self._comparisons = asked, comparison, comparisons
        self._reveal, self._credits, self._names = reveal, credits, names
        # Who knows how a value is wrong can often compute the right one from it.
        self._catalogue = catalogue if reveal else ()
        self._references: dict[str, tuple[Path, Reference]] = {}
        self._samples: dict[tuple[str, bytes], Reference] = {}
        self._wrong: dict[int, WrongValues] = {}
        self._variations: dict[Path, list[Variation]] = {}
        self.looked_for = 0

    def references(self) -> list[Result]:
        """Return the references that were needed, in the order in which they were."""
        return [
            {
                "pointer": pointer,
                "value": reference.value,
                "unit": reference.unit,
                "form": reference.form,
                "error": reference.error,
                "how": reference.how,
                "inherited": reference.inherited,
                "sensitive": reference.sensitive,
            }
            for pointer, (_, reference) in self._references.items()
        ]

    def result(self, index: int, submission: Any) -> Result:
        """Return what becomes of a submission; nothing that it holds is refused with an error."""
        within: Path = ("submissions", index)
        if not isinstance(submission, dict) or not 0 < len(submission) <= MOST_CLAIMS:
            detail = f"must be an object of 1 to {MOST_CLAIMS} claims by JSON pointer"
            return _result([], [Fault(pointer_of(within), detail, 'such as {"/period": {"value": 6.28, "unit": "s"}}')])
        tests, faults = [], []
        for pointer, entry in submission.items():
            spend(CLAIM)
            try:
                tests.append(self._test(pointer, entry))
            except Unreadable as fault:
                shown = (*within, pointer) if len(pointer) <= LONGEST_POINTER else within
                faults.append(fault.fault(shown))
        return _result(tests, faults)

    def _test(self, pointer: str, entry: Any) -> Result:
        claim = read_claim(entry)
        path, reference = self._reference(pointer, claim)
        if claim.formula is not None:
            return self._formula(pointer, path, reference, claim)
        try:
            value = _converted(claim, reference)
        except InvalidParameter as fault:
            return self._shown(pointer, Judgement("wrong-unit"), reference, (), f"The unit must {fault.rule}.")
        if value is None and claim.value is not None:
            return self._shown(pointer, Judgement("missing-unit"), reference, ())
        comparison = self._comparisons.get(pointer, self._comparison)
        try:
            judgement = compare(reference, value, comparison)
        except InvalidParameter as fault:
            raise Unreadable(f"must {fault.rule}", "value", *fault.path) from None
        mistakes: tuple[Mistake, ...] = ()
        if judgement.verdict == "incorrect" and value is not None and reference.form != "none":
            mistakes = self._wrong_values(path, reference, claim.times).matching(value, comparison)
        samples = None
        if judgement.verdict == "incorrect" and claim.times is not None and path == ("angular_velocity",):
            samples = self._samples_judged(claim.times, value, reference, judgement, identify=not mistakes)
        return self._shown(pointer, judgement, reference, mistakes, samples=samples)

    def _formula(self, pointer: str, path: Path, reference: Reference, claim: Claim) -> Result:
        if reference.form not in ("number", "angle"):
            raise Unreadable("must be left out: the figure is no number", "formula")
        try:
            formula = Formula.read(claim.formula or "", self._parameters)
        except InvalidParameter as fault:
            raise Unreadable(f"must {fault.rule}", "formula", remedy=fault.remedy) from None
        if path not in self._variations:
            self._variations[path] = self._asked.variations(path, self._parameters)
        judged = judge_formula(formula, self._variations[path], self._units, reference)
        mistakes: tuple[Mistake, ...] = ()
        if judged.value is not None and judged.judgement.verdict == "incorrect":
            mistakes = self._wrong_values(path, reference, None).matching(judged.value, FORMULA)
        return self._shown(
            pointer, judged.judgement, reference, mistakes, "" if mistakes or not self._reveal else judged.why
        )

    @cached_property
    def _parameters(self) -> Mapping[str, tuple[Path, float, str]]:
        return self._asked.parameters(self._names)

    @cached_property
    def _units(self) -> Mapping[str, str]:
        return {name: unit for name, (_, _, unit) in self._parameters.items()}

    def _reference(self, pointer: str, claim: Claim) -> tuple[Path, Reference]:
        if claim.times is not None:
            path = _path(pointer)
            key = pointer, claim.times.tobytes()
            if key not in self._samples:
                self._samples[key] = self._column(path, claim.times)
            return path, self._samples[key]
        if pointer not in self._references:
            path = _path(pointer)
            reference = self._asked.reference(path)
            if reference is None:
                raise Unreadable("must lead to a figure of the answer: a number, an array, a string, true or false")
            self._references[pointer] = path, reference
        return self._references[pointer]

    def _column(self, path: Path, times: Floats) -> Reference:
        try:
            column = self._asked.samples(path, times)
        except (MechanicsError, Refusal) as refused:
            problem = refused.problem if isinstance(refused, Refusal) else problem_of(refused)
            # When a motion begins or ends may be what is to be found.
            why = f": {problem.detail}" if self._reveal else ""
            raise Unreadable(f"must be times that can be answered{why}", "times") from None
        if column is None:
            raise Unreadable("must be left out, or be times of the motion: there are no such samples", "times")
        return column

    def _samples_judged(
        self, times: Floats, rows: Floats, reference: Reference, judgement: Judgement, *, identify: bool
    ) -> Result | None:
        system = self._asked.rotation() if self._reveal else None
        if system is None:
            return None
        errors = errors_of_samples(system, times, rows, reference.value, judgement.tolerance or 0.0)
        self.looked_for += identify
        identify = identify and self.looked_for <= MOST_IDENTIFIED
        found = consistent_method(system, times, rows, reference.value) if identify else None
        return fields_of(errors) | {"consistent_with": found}

    def _wrong_values(self, path: Path, reference: Reference, times: Floats | None) -> WrongValues:
        key = id(reference)
        if key not in self._wrong:
            subject = self._asked.path.removeprefix("/v1/")
            # The figure of samples is a column at the times of the claim.
            request = self._asked.request | ({} if times is None else {"times": times.tolist()})
            figure = Figure(subject, request, path, reference, self._asked.evaluate)
            self._wrong[key] = WrongValues(figure, self._catalogue)
        return self._wrong[key]

    def _shown(
        self,
        pointer: str,
        judgement: Judgement,
        reference: Reference,
        mistakes: Sequence[Mistake],
        why: str = "",
        samples: Result | None = None,
    ) -> Result:
        matches: list[dict[str, Any]] = [
            {"tag": one.tag, "credit": self._credits.get(one.tag, one.credit), "feedback": one.feedback}
            for one in mistakes
        ]
        correct = judgement.correct
        score = None if correct is None else 1.0 if correct else max((one["credit"] for one in matches), default=0.0)
        found = None if samples is None else samples["consistent_with"]
        if found is not None and found.step is None:
            why = "The samples are right to the digits that they have, which are fewer than the tolerance needs."
        elif found is not None:
            why = f"The samples are those of {found.method} with a step of {found.step:.6g} s."
        feedback = why or " ".join(one.feedback for one in mistakes) or FEEDBACK[judgement.verdict]
        if reference.sensitive is not None and judgement.verdict != "correct":
            feedback += f" Compare {reference.sensitive}: the figure itself is so near a constant that it shows little."
        result: Result = {
            "pointer": pointer,
            "verdict": judgement.verdict,
            "correct": correct,
            "score": score,
            "matches": matches,
            "feedback": feedback,
        }
        if self._reveal:
            result["error"] = {
                "absolute": judgement.absolute,
                "relative": judgement.relative,
                "in_tolerances": judgement.in_tolerances,
                "tolerance": judgement.tolerance,
                "sensitive": judgement.sensitive_error,
                "unit": reference.unit,
            }
        if samples is not None:
            result["samples"] = samples
        return result


def _path(pointer: str) -> Path:
    try:
        return steps_of(pointer)
    except InvalidParameter as fault:
        raise Unreadable(f"must {fault.rule}", remedy=fault.remedy) from None


def _converted(claim: Claim, reference: Reference) -> Any:
    """Return a claim's value in the unit of the reference, None where the unit is missing."""
    value = claim.value
    if reference.form in ("choice", "none") or not isinstance(value, (float, np.ndarray)):
        return value
    if claim.unit is None:
        return value if reference.unit in UNITLESS else None
    times = factor(claim.unit, reference.unit)
    if times == 1.0:
        return value
    with np.errstate(over="ignore"):
        found = value * times
    if not np.isfinite(found).all():
        raise Unreadable("must be within the range of doubles in SI units", "value")
    return found


def _result(tests: list[Result], faults: list[Fault]) -> Result:
    gradable = not faults and all(test["correct"] is not None for test in tests)
    matches = list(dict.fromkeys(match["tag"] for test in tests for match in test["matches"]))
    return {
        "score": sum(test["score"] for test in tests) / len(tests) if gradable else None,
        "correct": all(test["correct"] for test in tests) if gradable else None,
        "gradable": gradable,
        "format_errors": [fault.document() for fault in faults],
        "tests": tests,
        "matches": matches,
        "feedback": " ".join(dict.fromkeys(test["feedback"] for test in tests)) or FEEDBACK["unreadable"],
    }
