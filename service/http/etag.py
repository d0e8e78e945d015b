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
    about : tuple of Header
        Those that are sent without the body, too, where the client has it already.
    headers : tuple of Header
        All that belong to the body.
    """

    __slots__ = ("about", "body", "etag", "headers")

    def __init__(self, body: bytes, content_type: Header = JSON, more: tuple[Header, ...] = ()) -> None:
        self.body = body
        self.etag = etag = etag_of(body)
        self.about = ((b"etag", etag), NOSNIFF, *more)
        self.headers = (content_type, (b"content-length", b"%d" % len(body)), *self.about)


def etag_of(first: bytes, *more: bytes) -> bytes:
    """Return a strong validator for content that is, or is determined by, these bytes."""
    # Processors have instructions for this one, which pays from a few hundred bytes on.
    digest = hashlib.sha256(first)
    for part in more:
        digest.update(b"\0")
        digest.update(part)
    return b'"%b"' % digest.hexdigest()[:24].encode()
