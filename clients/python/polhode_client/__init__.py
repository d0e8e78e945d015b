"""A client of the Polhode service: every operation of its OpenAPI document as a method, answers as dictionaries."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, is_dataclass
from functools import cached_property, partial
from types import TracebackType
from typing import Any, Self

import httpx

Answer = dict[str, Any]


class Refused(Exception):
    """The service answered with a problem.

    Attributes
    ----------
    status : int
    code : str
        Stable; the service's GET /v1/errors lists them all.
    problem : dict
        The whole document, with `errors` that point into the question.
    """

    def __init__(self, problem: Mapping[str, Any]) -> None:
        super().__init__(problem.get("detail") or problem.get("title") or "refused")
        self.status, self.code, self.problem = int(problem["status"]), str(problem["code"]), dict(problem)


@dataclass(frozen=True)
class Operation:
    """One operation of the service, as its OpenAPI document names it."""

    method: str
    path: str
    summary: str


class Client:
    """A connection to a Polhode service.

    Each operation is a method under its operationId, with the fields of the question as keyword arguments: those are
    plain data, dataclasses, or arrays. GET operations take none. `operations` lists them.

    Parameters
    ----------
    url : str
        For example ``"http://127.0.0.1:8000"``.
    key : str, optional
        Sent as ``Authorization: Bearer``, for a service that asks for keys.
    patience : float
        How long to repeat a request while the service is too busy (s).
    timeout : float
        Of one request (s).
    transport : httpx.BaseTransport, optional
        In place of a connection.

    Examples
    --------
    >>> with Client("http://127.0.0.1:8000") as polhode:  # doctest: +SKIP
    ...     coin = {"kind": "principal-moments", "moments": [1, 1, 2]}
    ...     polhode.precession(body=coin, angular_velocity=[1, 1, 1])["space_rate"]
    ...     polhode.certified_precession(body=coin, angular_velocity=[1, 1, 1], digits=50)["space_rate"]
    """

    def __init__(
        self,
        url: str,
        *,
        key: str | None = None,
        patience: float = 10.0,
        timeout: float = 60.0,
        transport: httpx.BaseTransport | None = None,
    ) -> None:
        headers = {} if key is None else {"authorization": f"Bearer {key}"}
        self._http = httpx.Client(base_url=url, headers=headers, timeout=timeout, transport=transport)
        self._patience = patience

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self._http.close()

    @cached_property
    def operations(self) -> Mapping[str, Operation]:
        """Operations that are answered in JSON, by operationId, read from the service once."""
        return {
            entry["operationId"]: Operation(method.upper(), path, entry["summary"])
            for path, verbs in self.get("/openapi.json")["paths"].items()
            for method, entry in verbs.items()
            if "application/json" in entry["responses"]["200"].get("content", {})
        }

    def __getattr__(self, name: str) -> Callable[..., Answer]:
        operation = None if name.startswith("_") else self.operations.get(name)
        if operation is None:
            raise AttributeError(f"the service has no operation {name}")
        return partial(self.get if operation.method == "GET" else self._post, operation.path)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.operations]

    def post(self, path: str, question: Mapping[str, Any]) -> Answer:
        """Return the answer to a question.

        Raises
        ------
        Refused
            With the service's problem.
        httpx.HTTPError
            If the service cannot be reached.
        """
        body = _plain(question)
        until = time.monotonic() + self._patience
        while True:
            response = self._http.post(path, json=body)
            wait = float(response.headers.get("retry-after", 0.0))
            if response.status_code != 429 or time.monotonic() + wait > until:
                return _read(response)
            time.sleep(wait)

    def get(self, path: str) -> Answer:
        """Return a document that takes no question; raises as `post`."""
        return _read(self._http.get(path))

    def _post(self, path: str, /, **question: Any) -> Answer:
        return self.post(path, question)


def _read(response: httpx.Response) -> Answer:
    document: Answer = response.json()
    if response.status_code >= 400:
        raise Refused(document)
    return document


def _plain(value: Any) -> Any:
    """Return a value as JSON has it: dataclasses as objects, arrays as lists."""
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value))
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value.tolist() if hasattr(value, "tolist") else value
