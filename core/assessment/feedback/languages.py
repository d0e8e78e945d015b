"""Sentences of feedback by key, written in the language of a course.

A catalogue has a text for every key; the key of a recognised mistake is its tag. A text has the values that complete it
in braces, with their format: ``{step:.3g}``. Numbers are written with the decimal mark of the language.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from core.assessment.feedback.english import ENGLISH
from core.assessment.feedback.french import FRENCH
from core.assessment.feedback.german import GERMAN
from core.assessment.feedback.spanish import SPANISH

Language = Literal["de", "en", "es", "fr"]
LANGUAGES: tuple[Language, ...] = get_args(Language)

CATALOGUES: Mapping[Language, Mapping[str, str]] = {"de": GERMAN, "en": ENGLISH, "es": SPANISH, "fr": FRENCH}


@dataclass(frozen=True)
class Sentence:
    """A text of the catalogues, and the values that complete it.

    Attributes
    ----------
    key : str
    values : mapping of str to (float or str)
    place : int, optional
        In a numbered list, from 1.
    """

    key: str
    values: Mapping[str, float | str] = field(default_factory=dict)
    place: int | None = None

    def text(self, language: Language) -> str:
        """Return the sentence in a language."""
        values = {
            name: _Number(value, "." if language == "en" else ",") if isinstance(value, float) else value
            for name, value in self.values.items()
        }
        text = CATALOGUES[language][self.key].format_map(values)
        return text if self.place is None else f"({self.place}) {text}"


class _Number:
    """A number that is written with the decimal mark of a language."""

    def __init__(self, value: float, mark: str) -> None:
        self._value, self._mark = value, mark

    def __format__(self, form: str) -> str:
        return format(self._value, form).replace(".", self._mark)
