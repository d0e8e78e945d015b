"""Heads of requests that have been understood: whoever sends the same bytes again asks in the same way.

A client's requests differ in their bodies; their heads are the same but for the length of the body, and what names the
single request. Parsing one, and looking at each of its headers, costs more than finding it among those that are known.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from service.http.limits import require_json
from service.problems import Refusal
from service.routing import PostRoute, Route

LONGEST = 2_048
"""Bytes of a head that is remembered, at most."""

LONGEST_BODY = 16_384
"""Bytes of a body, at most: longer ones are no small questions."""

MOST = 1_024
"""How many are remembered; the oldest gives way, so that no client can fill the memory with what it calls itself."""

MATTERS = frozenset(
    (b"transfer-encoding", b"expect", b"upgrade", b"content-encoding", b"if-none-match", b"x-request-id")
)
"""Headers by which a request is read or answered in another way than a plain one."""

_OWN = re.compile(rb"\r\n(x-request-id|traceparent|tracestate): ?([!-~]{1,512})(?=\r\n[^ \t])", re.IGNORECASE)
"""Whole lines that name a single request: without them a head says the same."""

_PLAIN_JSON = frozenset((b"*/*", b"application/json"))


class Known(NamedTuple):
    """What a head was understood as."""

    route: PostRoute
    length: int
    """Bytes of head and body together."""


class Heads:
    """The heads that are known to one server process.

    Parameters
    ----------
    routes : mapping
        By method and path.
    most_bytes : int
        Longest body of a question that is answered here.
    """

    def __init__(self, routes: Mapping[tuple[str, str], Route], most_bytes: int) -> None:
        self._routes, self._most_bytes = routes, min(most_bytes, LONGEST_BODY)
        self._known: dict[bytes, Known] = {}

    def find(self, head: bytes) -> tuple[Known | None, bytes | None]:
        """Return what a head was understood as, None if it is not known, and the id that it gives to the request."""
        known = self._known.get(head)
        if known is not None or len(head) > LONGEST:
            return known, None
        common, own = _parted(head)
        known = self._known.get(common) if own else None
        if known is None:
            return None, None
        return Known(known.route, known.length + len(head) - len(common)), own.get(b"x-request-id")

    def learn(self, head: bytes, scope: Mapping[str, Any]) -> None:
        """Remember a head if it belongs to a plain question; `scope` is what the server's parser made of it."""
        route = self._routes.get((scope["method"], scope["path"]))
        common, own = _parted(head)
        headers = {name: value for name, value in scope["headers"] if name not in own}
        length = headers.get(b"content-length", b"")
        if (
            isinstance(route, PostRoute)
            and len(head) <= LONGEST
            and length.isdigit()
            and len(length) < 10
            and int(length) <= self._most_bytes
            and len(headers) + len(own) == len(scope["headers"])
            and MATTERS.isdisjoint(headers)
            and headers.get(b"accept", b"*/*") in _PLAIN_JSON
            and _is_json(headers)
        ):
            while len(self._known) >= MOST:
                del self._known[next(iter(self._known))]
            self._known[common] = Known(route, len(common) + int(length))


def _parted(head: bytes) -> tuple[bytes, Mapping[bytes, bytes]]:
    """Return a head without the lines that name a single request, and what they say; all of it if one comes twice."""
    lines = _OWN.findall(head)
    own = {name.lower(): value for name, value in lines}
    return (_OWN.sub(b"", head), own) if lines and len(own) == len(lines) else (head, {})


def _is_json(headers: Mapping[bytes, bytes]) -> bool:
    try:
        require_json(headers)
    except Refusal:
        return False
    return True
