"""What is sent of an answer: its text, its validator, and the headers that no two requests for it differ in."""

from __future__ import annotations

import hashlib

Header = tuple[bytes, bytes]

JSON: Header = (b"content-type", b"application/json")
NOSNIFF: Header = (b"x-content-type-options", b"nosniff")

_SECTION = b"content-type: application/json\r\ncontent-length: %d\r\netag: %b\r\nx-content-type-options: nosniff\r\n"


class Representation:
    """An answer as JSON in one piece.

    Attributes
    ----------
    text : bytes
        The answer.
    etag : bytes
        Strong validator: a hash of the text, which holds the version.
    section : bytes
        The headers that belong to the text, as they stand in a response.
    """

    __slots__ = ("etag", "section", "text")

    def __init__(self, text: bytes) -> None:
        self.text = text
        self.etag = etag = etag_of(text)
        self.section = _SECTION % (len(text), etag)

    @property
    def headers(self) -> list[Header]:
        """The headers of `section`, one by one, without those that every response has."""
        return [JSON, (b"content-length", b"%d" % len(self.text)), (b"etag", self.etag)]


def etag_of(first: bytes, *more: bytes) -> bytes:
    """Return a strong validator for content that is, or is determined by, these bytes."""
    # Processors have instructions for this one, which pays from a few hundred bytes on.
    digest = hashlib.sha256(first)
    for part in more:
        digest.update(b"\0")
        digest.update(part)
    return b'"%b"' % digest.hexdigest()[:24].encode()
