"""How submissions to a question are graded: what a course decides, beside the question itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.assessment.carried import CarriedStep
from core.assessment.comparisons import Comparison
from core.assessment.feedback.languages import Language
from core.assessment.typed_number import Locale
from core.errors import Path


@dataclass(frozen=True)
class Terms:
    """How submissions to a question are graded.

    Attributes
    ----------
    comparison : Comparison or None
        Of every figure without one of its own.
    comparisons : mapping of str to Comparison
        By pointer.
    reveal : bool
        Whether results may say anything from which the reference could be found.
    names : mapping of str to path, or None
        Of the numbers of the request, in formulas.
    locale : {"de", "en", "es", "fr"}, optional
        Of who typed the texts of submissions.
    language : {"de", "en", "es", "fr"}
        Of the feedback.
    steps : mapping of str to CarriedStep
        How a figure follows from others of the same submission, by pointer.
    """

    comparison: Comparison | None = None
    comparisons: Mapping[str, Comparison] = field(default_factory=dict)
    reveal: bool = True
    names: Mapping[str, Path] | None = None
    locale: Locale | None = None
    language: Language = "en"
    steps: Mapping[str, CarriedStep] = field(default_factory=dict)
