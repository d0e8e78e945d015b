"""Every setting of the service: an environment variable POLHODE_*, most of them also an option on the command line."""

from __future__ import annotations

import re
from ipaddress import ip_network
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, FilePath
from pydantic_settings import BaseSettings, SettingsConfigDict

LONGEST = 1_000_000
"""Seconds, about twelve days: beyond, timers of the system overflow; an infinite time is no setting."""


def _named(value: object) -> object:
    """Refuse an empty path: it would be the working directory."""
    if value == "":
        raise ValueError("is empty; leave it out for the default")
    return value


def _networks(value: str) -> str:
    """Refuse what is no list of addresses and networks: a proxy that is not recognised would be every client."""
    for entry in filter(None, value.replace(" ", "").split(",")):
        ip_network(entry)
    return value.replace(" ", "")


_ORIGIN = re.compile(r"https?://(\*\.)?[A-Za-z0-9.-]+(:(\d{1,5}|\*))?")


def _origins(value: str) -> str:
    """Refuse what is no list of origins: it is written into a header, where a semicolon would end the rule."""
    for entry in filter(None, value.replace(",", " ").split()):
        if not _ORIGIN.fullmatch(entry):
            raise ValueError(f"{entry!r} is no origin such as https://learning.example.org")
    return " ".join(value.replace(",", " ").split())


