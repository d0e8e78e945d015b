"""What is sent of an answer: its text, its validator, and the headers that no two requests for it differ in."""

from __future__ import annotations

import hashlib

Header = tuple[bytes, bytes]

JSON: Header = (b"content-type", b"application/json")
NOSNIFF: Header = (b"x-content-type-options", b"nosniff")

_SECTION = (
    b"content-type: application/json\r\ncontent-length: %d\r\netag: %b\r\nx-content-type-options: nosniff\r\n"
)


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
        """The headers of `section`, one by one."""
        return [JSON, (b"content-length", b"%d" % len(self.text)), (b"etag", self.etag), NOSNIFF]


def etag_of(*parts: bytes) -> bytes:
    """Return a strong validator for content that is, or is determined by, these bytes."""
    # SHA-256, because processors have instructions for it; 96 bits of it suffice to tell answers apart.
    digest = hashlib.sha256(parts[0])
    for part in parts[1:]:
        digest.update(b"\0")
        digest.update(part)
    return b'"%b"' % digest.hexdigest()[:24].encode()
