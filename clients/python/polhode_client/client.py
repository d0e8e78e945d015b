"""The two clients: blocking and asynchronous, over httpx."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Any, Self, TypeVar, Unpack

import anyio
import httpx

from polhode_client import documents
from polhode_client.exchange import Received, Sent, exchange
from polhode_client.operation import Operation
from polhode_client.operations import OPERATIONS, AsyncOperations, Operations
from polhode_client.progress import Progress, Reporting
from polhode_client.study import Study

C = TypeVar("C", httpx.Client, httpx.AsyncClient)


class Settings:
    """What both clients are made with.

    Parameters
    ----------
    url : str
        For example ``"http://127.0.0.1:8000"``.
    key : str, optional
        Sent as ``Authorization: Bearer``, for a service that asks for keys.
    timeout : float
        Of one request, from sending it to the end of its answer (s). The service gives up what nobody waits for.
    patience : float
        How long to wait, in all, until a busy service may be sent a request again (s).
    progress : callable, optional
        Called with a `Progress` every quarter of a second while a request takes longer than a second, from another
        thread. `polhode_client.bar` shows a bar on standard error.
    """

    def __init__(
        self,
        url: str,
        *,
        key: str | None = None,
        timeout: float = 60.0,
        patience: float = 60.0,
        progress: Callable[[Progress], object] | None = None,
    ) -> None:
        self.url, self.timeout, self.patience, self.progress = url, timeout, patience, progress
        self.headers = {} if key is None else {"authorization": f"Bearer {key}"}

    @property
    def operations(self) -> Mapping[str, Operation]:
        """Every operation of the service by the name of its method."""
        return OPERATIONS


class Client(Settings, Operations):
    """A connection to a Polhode service; each operation is a method that takes the fields of the question.

    The parameters are those of `Settings`, and `transport`, an `httpx.BaseTransport` in place of a connection. Methods
    raise `Refused` with the service's problem, and `httpx.HTTPError` if the service cannot be reached: mostly
    `httpx.ConnectError`, with its address; `httpx.TimeoutException` after the timeout.

    Examples
    --------
    >>> with Client("http://127.0.0.1:8000") as polhode:  # doctest: +SKIP
    ...     coin = {"kind": "principal-moments", "moments": [1, 1, 2]}
    ...     polhode.precession(body=coin, angular_velocity=[1, 1, 1])["space_rate"]
    """

    def __init__(
        self,
        url: str,
        *,
        key: str | None = None,
        timeout: float = 60.0,
        patience: float = 60.0,
        progress: Callable[[Progress], object] | None = None,
        transport: httpx.BaseTransport | None = None,
    ) -> None:
        super().__init__(url, key=key, timeout=timeout, patience=patience, progress=progress)
        self._http = httpx.Client(base_url=url, headers=self.headers, transport=transport)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self._http.close()

    def study(self, **question: Unpack[documents.StudyRequest]) -> Study:
        """Submit a study and return it; it goes on in the service."""
        return Study(self, self.create_study(**question)["jobID"])

    def _ask(
        self, name: str, question: Mapping[str, Any] | None, query: Mapping[str, Any] | None, **places: str
    ) -> Any:
        steps = exchange(OPERATIONS[name].at(**places), question, query, self.patience)
        step = next(steps)
        while True:
            received = None
            if isinstance(step, Sent):
                with Reporting(self.progress, step.path):
                    received = self._received(step)
            else:
                time.sleep(step)
            try:
                step = steps.send(received)
            except StopIteration as answer:
                return answer.value

    def _received(self, sent: Sent) -> Received:
        until = time.monotonic() + self.timeout
        request = _request(self._http, sent, self.timeout)
        try:
            response = self._http.send(request, stream=True)
        except httpx.ConnectError as error:
            raise _unreachable(self.url, error, request) from None
        try:
            parts = []
            for part in response.iter_bytes():
                parts.append(part)
                _require_time(until, request)
        finally:
            response.close()
        return Received(response.status_code, response.headers, b"".join(parts))


class AsyncClient(Settings, AsyncOperations):
    """The same as `Client`, with methods to be awaited; `transport` is an `httpx.AsyncBaseTransport`."""

    def __init__(
        self,
        url: str,
        *,
        key: str | None = None,
        timeout: float = 60.0,
        patience: float = 60.0,
        progress: Callable[[Progress], object] | None = None,
        transport: httpx.AsyncBaseTransport | None = None,
    ) -> None:
        super().__init__(url, key=key, timeout=timeout, patience=patience, progress=progress)
        self._http = httpx.AsyncClient(base_url=url, headers=self.headers, transport=transport)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def _ask(
        self, name: str, question: Mapping[str, Any] | None, query: Mapping[str, Any] | None, **places: str
    ) -> Any:
        steps = exchange(OPERATIONS[name].at(**places), question, query, self.patience)
        step = next(steps)
        while True:
            received = None
            if isinstance(step, Sent):
                with Reporting(self.progress, step.path):
                    received = await self._received(step)
            else:
                await anyio.sleep(step)
            try:
                step = steps.send(received)
            except StopIteration as answer:
                return answer.value

    async def _received(self, sent: Sent) -> Received:
        until = time.monotonic() + self.timeout
        request = _request(self._http, sent, self.timeout)
        try:
            response = await self._http.send(request, stream=True)
        except httpx.ConnectError as error:
            raise _unreachable(self.url, error, request) from None
        try:
            parts = []
            async for part in response.aiter_bytes():
                parts.append(part)
                _require_time(until, request)
        finally:
            await response.aclose()
        return Received(response.status_code, response.headers, b"".join(parts))


def _request(http: C, sent: Sent, timeout: float) -> httpx.Request:
    return http.build_request(sent.method, sent.path, headers=sent.headers, content=sent.body, timeout=timeout)


def _unreachable(url: str, error: httpx.ConnectError, request: httpx.Request) -> httpx.ConnectError:
    return httpx.ConnectError(f"no service answers at {url}: {error}", request=request)


def _require_time(until: float, request: httpx.Request) -> None:
    # The timeout of httpx is of each part of the answer, not of the whole.
    if time.monotonic() > until:
        raise httpx.ReadTimeout("the answer did not end in time", request=request)
