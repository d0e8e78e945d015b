"""Which part of a scene a quantity belongs to, and what is found of all quantities in the order of the request."""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.answer import Occurrence, SceneExtremes, SceneSolution
from core.multibody.language.scene import Scene
from core.multibody.trajectory.occurrences import ExtremesOf, of_search
from core.multibody.trajectory.scene_request import Output

OF_ALL = {"energy.kinetic", "energy.potential", "momentum", "angular_momentum"}
"""Columns of the whole scene."""
OF_THE_WHOLE = ("equilibria", "equations")
"""Outputs that are answered for the scene as one part."""

ELSEWHERE = "elsewhere"
"""Place among the outputs of what is requested of another part: the others keep the numbers of their paths."""


def part_of(quantity: str, parts: Sequence[Scene]) -> int | None:
    """Return the number of the part to which a quantity belongs, None if it is of the whole scene or of none."""
    if quantity in OF_ALL or quantity.rpartition(".")[0] in OF_ALL:
        return None
    owner = quantity.partition(".")[0]
    owning = [k for k, part in enumerate(parts) if owner in part.bodies or owner in part.names()]
    return owning[0] if len(owning) == 1 else None


def outputs_of(part: int, outputs: Sequence[Output], parts: Sequence[Scene]) -> list[Output]:
    """Return the outputs of a part: the searches for its own quantities, and what is requested of every part."""
    return [output if _is_of(part, output, parts) else ELSEWHERE for output in outputs]


def _is_of(part: int, output: Output, parts: Sequence[Scene]) -> bool:
    return output not in OF_THE_WHOLE if isinstance(output, str) else part_of(output.quantity, parts) == part


def joined_searches(
    solutions: Sequence[SceneSolution], outputs: Sequence[Output], parts: Sequence[Scene]
) -> tuple[tuple[Occurrence, ...] | None, tuple[SceneExtremes, ...] | None]:
    """Return what is found of the quantities of all parts, in the order of the outputs; None without a search."""
    searches = [output for output in outputs if not isinstance(output, str)]
    if not searches:
        return None, None
    times = [list(solution.occurrences or ()) for solution in solutions]
    ranges = [list(solution.extremes or ()) for solution in solutions]
    occurrences: list[Occurrence] = []
    extremes: list[SceneExtremes] = []
    for search in searches:
        part = part_of(search.quantity, parts)
        assert part is not None, "a scene of which a whole is searched is not answered by parts"
        if isinstance(search, ExtremesOf):
            # What ends at its start has none.
            extremes += [ranges[part].pop(0)] if ranges[part] else []
        else:
            occurrences.extend(of_search(search, times[part]))
    return tuple(occurrences), tuple(extremes)
