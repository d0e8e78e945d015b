"""What an assessment needs of whatever answers its question: the answers, and what is declared of their fields."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from core.errors import Path
from core.rotation.torque_free import TorqueFree


class Source(Protocol):
    """What answers a question, and what is declared of its fields and its answer's."""

    @property
    def subject(self) -> str:
        """Last steps of the endpoint's path: ``"rotation/precession"``."""

    @property
    def outputs(self) -> frozenset[str]:
        """What a request may name as its outputs."""

    def answer(self, request: str) -> Mapping[str, Any]:
        """Return the answer to a request, given as JSON; raises `MechanicsError` for what is refused."""

    def certified(self, request: Any) -> Mapping[str, Any] | None:
        """Return the answer in proven decimal strings, None where there is none."""

    def errors(self, request: Any) -> tuple[Mapping[str, Any], str] | None:
        """Return bounds of the errors of the answer's figures and what they rest on, None where there are none."""

    def takes(self, field: str) -> bool:
        """Return whether a request may have a field."""

    def unit_of_answer(self, path: Path) -> str | None:
        """Return the declared unit of a figure."""

    def units_of_request(self, request: Any) -> Callable[[Path], str | None]:
        """Return a function from the path of a number of a request to its written unit, None if unknown."""

    def scales(self, answer: Mapping[str, Any], request: Any) -> Mapping[str, float]:
        """Return, by unit, the largest magnitude of an answer's numbers; of the request's where those are 0."""

    def rotation(self, request: Any) -> TorqueFree | None:
        """Return the free rotation that a request is about, None for requests about anything else."""
