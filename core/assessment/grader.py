"""From submissions to verdicts: each claim is read, converted, compared, and its mistakes are recognised."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from core.arrays import Floats
from core.assessment.claims import MOST_CLAIMS, Claim
from core.assessment.compare import Judgement, Reference, compare, exchanged
from core.assessment.comparisons import Comparison
from core.assessment.figures import DESCRIBED, steps_of
from core.assessment.formula_variations import Variation
from core.assessment.formulas import Undefined, value_in_doubles
from core.assessment.gradable import Question
from core.assessment.judged_claims import FEEDBACK, JudgedClaim, JudgedSubmission, explained
from core.assessment.judged_formulas import (
    AT_ONE_PLACE,
    FORMULA,
    NOT_JUDGED,
    UNDEFINED,
    JudgedFormula,
    Varied,
    judge_formula,
)
from core.assessment.mistakes import Figure, Mistake, WrongValues
from core.assessment.sample_findings import Consistent, SampleErrors
from core.assessment.typed_entry import Locale
from core.assessment.units import factor
from core.errors import InvalidParameter, MechanicsError, Path, pointer_of
from core.formulas import Formula
from core.work import spend

if TYPE_CHECKING:
    from core.assessment.method_search import MethodSearch
    from core.assessment.samples import ExactSamples

CLAIM = 4
"""Work (`core.work`) of judging a claim."""

MOST_IDENTIFIED = 100
"""Samples in one request of which the method is looked for: that takes some 10 ms for each."""

MOST_SOLVED = 3
"""Sets of times in one request at which solvers that choose their steps are looked for: up to a second for each."""

LONGEST_POINTER = 200

MOST_NAMED = 10
"""Figures of an object that are named where a pointer stops at it."""

UNITLESS = ("1", "rad")
"""Units that may be left out."""


class Grader:
    """Grades submissions to one question.

    Parameters
    ----------
    question : Question
    comparison : Comparison or None
        Of every figure that has none of its own.
    comparisons : mapping of str to Comparison
        By pointer.
    reveal : bool
        Whether results may say anything from which the reference could be found.
    catalogue : sequence of Mistake
    names : mapping of str to path, or None
        Of the numbers of the request, in formulas.
    locale : {"de", "en", "es", "fr"}, optional
        Of who typed the texts of submissions.

    Attributes
    ----------
    references : dict of str to Reference
        By pointer, those that were needed, but for samples at times of their own.
    looked_for : int
        Samples whose method was to be looked for.
    formulas_left : list of str
        Pointers to figures of which a formula was not judged, because too few variations of the question say anything.
    """

    def __init__(
        self,
        question: Question,
        comparison: Comparison | None,
        comparisons: Mapping[str, Comparison],
        reveal: bool,
        catalogue: Sequence[Mistake],
        names: Mapping[str, Path] | None,
        locale: Locale | None = None,
    ) -> None:
        self._question, self._comparison, self._comparisons = question, comparison, comparisons
        self._reveal, self._names, self._locale = reveal, names, locale
        # Who knows how a value is wrong can often compute the right one from it.
        self._catalogue = tuple(catalogue) if reveal else ()
        self.references: dict[str, Reference] = {}
        self._samples: dict[tuple[str, bytes], Reference] = {}
        self._columns: dict[int, tuple[ExactSamples, MethodSearch]] = {}
        self._wrong: dict[int, WrongValues] = {}
        self._variations: dict[tuple[Path, tuple[str, ...]], Sequence[Varied]] = {}
        self.looked_for = 0
        self.formulas_left: list[str] = []

    def judged(self, submission: Any) -> JudgedSubmission:
        """Return what becomes of a submission; nothing that it holds is refused with an error."""
        if not isinstance(submission, dict) or not 0 < len(submission) <= MOST_CLAIMS:
            remedy = 'such as {"/period": {"value": 6.28, "unit": "s"}}'
            rule = f"be an object of 1 to {MOST_CLAIMS} claims by JSON pointer"
            return JudgedSubmission([], [InvalidParameter((), rule, remedy=remedy)])
        claims, faults = [], []
        for pointer, entry in submission.items():
            spend(CLAIM)
            try:
                claims.append(self._claim(pointer, Claim.read(entry, self._locale)))
            except InvalidParameter as fault:
                faults.append(fault.inside(pointer) if len(pointer) <= LONGEST_POINTER else fault)
        return JudgedSubmission(claims, faults)

    def _claim(self, pointer: str, claim: Claim) -> JudgedClaim:
        path = steps_of(pointer)
        reference = self._reference(pointer, path, claim.times)
        # A word that was typed may be either.
        if claim.formula is not None and not (claim.value is not None and reference.form == "choice"):
            formula = self._read(claim, claim.formula, reference)
            # Without a name, and with the unit that the figure needs, it is a number.
            if formula.names or (claim.unit is None and reference.unit not in UNITLESS):
                return self._formula(pointer, path, reference, claim, formula)
            try:
                claim = replace(claim, value=value_in_doubles(formula, {}))
            except Undefined:
                return self._result(pointer, Judgement("incorrect"), reference, why=UNDEFINED)
        try:
            value = _converted(claim, reference)
        except InvalidParameter as fault:
            if fault.path == ("value",):
                raise
            return self._result(pointer, Judgement("wrong-unit"), reference, why=f"The unit must {fault.rule}.")
        if value is None and claim.value is not None:
            return self._result(pointer, Judgement("missing-unit"), reference)
        comparison = self._comparisons.get(pointer, self._comparison)
        try:
            judgement = compare(reference, value, comparison)
        except InvalidParameter as fault:
            raise fault.inside("value") from None
        if judgement.verdict != "incorrect" or value is None or reference.form == "none":
            return self._result(pointer, judgement, reference)
        mistakes = self._wrong_values(path, reference, claim.times).matching(value, comparison)
        if claim.times is None or path != ("angular_velocity",):
            return self._result(pointer, judgement, reference, mistakes)
        samples = self._samples_judged(claim.times, value, reference, judgement, identify=not mistakes)
        why = [explained(mistakes)] if mistakes else []
        if any(one.tag == "permuted-axes" for one in mistakes):
            why.append(exchanged(value, reference.value))
        if samples is not None and not mistakes:
            errors, found = samples
            why = [errors.sentence] if errors.sentence else []
            why += [] if found is None else [found.sentence]
        return self._result(pointer, judgement, reference, mistakes, " ".join(why), samples)

    def _read(self, claim: Claim, text: str, reference: Reference) -> Formula:
        """Return the formula of a claim."""
        if reference.form not in ("number", "angle", "none"):
            raise InvalidParameter(claim.field, "be left out: the figure is no number")
        try:
            return Formula.read(text, self._parameters)
        except InvalidParameter as fault:
            raise fault.inside(claim.field) from None

    def _formula(self, pointer: str, path: Path, reference: Reference, claim: Claim, formula: Formula) -> JudgedClaim:
        if reference.form == "none":
            return self._result(pointer, Judgement("incorrect"), reference)
        try:
            # Names stand for numbers in SI units, and without a unit so does the value.
            times = 1.0 if claim.unit is None else factor(claim.unit, reference.unit)
        except InvalidParameter as fault:
            return self._result(pointer, Judgement("wrong-unit"), reference, why=f"The unit must {fault.rule}.")
        judged = self._agreeing(formula, path, reference, times)
        mistakes: tuple[Mistake, ...] = ()
        if judged.value is not None and judged.judgement.verdict == "incorrect":
            mistakes = self._wrong_values(path, reference, None).matching(judged.value, FORMULA)
        said = not mistakes and (self._reveal or judged.why == NOT_JUDGED)
        return self._result(pointer, judged.judgement, reference, mistakes, judged.why if said else "")

    def _agreeing(self, formula: Formula, path: Path, reference: Reference, times: float) -> JudgedFormula:
        """Judge a formula at variations of the named numbers, or of those that may vary without `names`.

        The numbers of a described scene are mostly coordinates. Changed one by one they make another arrangement, with
        strings that are vertical no more: without `names`, masses vary, and what else the formula has.
        """
        if self._names is not None or self._question.subject != DESCRIBED:
            found = self._judged(formula, path, reference, times, self._parameters)
        else:
            masses = {name: one for name, one in self._parameters.items() if one[0][-1] == "mass"}
            own = {name: self._parameters[name] for name in sorted(formula.names)}
            found = self._judged(formula, path, reference, times, masses | own)
            alone = found.why == AT_ONE_PLACE and self._judged(formula, path, reference, times, masses)
            if alone and alone.judgement.correct:
                # Either the lengths in it are wrong, or the scene with others is another one.
                found = JudgedFormula(Judgement("not-gradable"), NOT_JUDGED)
        if found.why == NOT_JUDGED and pointer_of(path) not in self.formulas_left:
            self.formulas_left.append(pointer_of(path))
        return found

    def _judged(
        self,
        formula: Formula,
        path: Path,
        reference: Reference,
        times: float,
        varied: Mapping[str, tuple[Path, float, str]],
    ) -> JudgedFormula:
        place = path, tuple(varied)
        if place not in self._variations:
            fixed = {name: value for name, (_, value, _) in self._parameters.items() if name not in varied}
            found = self._question.variations(path, varied)
            self._variations[place] = [Variation(fixed | {**one.parameters}, one.figure) for one in found]
        return judge_formula(formula, self._variations[place], self._units, reference, times)

    @cached_property
    def _parameters(self) -> Mapping[str, tuple[Path, float, str]]:
        return self._question.parameters(self._names)

    @cached_property
    def _units(self) -> Mapping[str, str]:
        return {name: unit for name, (_, _, unit) in self._parameters.items()}

    def _reference(self, pointer: str, path: Path, times: Floats | None) -> Reference:
        if times is not None:
            key = pointer, times.tobytes()
            if key not in self._samples:
                self._samples[key] = self._column(path, times)
            return self._samples[key]
        if pointer not in self.references:
            reference = self._question.reference(path)
            if reference is None:
                rule = "lead to a figure of the answer: a number, an array, a string, true or false"
                raise InvalidParameter((), rule, remedy=self._deeper(path))
            self.references[pointer] = reference
        return self.references[pointer]

    def _deeper(self, path: Path) -> str | None:
        """Return the remedy of a pointer that stops at an object: the figure that stands in it, or those that do."""
        names = self._question.figures_in(path)
        names = ["value"] if "value" in names else names[:MOST_NAMED]
        pointers = [pointer_of((*path, name)) for name in names]
        return f"an object stands there; name its figure: {' or '.join(pointers)}" if pointers else None

    def _column(self, path: Path, times: Floats) -> Reference:
        try:
            column = self._question.samples(path, times)
        except MechanicsError as refused:
            # When a motion begins or ends may be what is to be found.
            why = f": {refused.detail}" if self._reveal else ""
            raise InvalidParameter("times", f"be times that can be answered{why}") from None
        if column is None:
            raise InvalidParameter("times", "be left out, or be times of the motion: there are no such samples")
        return column

    def _samples_judged(
        self, times: Floats, rows: Floats, reference: Reference, judgement: Judgement, *, identify: bool
    ) -> tuple[SampleErrors, Consistent | None] | None:
        system = self._question.rotation() if self._reveal else None
        if system is None:
            return None
        # Not at the top: with an answer key, nothing is imported that has to be compiled.
        from core.assessment.method_search import MethodSearch
        from core.assessment.samples import ExactSamples

        if id(reference) not in self._columns:
            column = (system, times, reference.value)
            search = MethodSearch(*column, solvers=len(self._columns) < MOST_SOLVED)
            self._columns[id(reference)] = ExactSamples(*column), search
        exact, search = self._columns[id(reference)]
        self.looked_for += identify
        looked = identify and self.looked_for <= MOST_IDENTIFIED
        return exact.errors(rows, judgement.tolerance or 0.0), search.consistent(rows) if looked else None

    def _wrong_values(self, path: Path, reference: Reference, times: Floats | None) -> WrongValues:
        key = id(reference)
        if key not in self._wrong:
            # The figure of samples is a column at the times of the claim.
            request = self._question.request | ({} if times is None else {"times": times.tolist()})
            figure = Figure(self._question.subject, request, path, reference, self._question.evaluate)
            self._wrong[key] = WrongValues(figure, self._catalogue)
        return self._wrong[key]

    def _result(
        self,
        pointer: str,
        judgement: Judgement,
        reference: Reference,
        mistakes: tuple[Mistake, ...] = (),
        why: str = "",
        samples: tuple[SampleErrors, Consistent | None] | None = None,
    ) -> JudgedClaim:
        feedback = why or explained(mistakes) or FEEDBACK[judgement.verdict]
        if reference.sensitive is not None and judgement.verdict != "correct":
            feedback += f" Compare {reference.sensitive}: the figure itself is so near a constant that it shows little."
        return JudgedClaim(pointer, judgement, reference, mistakes, feedback, samples)


def credited(catalogue: Sequence[Mistake], credits: Mapping[str, float]) -> tuple[Mistake, ...]:
    """Return the catalogue with other credits for some tags."""
    return tuple(replace(entry, credit=credits.get(entry.tag, entry.credit)) for entry in catalogue)


def _converted(claim: Claim, reference: Reference) -> Any:
    """Return a claim's value in the unit of the reference, None where the unit is missing."""
    value = claim.value
    if reference.form == "choice" or not isinstance(value, (float, np.ndarray)):
        return value
    if claim.unit is None:
        return value if reference.unit in UNITLESS else None
    times = factor(claim.unit, reference.unit)
    if times == 1.0:
        return value
    with np.errstate(over="ignore"):
        found = value * times
    if not np.isfinite(found).all():
        raise InvalidParameter("value", "be within the range of doubles in SI units")
    return found
