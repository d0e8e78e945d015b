"""What becomes of claims and submissions, and what is said about it to who made them."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches

import numpy as np

from core.assessment.compare import Judgement, Reference
from core.assessment.feedback.entry_fault import UNREADABLE, EntryFault
from core.assessment.feedback.languages import Language, Sentence
from core.assessment.mistakes import Mistake
from core.assessment.sample_findings import Consistent, SampleErrors
from core.errors import InvalidParameter

MOST_NAMED = 10
"""Names that are listed where a name or a pointer leads nowhere."""

FROM_ZERO = re.compile(r"_0(?:_|$)")
"""In a name that counts from 0, as pointers do; names count from 1."""


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
    sentences : tuple of Sentence
        Feedback for who submitted it.
    samples : tuple of (SampleErrors, Consistent or None), or None
        Of samples of the angular velocity that are not right.
    value : float or None
        The number that is claimed, in the unit of the reference (also where the unit is missing, as a later answer may
        follow from it); None where there is none.
    carried : float or None
        Share of the score for a number that follows from wrong earlier ones.
    """

    pointer: str
    judgement: Judgement
    reference: Reference
    mistakes: tuple[Mistake, ...]
    sentences: tuple[Sentence, ...]
    samples: tuple[SampleErrors, Consistent | None] | None = None
    value: float | None = None
    carried: float | None = None

    @property
    def score(self) -> float | None:
        """Share from 0 to 1, None if the claim cannot be judged."""
        correct = self.judgement.correct
        if correct is None:
            return None
        return 1.0 if correct else max((one.credit for one in self.mistakes), default=self.carried or 0.0)


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

    def feedback(self, language: Language) -> str:
        """Return what is said of all claims, and of those that cannot be read."""
        said = [text(one.sentences, language) for one in self.claims]
        said += [
            (fault.sentence if isinstance(fault, EntryFault) else UNREADABLE).text(language) for fault in self.faults
        ]
        return " ".join(dict.fromkeys(said))


def text(sentences: Sequence[Sentence], language: Language) -> str:
    """Return sentences in a language."""
    return " ".join(one.text(language) for one in sentences)


def unknown_name(name: str, known: Collection[str]) -> Sentence:
    """Return what is said of a name that a question does not have: the nearest of those that it has."""
    near = sorted(get_close_matches(name, known, MOST_NAMED, cutoff=0.0))
    key = "name-from-zero" if FROM_ZERO.search(name) else "name-unknown"
    return Sentence(key, {"name": name, "names": ", ".join(near)})


def wanted_form(reference: Reference) -> Sentence:
    """Return in which form a figure is to be given."""
    right = reference.value
    if not isinstance(right, np.ndarray):
        return Sentence("form-word" if reference.form == "choice" else "form-number")
    if right.ndim == 1:
        return Sentence("form-list", {"count": str(len(right))})
    # A curve has as many points as who gives it likes.
    rows = "n" if reference.form == "curve" else str(len(right))
    return Sentence("form-rows", {"rows": rows, "count": str(right.shape[1])})


def explained(mistakes: Sequence[Mistake]) -> tuple[Sentence, ...]:
    """Return the feedback of the mistakes by which one value comes out: of several, a list of what may be."""
    sentences = tuple(Sentence(one.tag) for one in mistakes)
    if len(mistakes) < 2:
        return sentences
    return (Sentence("several"), *(replace(one, place=k) for k, one in enumerate(sentences, 1)))
