"""The model of a scene, and its phases, from those of its independent parts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from core.multibody.answer import SceneSolution
from core.multibody.model_answer import SceneModel

UNDECIDED = "undecided"
"""The name of the model of what mechanics does not decide from the start on."""


class _Named(Protocol):
    @property
    def name(self) -> str: ...

    @property
    def why(self) -> str: ...


def name_of(models: Sequence[_Named]) -> tuple[str, str]:
    """Return the name of the model of parts that move independently, and why it suffices.

    What rests beside something that moves has no name of its own in it.
    """
    undecided = [one for one in models if one.name == UNDECIDED]
    moving = undecided[:1] or [one for one in models if one.name != "rest"] or list(models[:1])
    if len({one.name for one in moving}) == 1:
        return moving[0].name, moving[0].why
    return "parts apart", "the parts have no force or connection in common, and each has its own model"


def joined_model(models: Sequence[SceneModel]) -> SceneModel:
    """Return the model of a scene from those of its parts."""
    name, why = name_of(models)
    return SceneModel(
        name,
        why,
        sum(model.degrees_of_freedom for model in models),
        sum(model.mobility for model in models),
        sum(model.coordinates for model in models),
        sum(model.rows for model in models),
        (sum(model.described[0] for model in models), sum(model.described[1] for model in models)),
        tuple(part for model in models for part in model.apart),
        tuple(dict.fromkeys(sentence for model in models for sentence in model.noticed)),
        {name: others for model in models for name, others in model.redundant.items()},
    )


def period_of(solutions: Sequence[SceneSolution]) -> tuple[float | None, float | None]:
    """Return the period of a scene of which one part moves, and its error; None where several do."""
    moving = [solution for solution in solutions if _moves(solution)]
    return (moving[0].period, moving[0].period_error) if len(moving) == 1 else (None, None)


def _moves(solution: SceneSolution) -> bool:
    if solution.phases is None:
        return any(part.name != "rest" for part in solution.model.apart)
    return any(phase.model != "rest" for phase in solution.phases)
