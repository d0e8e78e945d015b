"""The pieces of a page: prose and fenced code, in order."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

FENCE = re.compile(r"^```([a-z-]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
ENDPOINT = re.compile(r"`POST (/v1/[a-z/-]+)`")


@dataclass(frozen=True)
class Block:
    """Fenced code, and the prose before it.

    Attributes
    ----------
    language, code : str
    prose : str
        From the block before.
    """

    language: str
    code: str
    prose: str

    @property
    def endpoint(self) -> str | None:
        """Path of the endpoint that the prose named last, if any."""
        named = ENDPOINT.findall(self.prose)
        return named[-1] if named else None


def blocks(text: str) -> Iterator[Block]:
    """Yield the fenced code of a page."""
    end = 0
    for match in FENCE.finditer(text):
        yield Block(match[1], match[2], text[end : match.start()])
        end = match.end()
    if "\n```" in text[end:]:
        raise ValueError("a fence is not closed")
