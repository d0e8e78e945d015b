"""An answer as JSON in one piece, with its validator and the headers that depend on nothing else."""

from __future__ import annotations

import hashlib

Header = tuple[bytes, bytes]

JSON: Header = (b"content-type", b"application/json")
NOSNIFF: Header = (b"x-content-type-options", b"nosniff")


class Representation:
    """An answer as JSON in one piece.

    Attributes
    ----------
    text : bytes
        The answer.
    etag : bytes
        Strong validator: a hash of the text, which holds the version.
    headers : tuple of Header
        Those that belong to the text.
    """

    __slots__ = ("etag", "headers", "text")

    def __init__(self, text: bytes) -> None:
        self.text = text
        self.etag = etag = etag_of(text)
        self.headers = (JSON, (b"content-length", b"%d" % len(text)), (b"etag", etag), NOSNIFF)


def etag_of(first: bytes, *more: bytes) -> bytes:
    """Return a strong validator for content that is, or is determined by, these bytes."""
    # Processors have instructions for this one, which pays from a few hundred bytes on.
    digest = hashlib.sha256(first)
    for part in more:
        digest.update(b"\0")
        digest.update(part)
    return b'"%b"' % digest.hexdigest()[:24].encode()
