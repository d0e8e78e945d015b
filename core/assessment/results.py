"""Results of grading as documents: the same from the service and from an answer key."""

from __future__ import annotations

from typing import Any

from core.assessment.compare import Reference
from core.assessment.feedback.languages import Sentence
from core.assessment.grader import Grader
from core.assessment.judged_claims import JudgedClaim, JudgedSubmission, text
from core.assessment.terms import Terms
from core.errors import InvalidParameter, Path, pointer_of

Result = dict[str, Any]


def submission_view(index: int, judged: JudgedSubmission, terms: Terms) -> Result:
    """Return the result of a submission, `SubmissionResult`."""
    claims = judged.claims
    gradable = not judged.faults and all(one.judgement.correct is not None for one in claims)
    return {
        "score": sum(one.score or 0.0 for one in claims) / len(claims) if gradable else None,
        "correct": all(one.judgement.correct for one in claims) if gradable else None,
        "gradable": gradable,
        "format_errors": [_fault_view(fault, ("submissions", index)) for fault in judged.faults],
        "tests": [_claim_view(one, terms) for one in claims],
        "matches": list(dict.fromkeys(mistake.tag for one in claims for mistake in one.mistakes)),
        "feedback": judged.feedback(terms.language),
    }


def _fault_view(fault: InvalidParameter, within: Path) -> Result:
    entry = {"pointer": pointer_of((*within, *fault.path)), "detail": f"must {fault.rule}"}
    return entry | {"remedy": fault.remedy} if fault.remedy else entry


def _claim_view(judged: JudgedClaim, terms: Terms) -> Result:
    judgement = judged.judgement
    result: Result = {
        "pointer": judged.pointer,
        "verdict": judgement.verdict,
        "correct": judgement.correct,
        "score": judged.score,
        "matches": [
            {"tag": one.tag, "credit": one.credit, "feedback": Sentence(one.tag).text(terms.language)}
            for one in judged.mistakes
        ],
        "feedback": text(judged.sentences, terms.language),
    }
    if terms.reveal:
        result["error"] = {
            "absolute": judgement.absolute,
            "relative": judgement.relative,
            "in_tolerances": judgement.in_tolerances,
            "tolerance": judgement.tolerance,
            "sensitive": judgement.sensitive_error,
            "unit": judged.reference.unit,
        }
    if judged.samples is not None:
        errors, method = judged.samples
        result["samples"] = vars(errors) | {"consistent_with": method}
    return result


def reference_views(grader: Grader) -> list[Result]:
    """Return the references that were needed, in the order in which they were, each a `ReferenceFigure`."""
    return [reference_view(pointer, reference) for pointer, reference in grader.references.items()]


def reference_view(pointer: str, reference: Reference) -> Result:
    """Return a reference as a `ReferenceFigure`."""
    shown = ("value", "unit", "form", "error", "how", "inherited", "body_axis", "sensitive")
    return {"pointer": pointer} | {name: getattr(reference, name) for name in shown}
