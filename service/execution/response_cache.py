"""Small answers that are kept for questions asked again, within bounds on their number and on their memory."""

from __future__ import annotations

from collections import OrderedDict
from zlib import crc32

from service.http.etag import Representation

SMALL = 8_192
"""Most bytes of a question and its answer together that are kept: small questions are those asked again."""

DOOR = 65_536
"""Places of the questions that have been asked once; after a quarter as many questions all are free again."""

OVERHEAD = 1_000
"""Bytes of memory that an entry takes beside question and answer: its headers, its objects and its place."""


class ResponseCache:
    """The answers given last, by path and body, which with the version determine an answer to the bit.

    An answer is kept when its question is asked for the second time: most are asked once, and would drive out those
    which are asked again. All are JSON: an answer that was negotiated otherwise is neither kept nor looked for here.

    Parameters
    ----------
    most : int
        Number of answers; 0 keeps none.
    most_bytes : int
        Memory that all of them may take.
    """

    def __init__(self, most: int, most_bytes: int) -> None:
        self._most, self._most_bytes = most, most_bytes
        self._kept: OrderedDict[tuple[str, bytes], Representation] = OrderedDict()
        self._door, self._admitted = bytearray(DOOR), 0
        self.bytes = 0

    def __len__(self) -> int:
        return len(self._kept)

    def get(self, path: str, body: bytes) -> Representation | None:
        """Return the answer to a question if it is kept, and keep it longer for that."""
        key = path, body
        found = self._kept.get(key)
        if found is not None:
            self._kept.move_to_end(key)
        return found

    def put(self, path: str, body: bytes, answer: Representation) -> None:
        """Keep an answer if it is small and its question not new, and drop those asked for longest ago for its room."""
        size = len(body) + len(answer.text)
        if not self._most or size > SMALL:
            return
        key = path, body
        if self._is_new(body):
            return
        if key not in self._kept:
            # Otherwise the same question has been answered twice at a time, to the same bytes.
            self.bytes += size + OVERHEAD
        self._kept[key] = answer
        while len(self._kept) > self._most or self.bytes > self._most_bytes:
            (_, gone), dropped = self._kept.popitem(last=False)
            self.bytes -= len(gone) + len(dropped.text) + OVERHEAD

    def _is_new(self, body: bytes) -> bool:
        """Return whether a question has not been asked lately; seldom one that has not is taken for one that has."""
        place = crc32(body) % DOOR
        if self._door[place]:
            return False
        self._door[place] = 1
        self._admitted += 1
        if self._admitted > DOOR // 4:
            self._door, self._admitted = bytearray(DOOR), 0
        return True
