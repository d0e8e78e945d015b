"""A client for programs in Python: questions as plain data or as core's own objects, answers as dictionaries."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, is_dataclass
from types import TracebackType
from typing import Any, Self

import httpx
import orjson

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


class Client:
    """A connection to a Polhode service.

    Parameters
    ----------
    url : str
        For example ``"http://127.0.0.1:8000"``.
    key : str, optional
        Sent as ``Authorization: Bearer``, for a service that asks for keys.
    patience : float
        How long to go on asking while the service is too busy (s).
    transport : httpx.BaseTransport, optional
        For tests.

    Examples
    --------
    >>> with Client("http://127.0.0.1:8000") as polhode:  # doctest: +SKIP
    ...     answer = polhode.trajectory(
    ...         {"kind": "principal-moments", "moments": [1, 2, 3]}, [0.1, 1, 0.1], {"start": 0, "stop": 20, "count": 5}
    ...     )
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

    def ask(self, path: str, question: Mapping[str, Any]) -> Answer:
        """Return the answer to any question.

        Raises
        ------
        Refused
            With the service's problem.
        httpx.HTTPError
            If the service cannot be reached.
        """
        body = orjson.dumps(dict(question), default=_plain, option=orjson.OPT_SERIALIZE_NUMPY)
        until = time.monotonic() + self._patience
        while True:
            response = self._http.post(path, content=body, headers={"content-type": "application/json"})
            wait = float(response.headers.get("retry-after", 0.0))
            if response.status_code != 429 or time.monotonic() + wait > until:
                break
            time.sleep(wait)
        return _read(response)

    def mass_properties(self, body: Any) -> Answer:
        """Return mass, centre of mass, inertia, principal axes and validity of a body."""
        return self.ask("/v1/bodies/mass-properties", {"body": body})

    def trajectory(
        self,
        body: Any,
        angular_velocity: Sequence[float],
        times: Mapping[str, float] | Sequence[float],
        *,
        attitude: Sequence[float] | None = None,
        accuracy: float | None = None,
        method: Any = None,
        outputs: Sequence[str] | None = None,
    ) -> Answer:
        """Return the free rotation of a body at given times; see the service's documentation for the fields."""
        given = {"attitude": attitude, "accuracy": accuracy, "method": method, "outputs": outputs}
        question = {"body": body, "angular_velocity": angular_velocity, "times": times}
        chosen = {name: value for name, value in given.items() if value is not None}
        return self.ask("/v1/rotation/trajectory", question | chosen)

    def methods(self) -> list[dict[str, Any]]:
        """Return the catalogue of methods."""
        entries: list[dict[str, Any]] = _read(self._http.get("/v1/methods"))["methods"]
        return entries


def _read(response: httpx.Response) -> Answer:
    document: Answer = orjson.loads(response.content)
    if response.status_code >= 400:
        raise Refused(document)
    return document


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return asdict(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a question cannot hold {type(value).__name__}")
