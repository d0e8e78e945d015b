"""Which pages of other origins may ask from a browser (the Fetch standard's CORS protocol)."""

from __future__ import annotations

from collections.abc import Mapping

Header = tuple[bytes, bytes]

_ALWAYS: tuple[Header, ...] = (
    (b"vary", b"origin"),
    (b"access-control-expose-headers", b"etag, retry-after, server-timing, x-request-id"),
)
_PREFLIGHT: tuple[Header, ...] = (
    (b"access-control-allow-methods", b"GET, HEAD, POST"),
    (b"access-control-allow-headers", b"accept, authorization, content-type, if-none-match, x-request-id"),
    (b"access-control-max-age", b"3600"),
)


class Cors:
    """The origins that are allowed.

    Parameters
    ----------
    origins : str
        As in the setting cors_origins: separated by commas, or ``*`` for all. Credentials are never allowed.
    """

    def __init__(self, origins: str) -> None:
        self._origins = frozenset(origin.strip().encode() for origin in origins.split(",") if origin.strip())

    def __bool__(self) -> bool:
        return bool(self._origins)

    def headers(self, request: Mapping[bytes, bytes]) -> tuple[Header, ...]:
        """Return what is added to an answer."""
        origin = request.get(b"origin")
        if b"*" in self._origins:
            return ((b"access-control-allow-origin", b"*"), *_ALWAYS) if origin else ()
        if origin is None or origin not in self._origins:
            return _ALWAYS[:1]
        return ((b"access-control-allow-origin", origin), *_ALWAYS)

    def preflight(self, method: str, request: Mapping[bytes, bytes]) -> tuple[Header, ...] | None:
        """Return the headers of the answer to a browser's question before the request, None if it is none."""
        if method != "OPTIONS" or b"access-control-request-method" not in request or b"origin" not in request:
            return None
        return _PREFLIGHT
