"""What becomes of claims and submissions, and what is said about it to who made them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from core.assessment.compare import Judgement, Reference
from core.assessment.mistakes import Mistake
from core.assessment.sample_findings import Consistent, SampleErrors
from core.errors import InvalidParameter

FEEDBACK: Mapping[str, str] = {
    "correct": "Correct.",
    "incorrect": "Not correct.",
    "missing-unit": "The unit is missing.",
    "wrong-unit": "The unit does not measure this quantity.",
    "not-gradable": "This cannot be judged: the tolerance is finer than the reference is known.",
    "unreadable": "This cannot be read.",
}


@dataclass(frozen=True, eq=False)
class JudgedClaim:
    """What becomes of one claim.

    Attributes
    ----------
    pointer : str
        Of the figure in the answer.
    judgement : Judgement
    reference : Reference
    mistakes : tuple of Mistake
        By which the value comes out.
    feedback : str
        For who submitted it.
    samples : tuple of (SampleErrors, Consistent or None), or None
        Of samples of the angular velocity that are not right.
    """

    pointer: str
    judgement: Judgement
    reference: Reference
    mistakes: tuple[Mistake, ...]
    feedback: str
    samples: tuple[SampleErrors, Consistent | None] | None

    @property
    def score(self) -> float | None:
        """Share from 0 to 1, None if the claim cannot be judged."""
        correct = self.judgement.correct
        if correct is None:
            return None
        return 1.0 if correct else max((one.credit for one in self.mistakes), default=0.0)


@dataclass(frozen=True, eq=False)
class JudgedSubmission:
    """What becomes of one submission.

    Attributes
    ----------
    claims : list of JudgedClaim
        That can be read.
    faults : list of InvalidParameter
        What cannot be read, with paths from the submission.
    """

    claims: list[JudgedClaim]
    faults: list[InvalidParameter]


def explained(mistakes: Sequence[Mistake]) -> str:
    """Return the feedback of the mistakes by which one value comes out: of several, a numbered list of what may be."""
    if len(mistakes) < 2:
        return "".join(one.feedback for one in mistakes)
    entries = " ".join(f"({k}) {one.feedback}" for k, one in enumerate(mistakes, 1))
    return f"Several mistakes give this value, each by itself. {entries}"
