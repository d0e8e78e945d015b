"""The server's HTTP protocol, with an extension that sends a small answer by one call instead of two messages.

uvicorn checks and joins the headers of every response one by one, which for a small answer costs as much as finding it.
Those of ours are of known form, so the application may hand them over as they stand in the response. Everything else is
uvicorn's own: parsing, keeping alive, pipelining, back-pressure, disconnection, continuation, shutdown. Where any of them
has a say in a response, the extension declines and the response goes the ordinary way. See docs/decisions/0009.
"""

from __future__ import annotations

from functools import partial

from uvicorn._types import ASGI3Application
from uvicorn.protocols.http.httptools_impl import STATUS_LINE, HttpToolsProtocol, RequestResponseCycle

from service.exchange import IN_ONE_WRITE

LONGEST = 65_536
"""Bytes up to which copying a body behind its headers costs less than writing it by itself."""

_OK = STATUS_LINE[200]


class Protocol(HttpToolsProtocol):
    """One connection."""

    def _start_asgi_task(self, cycle: RequestResponseCycle, app: ASGI3Application) -> None:
        cycle.scope["extensions"] = {IN_ONE_WRITE: partial(in_one_write, cycle)}
        super()._start_asgi_task(cycle, app)


def in_one_write(cycle: RequestResponseCycle, headers: bytes, body: bytes) -> bool:
    """Send a whole response with status 200, or return False and do nothing where that is not a plain matter.

    Parameters
    ----------
    headers : bytes
        As they stand in a response, each with its line end, among them a true content-length.
    """
    if (
        cycle.response_started
        or cycle.disconnected
        # The connection is to be closed after this response, which has to be said in it.
        or not cycle.keep_alive
        # The body has not been asked for, or not read to its end.
        or cycle.waiting_for_100_continue
        or cycle.more_body
        # The client reads more slowly than it asks.
        or cycle.flow.write_paused
        or cycle.access_log
        or cycle.scope["method"] == "HEAD"
        or len(body) > LONGEST
    ):
        return False
    parts = [_OK]
    for name, value in cycle.default_headers:
        parts += (name, b": ", value, b"\r\n")
    parts += (headers, b"\r\n", body)
    # The one reference that would keep the cycle alive until the collector of garbage finds it.
    del cycle.scope["extensions"]
    cycle.response_started = cycle.response_complete = True
    cycle.transport.write(b"".join(parts))
    cycle.message_event.set()
    cycle.on_response()
    return True
