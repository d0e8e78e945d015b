"""What submissions are graded against: a question that is computed, or its answer key."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from core.arrays import Floats
from core.assessment.compare import Reference
from core.assessment.judged_formulas import Varied
from core.errors import Path

if TYPE_CHECKING:
    from core.rotation.torque_free import TorqueFree


class Question(Protocol):
    """What is graded against: a question that is computed (`GradedQuestion`), or the answer key of one."""

    @property
    def subject(self) -> str:
        """Last steps of the endpoint's path."""

    @property
    def request(self) -> Any:
        """As it was sent."""

    def evaluate(self, request: Any) -> Callable[[Path], Any]:
        """Ask a changed question; the result finds the value at a path of its answer, None where there is none."""

    def reference(self, path: Path) -> Reference | None:
        """Return the reference at a path of the answer, None if nothing that can be compared stands there."""

    def figures_in(self, path: Path) -> Sequence[str]:
        """Return the fields of the object at a path of the answer that are figures, null ones last."""

    def samples(self, path: Path, times: Floats) -> Reference | None:
        """Return a column of samples at other times, None if the path leads to no column."""

    def parameters(self, names: Mapping[str, Path] | None) -> Mapping[str, tuple[Path, float, str]]:
        """Return path, value and unit of the numbers of the request that formulas may name."""

    def variations(self, path: Path, parameters: Mapping[str, tuple[Path, float, str]]) -> Sequence[Varied]:
        """Return the question's parameters and the figure at a path, and those of variations of it."""

    def rotation(self) -> TorqueFree | None:
        """Return the free rotation that the question is about; None where its samples cannot be analysed."""
