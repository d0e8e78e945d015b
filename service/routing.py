"""What an endpoint is: one entry of the route table, from which requests are served and the documentation is made."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from core.errors import Path
from core.systems.budget import Budget

TABLE = "service.routes:questions"
"""Location of the route table, ``"module:function"``; each compute process loads it by itself."""

ENDINGS = {
    "application/vnd.apache.parquet": ".parquet",
    "application/vnd.zarr+zip": ".zarr.zip",
    "application/x-npz": ".npz",
    "image/svg+xml": ".svg",
    "text/csv": ".csv",
}
"""Endings of paths whose answer has another media type than JSON, by that type."""

Answer = dict[str, Any]
"""Fields of an answer in the order in which they are written; see `service.responses.json_rows`."""


@dataclass(frozen=True)
class Example:
    """A question shown in the documentation, and answered while the service warms up."""

    summary: str
    question: Mapping[str, Any]


@dataclass(frozen=True)
class Reply:
    """A response that is ready to be sent."""

    body: bytes
    media_type: bytes = b"application/json"
    status: int = 200


class ExpectedDuration(NamedTuple):
    """How long an answer takes, by order of magnitude, and what that is known from."""

    duration: str
    why: str


class ManyFigures(NamedTuple):
    """Figures of many questions that differ in some numbers.

    Attributes
    ----------
    answered : ndarray, shape (n,), of bool
        Which of the questions are answered here; the others are to be answered one by one.
    figures : ndarray, shape (n, q)
        NaN where an answer has null; those that are not answered are not set.
    warned : mapping of str to ndarray, shape (n,), of bool
        By the code of a warning, which answers have it.
    """

    answered: NDArray[np.bool_]
    figures: NDArray[np.float64]
    warned: Mapping[str, NDArray[np.bool_]]


Columns = Mapping[Path, NDArray[np.float64]]
"""Numbers of many questions, shape (n,) each, by their place in the request."""


def never(question: Any) -> bool:
    """Say that no question of a route is small."""
    return False


class Documented:
    """What the documentation of every route has.

    Attributes
    ----------
    media_type : str
        Of the answer.
    representations : collection of str
        Media types of other forms of it, each of which is an operation of its own.
    parameters : sequence of mappings
        Of query and headers, as OpenAPI describes them.
    """

    media_type: str = "application/json"
    representations: Collection[str] = ()
    parameters: Sequence[Mapping[str, Any]] = ()

    @property
    def endings(self) -> Mapping[str, str]:
        """Media types of the other forms, with the endings of their paths."""
        return {media: ENDINGS[media] for media in self.representations}


@dataclass(frozen=True)
class PostRoute(Documented):
    """POST: a question to the mechanics.

    Attributes
    ----------
    path, operation_id, summary, description, tag : str
        As they stand in the documentation.
    question, answer : type
        Pydantic models, or unions of two. Requests are validated by the first; the second only documents.
    handle : callable
        From question and budget to the fields of the answer; warnings under ``"warnings"``. It refuses what exceeds the
        budget by counts that the question states before it computes anything.
    small : callable
        Whether a question may be begun in the event loop, by counts that it states; decided without computing anything.
    examples : mapping
        By a short name.
    warming : sequence of mappings
        Questions beside the examples by which every kernel that the route can reach is compiled or loaded at the start.
    representations : mapping
        By media type, how an answer is written other than as JSON.
    errors : callable or None
        For answers that state no accuracy: from question and budget to bounds of the errors of the answer's figures,
        under their names, and what the bounds rest on.
    elsewhere : mapping
        Fields that belong to another route, each with the remedy for who sends it here.
    in_short : sequence of callables
        What takes the place of `handle` where that uses more than the slice of the short class, the first first; each
        is ended in turn when it has used a slice, but for the last.
    many : callable or None
        From a request that can be read, columns of numbers that take the place of some of its own, and the paths of
        figures to the figures of all these questions, to the bit those of `handle`; None for what it cannot do.
    warming_many : sequence of arguments of `many`
        By which every kernel that it can reach is compiled.
    """

    path: str
    operation_id: str
    summary: str
    tag: str
    question: Any
    answer: Any
    handle: Callable[[Any, Budget], Answer]
    small: Callable[[Any], bool] = never
    description: str = ""
    examples: Mapping[str, Example] = field(default_factory=dict)
    warming: Sequence[Mapping[str, Any]] = ()
    representations: Mapping[str, Callable[[Answer], bytes]] = field(default_factory=dict)
    elsewhere: Mapping[str, str] = field(default_factory=dict)
    errors: Callable[[Any, Budget], tuple[Answer, str]] | None = None
    in_short: Sequence[Callable[[Any, Budget], Answer]] = ()
    many: Callable[[Any, Columns, Sequence[Path]], ManyFigures | None] | None = None
    warming_many: Sequence[tuple[Any, Columns, Sequence[Path]]] = ()
    method: str = "POST"

    @property
    def takes_parts(self) -> bool:
        """Whether its columns of numbers may be sent as a file, beside the request."""
        return hasattr(self.question, "COLUMNS_AT")

    @property
    def duration(self) -> ExpectedDuration:
        """How long a question takes that is not answered at once."""
        why = "it was not answered within 20 ms of processor time; more is known only by running it"
        return ExpectedDuration("seconds", why)

    def answer_for_plan(self, question: Any, budget: Budget) -> Answer | None:
        """Return the answer, or None for a question that is planned without one."""
        return self.handle(question, budget)


@dataclass(frozen=True, kw_only=True)
class StudyRoute(PostRoute):
    """POST of a study: what is answered at once is what the study will be, which then is stored and worked on.

    Attributes
    ----------
    members : callable
        From question and budget to what answers the study's members.
    require : callable
        Refuses what is wrong with a study whatever its question's answer.
    paths : frozenset of str
        Of the routes whose questions may have studies.
    """

    members: Callable[[Any, Budget], Any]
    require: Callable[[Any, Budget], object]
    paths: frozenset[str]

    @property
    def duration(self) -> ExpectedDuration:
        """How long a study takes."""
        return ExpectedDuration("minutes", "a study is computed in the background, after other studies of its client")

    def answer_for_plan(self, question: Any, budget: Budget) -> Answer | None:
        """Return None: the question that is varied is not run."""
        self.require(question, budget)
        return None


@dataclass(frozen=True)
class ResourceRoute(Documented):
    """GET or DELETE of what a client has made; its path has parameters in braces.

    Attributes
    ----------
    respond : callable
        Answers a request, given its `service.http.request_context.RequestContext`.
    answer : type or None
        Pydantic model that documents a JSON answer.
    representations : sequence of str
        Media types of other answers.
    example : callable or None
        Returns an example of a JSON answer.
    parameters : sequence of mappings
        Of the query, as OpenAPI describes them.
    """

    method: str
    path: str
    operation_id: str
    summary: str
    tag: str
    respond: Callable[[Any], Awaitable[None]]
    answer: type[BaseModel] | None = None
    description: str = ""
    representations: Sequence[str] = ()
    example: Callable[[], Mapping[str, Any]] | None = None
    documented: bool = True
    media_type: str = "application/json"
    parameters: Sequence[Mapping[str, Any]] = ()


@dataclass(frozen=True)
class GetRoute(Documented):
    """GET: a document that takes no question.

    Attributes
    ----------
    content : callable
        Returns what is sent now.
    answer : type or None
        Pydantic model that documents a JSON page.
    example : callable or None
        Returns an example of a JSON page.
    documented : bool
        Whether the OpenAPI document lists it.
    fixed : bool
        Whether it is the same as long as the service runs, and is compressed once.
    """

    path: str
    operation_id: str
    summary: str
    tag: str
    content: Callable[[], Reply]
    answer: type[BaseModel] | None = None
    media_type: str = "application/json"
    description: str = ""
    example: Callable[[], Mapping[str, Any]] | None = None
    documented: bool = True
    fixed: bool = False
    method: str = "GET"

    @property
    def takes_parameters(self) -> bool:
        """Whether parameters that are not known are ignored: probes and links to pages have some, the API has none."""
        return not self.path.startswith("/v1/")


Route = PostRoute | GetRoute | ResourceRoute