class Settings(BaseSettings):
    """The service's settings; the description of each field is its documentation."""

    model_config = SettingsConfigDict(env_prefix="POLHODE_", frozen=True, extra="forbid")

    host: str = Field(default="127.0.0.1", description="Address to listen on.")
    port: int = Field(default=8000, ge=0, le=65535, description="Port to listen on; 0 takes a free one.")
    workers: int = Field(default=1, ge=1, le=256, description="Number of server processes that share the port.")

    forwarded_allow_ips: Annotated[str, AfterValidator(_networks)] = Field(
        default="",
        description="Addresses and networks of reverse proxies, separated by commas, whose X-Forwarded-For names the "
        "client; empty trusts none, and all clients behind a proxy count as one.",
    )
    allowed_hosts: str = Field(
        default="",
        description="Host names under which the service is addressed, separated by commas, *.example.org with all "
        "below; others are refused (421). IP addresses and localhost are always accepted; empty accepts every name.",
    )

    frame_ancestors: Annotated[str, AfterValidator(_origins)] = Field(
        default="",
        description="Origins whose pages may show the pages of this service in a frame, such as a learning platform's "
        "https://learning.example.org, separated by commas; empty allows none.",
    )

    keep_alive_seconds: int = Field(
        default=75,
        ge=1,
        le=LONGEST,
        description="Time after which a connection is closed on which no whole head of a request has arrived, or whose "
        "client takes nothing of what is left to be written to it.",
    )

    max_body_bytes: int = Field(
        default=8_000_000, ge=1, description="Largest request body; a longer one is refused unread (413)."
    )
    body_seconds: float = Field(
        default=30.0, gt=0, le=LONGEST, description="Time in which a request body must have arrived (408)."
    )
    max_samples: int = Field(default=1_000_000, ge=1, description="Largest number of samples in one answer (422).")
    max_evaluations: int = Field(
        default=20_000_000,
        ge=1,
        description="Largest number of evaluations of an equation of motion for one question (422).",
    )

    compute_workers: int = Field(
        default=0,
        ge=0,
        le=256,
        description="Processors that large questions take at most, per server process; 0 takes all.",
    )
    inline_work: int = Field(
        default=2000,
        ge=0,
        description="Work that a request may do in the server process, in units of at most 10 microseconds; one that "
        "needs more is given to a compute process.",
    )
    inline_bytes: int = Field(
        default=8_192, ge=0, description="Request bodies longer than this are read in another process."
    )
    deadline_seconds: float = Field(
        default=30.0,
        gt=0,
        le=LONGEST,
        description="Processor time that a computation may use; beyond, it is ended (503).",
    )
    max_waiting: int = Field(
        default=32,
        ge=1,
        description="Large questions of one client that may wait for a compute process; another one is refused (429).",
    )
    compute_memory_bytes: int = Field(
        default=1_000_000_000,
        ge=0,
        description="Memory that a compute process may take beyond what it begins with; a question that needs more is "
        "refused (503). 0 sets no limit.",
    )
    max_held_bytes: int = Field(
        default=256_000_000,
        ge=1,
        description="Memory of bodies that are arriving, of requests that are being answered and of answers that are "
        "being read by their clients above which new large requests are refused (429); one client may hold half.",
    )
    stalled_seconds: float = Field(
        default=20.0,
        gt=0,
        le=LONGEST,
        description="Time in which a client must take some of its answer; otherwise the connection is closed.",
    )
    cached_answers: int = Field(
        default=1024,
        ge=0,
        description="Number of answers of at most 8 kB that are cached, with their questions; 0 caches none.",
    )

    data: str = Field(
        default="",
        description="Folder of what is stored: studies and their results. By default .data in a checkout, and "
        "polhode in the user's folder of data ($XDG_DATA_HOME or ~/.local/share) otherwise; made by the first study.",
    )
    studies_results: str = Field(
        default="",
        description="URL, as fsspec has it, of where the results of studies are stored, such as s3://bucket/studies; "
        "by default the folder of data.",
    )
    studies_keep_days: float = Field(
        default=30.0, gt=0, description="Days after its end after which a study and its results are removed."
    )
    dask: str = Field(
        default="",
        description="Address of a Dask scheduler that computes studies, such as tcp://scheduler:8786; by default a "
        "cluster on this machine is started with the first study.",
    )
    study_workers: int = Field(
        default=0, ge=0, le=1024, description="Processes of the cluster on this machine; 0 takes one per core."
    )
    study_memory_bytes: int = Field(
        default=0,
        ge=0,
        description="Memory of these processes together; one that takes more than its share is ended. 0 takes half "
        "of the machine's.",
    )
    answer_seconds: float = Field(
        default=600.0,
        gt=0,
        le=LONGEST,
        description="Longest computation of an answer in the background (Prefer: respond-async); the study of a longer "
        "one fails.",
    )
    study_idle_seconds: float = Field(
        default=60.0, gt=0, le=LONGEST, description="Time without studies after which their processes are ended."
    )
    max_studies: int = Field(
        default=100, ge=1, description="Unfinished studies of one key, or of all without keys (429)."
    )
    max_address_studies: int = Field(
        default=20, ge=1, description="Of these, where no keys are required, those of one network address (429)."
    )
    max_study_members: int = Field(default=10_000_000, ge=1, description="Largest number of members of a study (422).")
    max_studies_bytes: int = Field(
        default=50_000_000_000,
        ge=0,
        description="Bytes that requests and results of all studies may take together, results to be computed "
        "included, and one client half of them (503).",
    )
    max_study_seconds: float = Field(
        default=1e6, gt=0, description="Largest predicted processor time of a study, in seconds (422)."
    )

    traces: bool = Field(
        default=False,
        description="Whether OpenTelemetry traces are sent, by OTLP over HTTP to where the variables "
        "OTEL_EXPORTER_OTLP_* say; needs the extra polhode[traces].",
    )

    keys_file: Annotated[FilePath, BeforeValidator(_named)] | None = Field(
        default=None,
        description="File of accepted keys, one per line: name, SHA-256, requests per second, seconds of work "
        "per minute; read again when it changes. By default no key is required.",
    )
    cors_origins: str = Field(
        default="",
        description="Origins allowed to send cross-origin requests, separated by commas; * allows all, empty none.",
    )

    log_level: Literal["debug", "info", "warning", "error"] = Field(
        default="info", description="Least severe message logged."
    )
    log_requests: Literal["none", "failures", "all"] = Field(
        default="failures",
        description="Which requests are logged, one JSON line each; failures are answers from 500 upwards.",
    )
    audit: bool = Field(
        default=True,
        description="Whether every answer about a described scene is checked against the laws of mechanics before it "
        "is sent; where it is not, GET /readyz says so.",
    )
    failed_requests: str = Field(
        default="",
        description="Folder in which requests are kept whose answers did not pass that check, by their ids; by "
        "default none is kept.",
    )
    shutdown_seconds: int = Field(
        default=10, ge=0, le=LONGEST, description="Time that answers in flight are given when the service is stopped."
    )
