"""Content codings of responses: which one a client accepts, and its compressor."""

from __future__ import annotations

import asyncio
import sys
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Protocol

if sys.version_info >= (3, 14):
    from compression.zstd import ZstdCompressor
else:
    from backports.zstd import ZstdCompressor

LEAST = 1_400
"""Bytes of a body from which on it is compressed: a shorter one fits into a single packet as it is."""

IN_THREAD = 16_384
"""Bytes from which on compression takes longer (0.2 ms) than handing it to a thread."""

KEPT = 256
"""Compressed files that are kept; there are some 40 files and two codings."""

_COMPRESSED = (b"application/json", b"application/problem+json", b"image/svg+xml", b"text/")
"""Beginnings of the media types that shrink. Archives of doubles hardly do; events have to arrive one by one."""

_NEVER = b"text/event-stream"


class Compressor(Protocol):
    """Compresses a body piece by piece."""

    def compress(self, data: bytes, /) -> bytes:
        """Return what can be sent after another piece; it may be empty."""

    def flush(self) -> bytes:
        """Return the end."""


@dataclass(frozen=True)
class Coding:
    """A content coding.

    Attributes
    ----------
    name : bytes
        As HTTP registers it.
    fast : callable
        Returns a compressor for bodies that are sent once.
    small : callable
        Returns a compressor for bodies that are sent many times.
    """

    name: bytes
    fast: Callable[[], Compressor]
    small: Callable[[], Compressor]

    def tagged(self, etag: bytes) -> bytes:
        """Return the strong validator of a body in this coding, which has other bytes (RFC 9110, 8.8.3.3)."""
        return etag[:-1] + b"-" + self.name + b'"'


def _gzip(level: int) -> Compressor:
    return zlib.compressobj(level, zlib.DEFLATED, 16 + zlib.MAX_WBITS)


def zstd(level: int) -> Compressor:
    """Return a compressor with zstd of a level (RFC 8878)."""
    return ZstdCompressor(level)


# The lowest levels: higher ones take several times as long for rows of numbers, which shrink by a few percent more.
CODINGS = (
    Coding(b"zstd", partial(zstd, 1), partial(zstd, 15)),
    Coding(b"gzip", partial(_gzip, 1), partial(_gzip, 9)),
)
"""Best first: zstd compresses several times as fast."""


def coding_for(accepted: bytes | None, content_type: bytes) -> Coding | None:
    """Return the coding for a response, None for none.

    Parameters
    ----------
    accepted : bytes or None
        The request's Accept-Encoding (RFC 9110, 12.5.3).
    content_type : bytes
        Of the response.
    """
    if not accepted or not is_compressed(content_type):
        return None
    weights = dict(map(_weight, accepted.lower().split(b",")))
    others = weights.get(b"*", 0.0)
    # Of equal weights, the first is taken.
    weight, best = max(
        ((weights.get(coding.name, others), coding) for coding in CODINGS), key=lambda weighted: weighted[0]
    )
    return best if weight > 0.0 else None


def is_compressed(content_type: bytes) -> bool:
    """Return whether documents of a media type are compressed for clients that accept it."""
    return content_type.startswith(_COMPRESSED) and not content_type.startswith(_NEVER)


def _weight(entry: bytes) -> tuple[bytes, float]:
    name, _, parameter = entry.partition(b";")
    key, _, value = parameter.strip().partition(b"=")
    try:
        weight = float(value) if key.strip() == b"q" else 1.0
    except ValueError:
        weight = 0.0
    return name.strip(), weight


async def compressed(coding: Coding, body: bytes, *, kept: bool = False) -> bytes:
    """Return a body in a coding; where it is `kept`, it is made as small as possible, once."""
    make = _kept if kept else _whole
    return await off_loop(len(body), partial(make, coding, body))


async def off_loop(length: int, work: Callable[[], bytes]) -> bytes:
    """Do some work on so many bytes in a thread where it would hold up the event loop."""
    return work() if length < IN_THREAD else await asyncio.to_thread(work)


def _whole(coding: Coding, body: bytes) -> bytes:
    compressor = coding.fast()
    return compressor.compress(body) + compressor.flush()


@lru_cache(KEPT)
def _kept(coding: Coding, body: bytes) -> bytes:
    compressor = coding.small()
    return compressor.compress(body) + compressor.flush()
