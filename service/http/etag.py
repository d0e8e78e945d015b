"""A document that is sent in one piece, with its validator and the headers that depend on nothing else."""

from __future__ import annotations

import hashlib

Header = tuple[bytes, bytes]

JSON: Header = (b"content-type", b"application/json")
NOSNIFF: Header = (b"x-content-type-options", b"nosniff")


class Representation:
    """A document that is sent in one piece, in whatever media type.

    Attributes
    ----------
    etag : bytes
        Strong validator: a hash of the body.
    content_type : bytes
    about : tuple of Header
        Those that are sent without the body, too, where the client has it already.
    headers : tuple of Header
        All that belong to the body.
    """

    __slots__ = ("_more", "about", "body", "content_type", "etag", "headers")

    def __init__(
        self, body: bytes, content_type: Header = JSON, more: tuple[Header, ...] = (), etag: bytes = b""
    ) -> None:
        self.body, self.content_type, self._more = body, content_type[1], more
        self.etag = etag = etag or etag_of(body)
        self.about = ((b"etag", etag), NOSNIFF, *more)
        self.headers = (content_type, (b"content-length", b"%d" % len(body)), *self.about)

    def coded(self, body: bytes, etag: bytes, headers: tuple[Header, ...]) -> Representation:
        """Return the same document with another body and validator, and some more headers."""
        return Representation(body, (b"content-type", self.content_type), (*self._more, *headers), etag)


def etag_of(first: bytes, *more: bytes) -> bytes:
    """Return a strong validator for content that is, or is determined by, these bytes."""
    # Processors have instructions for this one, which pays from a few hundred bytes on.
    digest = hashlib.sha256(first)
    for part in more:
        digest.update(b"\0")
        digest.update(part)
    return b'"%b"' % digest.hexdigest()[:24].encode()
