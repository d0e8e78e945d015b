"""What is wrong with an entry, for the client in English and for who typed it in the language of the course."""

from __future__ import annotations

from collections.abc import Iterable

from core.assessment.feedback.languages import Sentence
from core.errors import InvalidParameter, Path

UNREADABLE = Sentence("unreadable")


class EntryFault(InvalidParameter):
    """An entry cannot be read, or its unit cannot be used.

    Parameters
    ----------
    sentence : Sentence
        For who typed it.
    path, rule, remedy, further
        As of `InvalidParameter`.
    """

    def __init__(
        self,
        path: str | Path,
        rule: str,
        *,
        remedy: str | None = None,
        further: Iterable[InvalidParameter] = (),
        sentence: Sentence = UNREADABLE,
    ) -> None:
        super().__init__(path, rule, remedy=remedy, further=further)
        self.sentence = sentence

    def inside(self, *outer: str | int) -> EntryFault:
        """Return the same error with the path from an enclosing object."""
        return EntryFault((*outer, *self.path), self.rule, remedy=self.remedy, sentence=self.sentence)
