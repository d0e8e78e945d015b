"""A study as it is recorded, and the states that it goes through."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

ACCEPTED, RUNNING, SUCCESSFUL, FAILED, DISMISSED = "accepted", "running", "successful", "failed", "dismissed"
"""States, as OGC API Processes names them."""

STATES = (ACCEPTED, RUNNING, SUCCESSFUL, FAILED, DISMISSED)
UNFINISHED = (ACCEPTED, RUNNING)


@dataclass(frozen=True)
class Study:
    """A study as it is recorded.

    Attributes
    ----------
    id, owner : str
        The owner is the name of a key, empty where none are required.
    plan : mapping
        What was answered at its submission.
    status, message : str
    created, started, finished : float
        Seconds since 1970; None for what has not happened.
    done, failed : int
        Members whose results are stored, and how many of them have none but a problem.
    seconds : float
        Processor time that they took.
    """

    id: str
    owner: str
    plan: Mapping[str, Any]
    status: str
    message: str
    created: float
    started: float | None
    finished: float | None
    done: int
    failed: int
    seconds: float

    @property
    def count(self) -> int:
        """Number of members."""
        return int(self.plan["count"])

    @property
    def whole(self) -> bool:
        """Whether its result is one whole answer, and not figures of members."""
        return not self.plan["figures"]

    @property
    def unfinished(self) -> bool:
        """Whether there is something left to do."""
        return self.status in UNFINISHED


class Owner(NamedTuple):
    """Whose a study is: the name of a key, and the address that it came from where no keys are required."""

    name: str
    address: str = ""


class Quotas(NamedTuple):
    """Unfinished studies of one owner and of one address without keys; bytes of all studies together."""

    studies: int
    of_address: int
    bytes: int
