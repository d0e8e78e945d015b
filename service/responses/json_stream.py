"""From an answer to the document that is sent: text, and large arrays that are written only while it is sent."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.work import spend
from service.responses import npz as archive
from service.responses.json_rows import ONE_PIECE, array_size, parts, require_finite, rows, written
from service.routing import Answer, PostRoute

SLICE = 131_072
"""Bytes of text that are sent at a time."""

ONE_TEXT = 1_000_000
"""Bytes of text that may be sent in one piece."""

NUMBERS_PER_UNIT = 16
"""Numbers that are written in a unit of work (`core.work`)."""

Part = bytes | memoryview | np.ndarray[Any, Any]


@dataclass(frozen=True)
class Document:
    """An answer in the media type of the response.

    Attributes
    ----------
    numbers : int
        How many numbers the arrays of the answer hold.
    parts : tuple
        In the order in which they are sent: text, and finite arrays that are to be written as JSON.
    """

    numbers: int
    parts: tuple[Part, ...]

    @property
    def memory(self) -> int:
        """How many bytes its parts take."""
        return sum(part.nbytes if isinstance(part, np.ndarray) else len(part) for part in self.parts)

    @property
    def large(self) -> bool:
        """Whether it is better sent in pieces."""
        return self.numbers > ONE_PIECE or sum(map(len, self.parts)) > ONE_TEXT

    def pieces(self) -> Iterator[bytes | memoryview]:
        """Yield what is sent, in pieces of which none takes more than a moment to make; some are a single character."""
        for part in self.parts:
            if isinstance(part, np.ndarray):
                yield from rows(part)
            else:
                text = memoryview(part)
                yield from (text[start : start + SLICE] for start in range(0, len(text), SLICE))

    def whole(self) -> bytes:
        """Return all of it."""
        first = self.parts[0]
        return first if len(self.parts) == 1 and isinstance(first, bytes) else b"".join(self.pieces())


def composed(route: PostRoute, answer: Answer, media: str | None) -> Document:
    """Return the document of an answer; `media` is None for JSON.

    Raises
    ------
    NotFinite
        For NaN and infinities.
    """
    numbers = array_size(answer)
    # A drawing is made point by point.
    spend(numbers / (1 if media in route.representations else NUMBERS_PER_UNIT))
    if media is None and numbers <= ONE_PIECE:
        return Document(numbers, (written(answer),))
    require_finite(answer)
    if media is None:
        return Document(numbers, tuple(_joined(parts(answer))))
    if media == archive.MEDIA_TYPE:
        return Document(numbers, tuple(archive.archive(answer)))
    return Document(numbers, (route.representations[media](answer),))


def _joined(found: Iterator[Part]) -> Iterator[Part]:
    """Yield parts of which no two texts stand side by side."""
    texts: list[bytes | memoryview] = []
    for part in found:
        if isinstance(part, np.ndarray):
            yield b"".join(texts)
            yield part
            texts.clear()
        else:
            texts.append(part)
    yield b"".join(texts)
