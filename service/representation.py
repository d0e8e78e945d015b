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


def etag_of(*parts: bytes) -> bytes:
    """Return a strong validator for content that is, or is determined by, these bytes."""
    # OpenSSL's hashes are faster on long texts, but take longer to begin than a small answer takes as a whole.
    digest = hashlib.blake2b(parts[0], digest_size=12)
    for part in parts[1:]:
        digest.update(b"\0")
        digest.update(part)
    return b'"%b"' % digest.hexdigest().encode()
