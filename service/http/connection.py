"""A connection under uvicorn that is closed when no request begins on it in time.

uvicorn has that limit between two requests; it has none before the first, nor while a head arrives piece by piece.
"""

from __future__ import annotations

import asyncio

from uvicorn.protocols.http.zttp_impl import ZttpProtocol


class Connection(ZttpProtocol):
    """The protocol of uvicorn whose parser bounds the memory of a connection, with one more use of its keep-alive time.

    The head of a request has to be complete within that time from its first byte, the first request from the opening of
    the connection.
    """

    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for the first request."""
        super().connection_made(transport)
        self._limit()

    def data_received(self, data: bytes) -> None:
        """Pass bytes on; while they are not yet a request, the time that is left is not prolonged."""
        super().data_received(data)
        if self.cycle is not None and not self.cycle.response_complete:
            self._unlimit()
        elif self._late is None:
            self._limit()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._unlimit()
        super().connection_lost(exc)

    def _limit(self) -> None:
        self._late = self.loop.call_later(self.timeout_keep_alive, self.transport.close)

    def _unlimit(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None
