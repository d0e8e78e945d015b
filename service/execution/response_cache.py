"""A cache of small answers to questions that are sent repeatedly."""

from __future__ import annotations

from cachetools import LRUCache

from service.http.etag import Representation

LARGEST = 8_192
"""Bytes of a question and its answer together that are cached, at most; so the number bounds the memory."""

REMEMBERED = 16_384
"""Largest number of questions of which is remembered that they came once."""


class ResponseCache:
    """The answers used last, by path and body, which with the version determine an answer to the bit.

    An answer is cached when its question arrives for the second time: most questions come once, and would drive out
    those that are repeated. All answers are JSON; other representations are not cached.

    Parameters
    ----------
    most : int
        Number of answers; 0 caches none.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._answers: LRUCache[tuple[str, bytes], Representation] = LRUCache(most)
        self._seen: set[int] = set()

    def __len__(self) -> int:
        return len(self._answers)

    def get(self, path: str, body: bytes) -> Representation | None:
        """Return the answer to a question if it is cached."""
        return self._answers.get((path, body)) if self._answers else None

    def put(self, path: str, body: bytes, answer: Representation) -> None:
        """Cache an answer if it is small and its question has come before."""
        if not self._most or len(body) + len(answer.body) > LARGEST:
            return
        question = hash((path, body))
        if question in self._seen:
            self._answers[path, body] = answer
            return
        if len(self._seen) >= REMEMBERED:
            self._seen.clear()
        self._seen.add(question)
