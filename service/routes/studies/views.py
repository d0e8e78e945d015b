"""What is answered about studies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field

from service.schemas import Envelope, Ratio, Seconds, Signed, View

WHOLE: Any = {"x-unit": "1"}


class StudyAxis(View):
    """A varied input."""

    pointer: str = Field(description="Into the request of the question.")
    unit: str | None = Field(description="As the question declares it.")
    levels: int | None = Field(description="Number of its levels; null where it is drawn.", json_schema_extra=WHOLE)


class StudyFigure(View):
    """A figure of the members."""

    pointer: str = Field(description="Into the answer of the question.")
    unit: str | None = Field(description="As the answer declares it.")


class Link(View):
    """A document that belongs to a study."""

    href: str = Field(description="Its address.")
    rel: str = Field(description="self, results, events.")
    type: str = Field(description="Media type.")


class StudyStatus(View):
    """The state of a study, in the shape of OGC API Processes' statusInfo."""

    jobID: str = Field(description="Of the study; it cannot be guessed.")
    type: Literal["process"] = Field(description="As OGC API Processes wants it.")
    processID: Literal["study"] = Field(description="As OGC API Processes wants it.")
    status: Literal["accepted", "running", "successful", "failed", "dismissed"] = Field(description="Of the study.")
    message: str = Field(description="What hinders it, or why it has failed; empty otherwise.")
    created: str = Field(description="When it was submitted (RFC 3339).")
    started: str | None = Field(description="When the first member was computed.")
    finished: str | None = Field(description="When it ended.")
    updated: str = Field(description="When this was written.")
    progress: int = Field(description="Percent of the members.", json_schema_extra=WHOLE)
    path: str = Field(description="Of the endpoint that answers the members.")
    count: int = Field(description="Of members.", json_schema_extra=WHOLE)
    shape: list[int] = Field(description="Lengths of the axes of the grid of members.", json_schema_extra=WHOLE)
    inputs: list[StudyAxis] = Field(description="In the order of `vary`.")
    figures: list[StudyFigure] = Field(description="In the order of `quantities`.")
    together: bool = Field(description="Whether members are answered many at a time, with the same bits.")
    done: int = Field(description="Members whose results are stored.", json_schema_extra=WHOLE)
    failed: int = Field(description="Of these, members that have no result but a problem.", json_schema_extra=WHOLE)
    seconds: Seconds[float] = Field(description="Processor time that they took.")
    predicted_seconds: Seconds[float] = Field(
        description="Processor time of all members, if each takes as long as the question; 0 for one answer."
    )
    bytes: int = Field(description="Of all results where they are stored, as predicted.", json_schema_extra=WHOLE)
    predicted_end: str | None = Field(description="When it should be finished (RFC 3339); null when it is.")
    links: list[Link] = Field(description="To what else there is.")


class StudyState(StudyStatus, Signed):
    """The state of one study."""


class StudyList(Signed):
    """The studies of a client, a page at a time."""

    studies: list[StudyStatus]
    next: str | None = Field(description="Address of the next page; null where there is none.")


STATE: Mapping[str, Any] = {
    "jobID": "Zq3mJ0yN8cXb1VtLr5wUeK7a",
    "type": "process",
    "processID": "study",
    "status": "accepted",
    "message": "",
    "created": "2026-11-22T12:00:00.000+00:00",
    "started": None,
    "finished": None,
    "updated": "2026-11-22T12:00:00.001+00:00",
    "progress": 0,
    "path": "/v1/rotation/precession",
    "count": 4096,
    "shape": [4096],
    "inputs": [{"pointer": "/angular_velocity/0", "unit": "rad s^-1", "levels": 4096}],
    "figures": [{"pointer": "/flip_interval", "unit": "s"}],
    "together": True,
    "done": 0,
    "failed": 0,
    "seconds": 0.0,
    "predicted_seconds": 0.033,
    "bytes": 86016,
    "predicted_end": "2026-11-22T12:00:00.034+00:00",
    "links": [
        {"href": "/v1/studies/Zq3mJ0yN8cXb1VtLr5wUeK7a", "rel": "self", "type": "application/json"},
        {"href": "/v1/studies/Zq3mJ0yN8cXb1VtLr5wUeK7a/events", "rel": "events", "type": "text/event-stream"},
    ],
}
"""An example: the state of a study that has just been submitted."""

RESULTS: Mapping[str, Any] = {
    "warnings": [],
    "jobID": STATE["jobID"],
    "count": 2,
    "shape": [2],
    "statistics": {"figures": {}, "failures": {}, "warnings": {}},
    "start": 0,
    "inputs": {"/angular_velocity/0": [0.01, 0.02]},
    "figures": {"/flip_interval": [33.3, None]},
    "failures": [{"member": 1, "code": "accuracy-unreachable"}],
    "next": None,
}
"""An example of results."""


class StudyQuantile(View):
    """The value below which a share of the samples lies."""

    probability: Ratio[float]
    value: float = Field(description="In the unit of the figure.", json_schema_extra=WHOLE)


class StudyExtreme(View):
    """A smallest or largest figure."""

    value: float = Field(description="In the unit of the figure.", json_schema_extra=WHOLE)
    member: int = Field(description="The first that has it.", json_schema_extra=WHOLE)


class StudyHistogram(View):
    """Members by figure."""

    edges: list[float] = Field(description="Of the bins, in the unit of the figure.", json_schema_extra=WHOLE)
    counts: list[int] = Field(description="Of members.", json_schema_extra=WHOLE)


class StudyStatistics(View):
    """Statistics of one quantity; null where they were not requested or do not exist."""

    unit: str | None = Field(description="Of the figure.")
    present: int = Field(description="Members that have the figure.", json_schema_extra=WHOLE)
    mean: float | None = Field(description="In the unit of the figure.", json_schema_extra=WHOLE)
    standard_error: float | None = Field(
        description="Of the mean, if members are independent draws.", json_schema_extra=WHOLE
    )
    std: float | None = Field(description="Of the sample, with n - 1.", json_schema_extra=WHOLE)
    quantiles: list[StudyQuantile] | None = Field(description="Linear between two members.")
    min: StudyExtreme | None
    max: StudyExtreme | None
    histogram: StudyHistogram | None


class StudySummary(View):
    """Statistics of all members."""

    figures: dict[str, StudyStatistics] = Field(description="By pointer.")
    failures: dict[str, int] | None = Field(
        default=None, description="How many members were refused, by the code of the problem.", json_schema_extra=WHOLE
    )
    warnings: dict[str, int] | None = Field(
        default=None, description="How many answers have a warning, by its code.", json_schema_extra=WHOLE
    )


class FailedMember(View):
    """A member without result."""

    member: int = Field(description="Its number.", json_schema_extra=WHOLE)
    code: str = Field(description="Of its problem.")


class StudyResults(Envelope):
    """Results of members that follow each other, column by column."""

    jobID: str = Field(description="Of the study.")
    count: int = Field(description="Of all members.", json_schema_extra=WHOLE)
    shape: list[int] = Field(description="Lengths of the axes of the grid of members.", json_schema_extra=WHOLE)
    statistics: StudySummary
    start: int = Field(description="Number of the first member of this page.", json_schema_extra=WHOLE)
    inputs: dict[str, list[Any]] = Field(description="Values of the varied inputs, by pointer.")
    figures: dict[str, list[float | None]] = Field(
        description="By pointer, each in its unit; null where a member has none.", json_schema_extra=WHOLE
    )
    failures: list[FailedMember] = Field(description="Members of this page that were refused.")
    next: str | None = Field(description="Address of the next page.")
