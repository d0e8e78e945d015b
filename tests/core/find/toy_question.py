"""Questions whose answers are functions of their numbers, with stated errors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from core.assessment.compare import Reference
from core.find.evaluations import Evaluations
from core.find.search import Condition, found
from core.find.solutions import Findings
from core.find.varied import Scale, Varied
from core.sensitivities.figure import Figure

Function = Callable[..., Any]
ERROR = 1e-15


class ToyQuestion:
    """A question whose answer has what a function returns of its inputs, under names."""

    def __init__(self, functions: Mapping[str, Function], request: Any) -> None:
        self._functions, self._request = functions, request

    @property
    def answer(self) -> Mapping[str, Any]:
        values = list(self._request.values())
        return {name: function(*values) for name, function in self._functions.items()}

    def reference(self, path: Any) -> Reference:
        value = self.answer[path[0]]
        return Reference(value, error=ERROR * max(1.0, abs(value)))


def search(
    functions: Function | list[Function],
    between: tuple[float, float] | list[tuple[float, float]],
    wanted: Any,
    equals: Any = None,
    *,
    scale: Scale = "linear",
    figure: Figure | None = None,
) -> tuple[Findings, Evaluations]:
    """Return what is found of functions f, or f0 and f1 and so on, of inputs x0, x1 and so on."""
    several = list(functions) if isinstance(functions, list) else [functions]
    ranges = list(between) if isinstance(between, list) else [between]
    table = {f"f{k}": function for k, function in enumerate(several)}
    varied = [Varied(f"/x{k}", (f"x{k}",), *map(float, ends), scale) for k, ends in enumerate(ranges)]
    targets = equals if isinstance(equals, list) else [equals] * len(several)
    conditions = [Condition(figure or Figure((f"f{k}",)), wanted, targets[k]) for k in range(len(several))]
    request = {f"x{k}": 0.0 for k in range(len(ranges))}
    return found(request, varied, conditions, lambda changed: ToyQuestion(table, changed))  # type: ignore[arg-type, return-value]
