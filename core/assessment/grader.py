"""From submissions to verdicts: each claim is read, converted, compared, and its mistakes are recognised."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from core.arrays import Floats
from core.assessment.carried import follows
from core.assessment.claims import MOST_CLAIMS, Claim
from core.assessment.compare import Judgement, Reference, compare, exchanged
from core.assessment.comparisons import Comparison
from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence
from core.assessment.figures import DESCRIBED, steps_of
from core.assessment.formula_variations import Variation
from core.assessment.formulas import Undefined, value_in_doubles
from core.assessment.gradable import Question
from core.assessment.judged_claims import (
    MOST_NAMED,
    JudgedClaim,
    JudgedSubmission,
    explained,
    unknown_name,
    wanted_form,
)
from core.assessment.judged_formulas import (
    FORMULA,
    NOT_JUDGED,
    UNDEFINED,
    JudgedFormula,
    Varied,
    judge_formula,
)
from core.assessment.mistakes import Figure, Mistake, WrongValues
from core.assessment.sample_findings import Consistent, SampleErrors
from core.assessment.terms import Terms
from core.assessment.units import factor
from core.errors import InvalidParameter, MechanicsError, Path, pointer_of
from core.formulas import Formula, UnknownName
from core.near_names import did_you_mean
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

UNITLESS = ("1", "rad")
"""Units that may be left out."""


class Grader:
    """Grades submissions to one question.

    Parameters
    ----------
    question : Question
    terms : Terms
    catalogue : sequence of Mistake

    Attributes
    ----------
    references : dict of str to Reference
        By pointer, those that were needed, but for samples at times of their own.
    looked_for : int
        Samples whose method was to be looked for.
    formulas_left : list of str
        Pointers to figures of which a formula was not judged, because too few variations of the question say anything.
    """

    def __init__(self, question: Question, terms: Terms, catalogue: Sequence[Mistake]) -> None:
        self._question, self.terms = question, terms
        self._reveal, self._names = terms.reveal, terms.names
        # Who knows how a value is wrong can often compute the right one from it.
        self._catalogue = tuple(catalogue) if terms.reveal else ()
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
                claims.append(self._claim(pointer, Claim.read(entry, self.terms.locale)))
            except InvalidParameter as fault:
                faults.append(fault.inside(pointer) if len(pointer) <= LONGEST_POINTER else fault)
        return JudgedSubmission(self._with_carried(claims), faults)

    def _with_carried(self, claims: list[JudgedClaim]) -> list[JudgedClaim]:
        """Return claims, those that follow from wrong earlier ones marked as such."""
        values = {one.pointer: one.value for one in claims if one.value is not None}
        wrong = {one.pointer for one in claims if not one.judgement.correct}
        found = []
        for one in claims:
            step = self.terms.steps.get(one.pointer)
            if step is not None and one.judgement.verdict == "incorrect" and one.value is not None:
                sources = {*step.earlier.values()}
                if sources <= values.keys() and sources & wrong:
                    parameters = {name: value for name, (_, value, _) in self._parameters.items()}
                    comparison = self._comparison(one.pointer)
                    if follows(step, one.value, one.reference, comparison, parameters, values):
                        judgement = replace(one.judgement, verdict="carried")
                        sentences = (Sentence("carried"),)
                        one = replace(one, judgement=judgement, mistakes=(), sentences=sentences, carried=step.credit)
            found.append(one)
        return found

    def _comparison(self, pointer: str) -> Comparison | None:
        return self.terms.comparisons.get(pointer, self.terms.comparison)

    def _claim(self, pointer: str, claim: Claim) -> JudgedClaim:
        path = steps_of(pointer)
        reference = self._reference(pointer, path, claim.times)
        if type(reference.value) is bool:
            claim = claim.as_truth(path)
        # A word that was typed may be either.
        if claim.formula is not None:
            claim = claim.as_quantity(reference.unit, self._parameters)
        if claim.formula is not None and not (claim.value is not None and reference.form == "choice"):
            formula = self._read(claim, claim.formula, reference)
            # Without a name, and with the unit that the figure needs, it is a number.
            if formula.names or (claim.unit is None and reference.unit not in UNITLESS):
                return self._formula(pointer, path, reference, claim, formula)
            try:
                claim = replace(claim, value=value_in_doubles(formula, {}))
            except Undefined:
                return self._result(pointer, Judgement("incorrect"), reference, why=[Sentence(UNDEFINED)])
        try:
            value = _converted(claim, reference)
        except EntryFault as fault:
            return self._result(pointer, Judgement("wrong-unit"), reference, why=[fault.sentence])
        if value is None and claim.value is not None:
            return self._result(pointer, Judgement("missing-unit"), reference, value=claim.value)
        comparison = self._comparison(pointer)
        try:
            judgement = compare(reference, value, comparison)
        except InvalidParameter as fault:
            sentence = wanted_form(reference)
            raise EntryFault(("value", *fault.path), fault.rule, remedy=fault.remedy, sentence=sentence) from None
        if judgement.verdict != "incorrect" or value is None or reference.form == "none":
            return self._result(pointer, judgement, reference, value=value)
        mistakes = self._wrong_values(path, reference, claim.times).matching(value, comparison)
        if claim.times is None or path != ("angular_velocity",):
            return self._result(pointer, judgement, reference, mistakes, value=value)
        samples = self._samples_judged(claim.times, value, reference, judgement, identify=not mistakes)
        why = [*explained(mistakes)]
        if any(one.tag == "permuted-axes" for one in mistakes):
            why.append(exchanged(value, reference.value))
        if samples is not None and not mistakes:
            errors, found = samples
            why = [] if errors.sentence is None else [errors.sentence]
            why += [] if found is None else [found.sentence]
        return self._result(pointer, judgement, reference, mistakes, why, samples)

    def _read(self, claim: Claim, text: str, reference: Reference) -> Formula:
        """Return the formula of a claim."""
        if reference.form not in ("number", "angle", "none"):
            sentence = Sentence("formula-not-expected")
            raise EntryFault(claim.field, "be left out: the figure is no number", sentence=sentence)
        try:
            return Formula.read(text, self._parameters)
        except InvalidParameter as fault:
            if claim.is_phrase:
                raise EntryFault(claim.field, "be a number or a formula", sentence=wanted_form(reference)) from None
            sentence = (
                unknown_name(fault.name, self._parameters)
                if isinstance(fault, UnknownName)
                else Sentence("formula-malformed")
            )
            raise EntryFault(claim.field, fault.rule, remedy=fault.remedy, sentence=sentence) from None

    def _formula(self, pointer: str, path: Path, reference: Reference, claim: Claim, formula: Formula) -> JudgedClaim:
        bare = not formula.names and claim.unit is None
        if reference.form == "none":
            return self._result(pointer, Judgement("missing-unit" if bare else "incorrect"), reference)
        try:
            # Names stand for numbers in SI units, and without a unit so does the value.
            times = 1.0 if claim.unit is None else factor(claim.unit, reference.unit)
        except EntryFault as fault:
            return self._result(pointer, Judgement("wrong-unit"), reference, why=[fault.sentence])
        judged = self._agreeing(formula, path, reference, times)
        if bare and judged.judgement.verdict == "incorrect":
            return self._result(pointer, Judgement("missing-unit"), reference, value=judged.value)
        mistakes: tuple[Mistake, ...] = ()
        if judged.value is not None and judged.judgement.verdict == "incorrect":
            mistakes = self._wrong_values(path, reference, None).matching(judged.value, FORMULA)
        said = judged.why and not mistakes and (self._reveal or judged.why == NOT_JUDGED)
        why = [Sentence(judged.why)] if said else []
        return self._result(pointer, judged.judgement, reference, mistakes, why, value=judged.value)

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
            alone = found.at_one_place and self._judged(formula, path, reference, times, masses)
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
                remedy = self._deeper(path) or self._beside(path)
                raise EntryFault((), rule, remedy=remedy, sentence=Sentence("figure-unknown"))
            self.references[pointer] = reference
        return self.references[pointer]

    def _deeper(self, path: Path) -> str | None:
        """Return the remedy of a pointer that stops at an object: the figure that stands in it, or those that do."""
        names = self._question.figures_in(path)
        names = ["value"] if "value" in names else names[:MOST_NAMED]
        pointers = [pointer_of((*path, name)) for name in names]
        return f"an object stands there; name its figure: {' or '.join(pointers)}" if pointers else None

    def _beside(self, path: Path) -> str | None:
        """Return the figure that was probably meant by a pointer that leads nowhere: one beside it."""
        names = {pointer_of((*path[:-1], name)) for name in self._question.figures_in(path[:-1])} if path else ()
        return did_you_mean(pointer_of(path), sorted(names))

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
        why: Sequence[Sentence] = (),
        samples: tuple[SampleErrors, Consistent | None] | None = None,
        *,
        value: Any = None,
    ) -> JudgedClaim:
        sentences = (*why,) or explained(mistakes) or (Sentence(judgement.verdict),)
        if reference.sensitive is not None and judgement.verdict != "correct":
            sentences += (Sentence("sensitive", {"name": reference.sensitive}),)
        number = value if type(value) is float else None
        return JudgedClaim(pointer, judgement, reference, mistakes, sentences, samples, number)


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
