"""Operations that are going to end, announced in the headers of their responses (RFC 9745, RFC 8594)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, date, datetime, time
from email.utils import format_datetime

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.http.etag import Header


@dataclass(frozen=True)
class Deprecation:
    """When an operation was deprecated, when it ends, and where a page says what takes its place.

    Attributes
    ----------
    since, until : date
    page : str
        Address of the page.
    """

    since: date
    until: date
    page: str

    @property
    def headers(self) -> tuple[Header, ...]:
        """Headers of every response of the operation."""
        since, until = (datetime.combine(day, time(), UTC) for day in (self.since, self.until))
        return (
            (b"deprecation", b"@%d" % since.timestamp()),
            (b"sunset", format_datetime(until, usegmt=True).encode()),
            (b"link", f'<{self.page}>; rel="deprecation"'.encode()),
        )

    def announced(self, handler: ASGIApp) -> ASGIApp:
        """Return a handler whose responses have the headers."""

        async def serve(scope: Scope, receive: Receive, send: Send) -> None:
            async def with_headers(message: Message) -> None:
                if message["type"] == "http.response.start":
                    message = {**message, "headers": [*message["headers"], *self.headers]}
                await send(message)

            await handler(scope, receive, with_headers)

        return serve


DEPRECATED: Mapping[str, Deprecation] = {}
"""By operation ID. The OpenAPI document marks these operations, too; the changelog announces them."""
